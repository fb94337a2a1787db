// Footprints of seven rays in real time: a sensor of 128 channels at 2048 columns and 10 Hz, on the stand's own drive.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "scenarios/scenario.h"
#include "sim/rig_options.h"
#include "tools/bench/cpu_clock.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

constexpr int kSweeps = 12;  // spread over the drive
constexpr int kRounds = 3;   // the best of each sweep counts
constexpr double kSweep_s = 0.1;

struct Cost {
  double cpu_s = 0, wall_s = std::numeric_limits<double>::infinity();
  double beams = 0, traced = 0, split = 0;
};

/// Processor time of each sweep, on this thread.
void time_sweeps(const sim::lidar::SweepSimulator& simulator, const std::vector<std::int64_t>& sweeps, Cost& cost) {
  sim::lidar::Workspace workspace;
  sim::lidar::SimulatedSweep sweep;
  for (const std::int64_t index : sweeps) {
    double best_s = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round)
      best_s = std::min(best_s, cpu_s_of([&] { simulator.sweep(index, workspace, sweep); }));
    cost.cpu_s += best_s;
    cost.beams += static_cast<double>(sweep.rays);
    cost.traced += static_cast<double>(sweep.traced_rays);
    cost.split += static_cast<double>(sweep.split_beams);
  }
}

/// Wall time of all sweeps on `threads` threads at once; the best of a few rounds.
void time_together(const sim::lidar::SweepSimulator& simulator, const std::vector<std::int64_t>& sweeps,
                   unsigned threads, Cost& cost) {
  for (int round = 0; round < kRounds; ++round) {
    std::atomic<std::size_t> next = 0;
    const auto begin = std::chrono::steady_clock::now();
    {
      std::vector<std::jthread> workers;
      for (unsigned k = 0; k < threads; ++k)
        workers.emplace_back([&] {
          sim::lidar::Workspace workspace;
          sim::lidar::SimulatedSweep sweep;
          for (std::size_t i = next++; i < sweeps.size(); i = next++) simulator.sweep(sweeps[i], workspace, sweep);
        });
    }
    cost.wall_s =
        std::min(cost.wall_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
}

void add_rows(const std::string& variant, const Cost& cost, double rays, unsigned threads, BenchRows& rows) {
  const auto add = [&](const char* metric, double value, const char* unit) {
    rows.push_back({"sim", variant, metric, value, unit});
  };
  const double simulated_s = kSweep_s * kSweeps;
  add("pipeline_mbeams_per_s", 1e-6 * cost.beams / cost.cpu_s, "Mbeams/s");
  add("pipeline_mrays_per_s", 1e-6 * rays * cost.beams / cost.cpu_s, "Mrays/s");
  add("traced_rays_per_beam", cost.traced / cost.beams, "1");
  add("split_beams_percent", 100 * cost.split / cost.beams, "%");
  add("pipeline_ms_per_sweep", 1e3 * cost.cpu_s / kSweeps, "ms");
  add("threads", threads, "1");
  add("real_time_factor", simulated_s / cost.wall_s, "1");
  add("real_time_factor_by_cpu", threads * simulated_s / cost.cpu_s, "1");
}

}  // namespace

BenchRows bench_beams(const Console& console) {
  scenarios::Scenario scenario = scenarios::load_scenario(
      scenarios::find_scenario("stand-turn", scenario_folders()),
      {{"rig.lidar.model", "ouster-os1-128-rev7"}, {"rig.lidar.columns", "2048"}, {"rig.lidar.beam.rays", "7"}});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  const sim::SimulationInput input = build_world(scenario, seed, "");
  const sim::RigOptions rig = sim::read_rig(input.rig);
  const sim::LidarOptions& lidar = rig.lidars[0];
  const auto tracer = std::make_shared<const sim::raycast::Tracer>(
      input.scene, sim::raycast::TracerSettings{.threads = 1, .fast = true});
  const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, 2u);
  BenchRows rows;
  for (const int rays : {1, 7}) {
    sim::lidar::Requests requests;
    requests.beam = lidar.beam;
    requests.beam.rays = rays;
    const sim::lidar::SweepSimulator simulator(lidar.profile, sim::firing_table(rig, seed),
                                               {.sensor = 0, .T_body_lidar = lidar.T_body_lidar}, lidar.noise, seed,
                                               tracer, input.scene, input.motion, requests);
    const std::int64_t count =
        simulator.firing().sweeps_until(std::min(core::Time(input.duration), input.motion->end()));
    std::vector<std::int64_t> sweeps;
    for (int k = 0; k < kSweeps; ++k) sweeps.push_back(count * k / kSweeps);
    const std::string variant = rays > 1 ? fmt::format("fast-{}-rays", rays) : "fast-128x2048";
    const core::Progress progress = console.progress("sim, " + variant);
    Cost cost;
    time_sweeps(simulator, sweeps, cost);
    progress(0.7, tracer->isa());
    time_together(simulator, sweeps, threads, cost);
    progress(1, tracer->isa());
    add_rows(variant, cost, rays, threads, rows);
  }
  return rows;
}

}  // namespace tarmac::tools
