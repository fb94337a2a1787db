// The ray tracer alone against the whole way from rays to noisy points, on the stand's own sweeps.
#include <fmt/format.h>

#include <algorithm>
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
constexpr int kRounds = 9;  // of raw, pipeline, raw, pipeline, ...; the best of each counts

struct Best {
  double raw_s = std::numeric_limits<double>::infinity();
  double pipeline_s = raw_s, encoding_s = raw_s;
};

struct Totals {
  double rays = 0, raw_s = 0, pipeline_s = 0, encoding_s = 0;
  int sweeps = 0;
};

/// Raw: rtcIntersect16 on tiles packed beforehand. Pipeline: ray generation to finished noisy arrays. Encoding: points
/// and labels to compressed chunks. All on this thread.
void measure(const sim::lidar::SweepSimulator& simulator, const scenes::Scene& scene, std::int64_t index,
             Totals& totals) {
  const sim::lidar::AimedSweep aimed = simulator.aimed(index);
  sim::raycast::PackedTiles packed = aimed.tracer.pack(aimed.rays, aimed.tiles);
  sim::lidar::SimulatedSweep sweep;
  sim::lidar::Workspace workspace;
  Best best;
  for (int round = 0; round < kRounds; ++round) {
    packed.reset();
    best.raw_s = std::min(best.raw_s, cpu_s_of([&] { packed.intersect(); }));
    best.pipeline_s = std::min(best.pipeline_s, cpu_s_of([&] { simulator.sweep(index, workspace, sweep); }));
    best.encoding_s = std::min(best.encoding_s, cpu_s_of([&] { sim::encode(sweep, scene); }));
  }
  totals.rays += static_cast<double>(packed.rays());
  totals.raw_s += best.raw_s;
  totals.pipeline_s += best.pipeline_s;
  totals.encoding_s += best.encoding_s;
  totals.sweeps += 1;
}

void add_rows(const std::string& variant, const Totals& t, BenchRows& rows) {
  const auto add = [&](const char* metric, double value, const char* unit) {
    rows.push_back({"sim", variant, metric, value, unit});
  };
  add("raw_mrays_per_s", 1e-6 * t.rays / t.raw_s, "Mrays/s");
  add("pipeline_mrays_per_s", 1e-6 * t.rays / t.pipeline_s, "Mrays/s");
  add("pipeline_raw_ratio", t.raw_s / t.pipeline_s, "1");
  add("overhead_ns_per_ray", 1e9 * (t.pipeline_s - t.raw_s) / t.rays, "ns");
  add("pipeline_ms_per_sweep", 1e3 * t.pipeline_s / t.sweeps, "ms");
  add("encoding_ms_per_sweep", 1e3 * t.encoding_s / t.sweeps, "ms");
}

}  // namespace

BenchRows bench_sim(const Console& console) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(scenarios::find_scenario("stand-turn", scenario_folders()), {});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  const sim::SimulationInput input = build_world(scenario, seed, "");
  const sim::RigOptions rig = sim::read_rig(input.rig);
  BenchRows rows;
  for (const bool fast : {false, true}) {
    const std::string variant = fast ? "fast" : "default";
    const auto tracer =
        std::make_shared<const sim::raycast::Tracer>(input.scene, sim::raycast::TracerSettings{1, fast});
    const sim::lidar::SweepSimulator simulator(rig.lidars[0].profile, sim::firing_table(rig, seed),
                                               {.sensor = 0, .T_body_lidar = rig.lidars[0].T_body_lidar},
                                               rig.lidars[0].noise, seed, tracer, input.scene, input.motion);
    const std::int64_t count =
        simulator.firing().sweeps_until(std::min(core::Time(input.duration), input.motion->end()));
    const core::Progress progress = console.progress("sim, " + variant);
    Totals totals;
    for (int k = 0; k < kSweeps; ++k) {
      measure(simulator, *input.scene, count * k / kSweeps, totals);
      progress((k + 1.0) / kSweeps, tracer->isa());
    }
    add_rows(variant, totals, rows);
  }
  for (BenchRow& row : bench_beams(console)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace tarmac::tools
