// What sixty things that move cost: the same drive with and without them, turn and turn about.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/scenario.h"
#include "sim/rig_options.h"
#include "sim/sweep_pipeline.h"
#include "tools/bench/cpu_clock.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

constexpr int kSweeps = 8;  // spread over the drive
constexpr int kRounds = 9;  // the best of each counts

/// 4 aircraft, 10 buses, 24 tractors, 6 fuel trucks, 6 follow-me cars and 10 people, all of them moving all the time on
/// straights side by side between the stands and the edge of the apron.
std::string sixty_actors() {
  std::string list = "[";
  int count = 0;
  const auto add = [&](const std::string& kind, double x_m, double y_m, double length_m, double v_m_s) {
    list += fmt::format(
        "{}{{kind: {}, name: mover-{}, start: {{x_m: {}, y_m: {}, heading_deg: {}, speed_m_s: {}}}, path: "
        "[{{straight_m: "
        "{}}}]}}",
        count == 0 ? "" : ", ", kind, count, x_m, y_m, count % 2 == 0 ? 0 : 180, v_m_s, length_m);
    ++count;
  };
  for (int k = 0; k < 4; ++k) add("aircraft", k % 2 == 0 ? -100 + 40 * k : 100 - 40 * (k - 1), -66 - 2 * k, 90, 1.2);
  for (int k = 0; k < 10; ++k) add("bus", -60 + 12 * k, -40 - 5 * (k % 3), 120, 1.6);
  for (int k = 0; k < 24; ++k) add("vehicle", -70 + 6 * k, -20 - 2.5 * (k % 4), 120, 1.7);
  for (int k = 0; k < 6; ++k) add("fuel-truck", -75 + 25 * k, -14 + 3 * (k % 2), 120, 1.7);
  for (int k = 0; k < 6; ++k) add("follow-me", -80 + 28 * k, 41, 120, 1.7);
  for (int k = 0; k < 10; ++k) add("marshaller", -40 + 9 * k, k % 2 == 0 ? 33.5 : -17, 80, 1.1);
  return list + "]";
}

struct World {
  sim::SimulationInput input;
  std::shared_ptr<const sim::raycast::Tracer> tracer;
  std::unique_ptr<sim::lidar::SweepSimulator> simulator;
};

World build(const std::string& actors, bool fast) {
  scenarios::Scenario scenario = scenarios::load_scenario(scenarios::find_scenario("stand-turn", scenario_folders()),
                                                          {{"scene.with_tug", "false"}, {"scene.actors", actors}});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  World world{build_world(scenario, seed, ""), nullptr, nullptr};
  const sim::RigOptions rig = sim::read_rig(world.input.rig);
  world.tracer = std::make_shared<const sim::raycast::Tracer>(world.input.scene, sim::raycast::TracerSettings{1, fast});
  world.simulator = std::make_unique<sim::lidar::SweepSimulator>(
      rig.lidars[0].profile, sim::firing_table(rig, seed),
      sim::lidar::Mounting{.sensor = 0, .T_body_lidar = rig.lidars[0].T_body_lidar}, rig.lidars[0].noise, seed,
      world.tracer, world.input.scene, world.input.motion);
  return world;
}

/// Seconds; Embree alone on packed tiles, all that the tracer does, and the whole pipeline.
struct Costs {
  double raw_s = 0, trace_s = 0, pipeline_s = 0;
  void keep_best(const Costs& other) {
    raw_s = std::min(raw_s, other.raw_s);
    trace_s = std::min(trace_s, other.trace_s);
    pipeline_s = std::min(pipeline_s, other.pipeline_s);
  }
  void add(const Costs& other) {
    raw_s += other.raw_s;
    trace_s += other.trace_s;
    pipeline_s += other.pipeline_s;
  }
};

class Measured {
 public:
  Measured(const World& world, std::int64_t index)
      : world_(world),
        index_(index),
        aimed_(world.simulator->aimed(index)),
        packed_(aimed_.tracer.pack(aimed_.rays, aimed_.tiles)) {}

  Costs round() {
    packed_.reset();
    Costs costs;
    costs.raw_s = cpu_s_of([&] { packed_.intersect(); });
    costs.pipeline_s = cpu_s_of([&] { world_.simulator->sweep(index_, workspace_, sweep_); });
    // Without what the sweep's set-up costs (poses of everything that moves): that is part of the pipeline's.
    costs.trace_s = sweep_.trace_cpu_s;
    return costs;
  }
  double rays() const { return static_cast<double>(packed_.rays()); }
  double actors() const { return static_cast<double>(aimed_.tracer.actors_in_range()); }
  double share_on_actors() const {
    std::size_t on = 0;
    for (const std::uint32_t id : sweep_.instance)
      on += id < world_.input.scene->instances.size() && world_.input.scene->instances[id].actor >= 0;
    return static_cast<double>(on) / rays();
  }

 private:
  const World& world_;
  std::int64_t index_;
  sim::lidar::AimedSweep aimed_;
  sim::raycast::PackedTiles packed_;
  sim::lidar::SimulatedSweep sweep_;
  sim::lidar::Workspace workspace_;
};

struct Totals {
  Costs without, with;
  double rays = 0, actors = 0, on_actors = 0;
};

void measure(const World& empty, const World& busy, std::int64_t index, Totals& totals) {
  Measured without(empty, index), with(busy, index);
  Costs best_without = without.round(), best_with = with.round();
  for (int round = 1; round < kRounds; ++round) {
    best_without.keep_best(without.round());
    best_with.keep_best(with.round());
  }
  totals.without.add(best_without);
  totals.with.add(best_with);
  totals.rays += with.rays();
  totals.actors += with.actors() / kSweeps;
  totals.on_actors += with.share_on_actors() / kSweeps;
}

void add_rows(const std::string& variant, const Totals& t, BenchRows& rows) {
  const auto add = [&](const char* metric, double value, const char* unit) {
    rows.push_back({"sim", variant, metric, value, unit});
  };
  add("raw_mrays_per_s", 1e-6 * t.rays / t.with.raw_s, "Mrays/s");
  add("pipeline_mrays_per_s", 1e-6 * t.rays / t.with.pipeline_s, "Mrays/s");
  add("movers_raw_percent", 100 * (t.with.raw_s - t.without.raw_s) / t.without.raw_s, "%");
  add("movers_trace_percent", 100 * (t.with.trace_s - t.without.trace_s) / t.without.raw_s, "%");
  add("movers_pipeline_percent", 100 * (t.with.pipeline_s - t.without.pipeline_s) / t.without.pipeline_s, "%");
  add("movers_parts_in_range", t.actors, "1");
  add("movers_share_of_points_percent", 100 * t.on_actors, "%");
}

}  // namespace

BenchRows bench_movers(const Console& console) {
  BenchRows rows;
  for (const bool fast : {false, true}) {
    const std::string variant = fast ? "fast-60-movers" : "default-60-movers";
    const World empty = build("[]", fast), busy = build(sixty_actors(), fast);
    const std::int64_t count =
        busy.simulator->firing().sweeps_until(std::min(core::Time(busy.input.duration), busy.input.motion->end()));
    const core::Progress progress = console.progress("sim, " + variant);
    Totals totals;
    for (int k = 0; k < kSweeps; ++k) {
      measure(empty, busy, count * k / kSweeps, totals);
      progress((k + 1.0) / kSweeps, busy.tracer->isa());
    }
    add_rows(variant, totals, rows);
  }
  return rows;
}

}  // namespace tarmac::tools
