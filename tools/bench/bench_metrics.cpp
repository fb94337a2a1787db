// Scoring one trajectory against another, of the length of KITTI's sequence 00.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/random.h"
#include "io/sensor/tum.h"
#include "metrics/foreign.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

constexpr int kPoses = 4541;
constexpr int kProcessRuns = 7;

/// A drive of hills and bends at 10 Hz, and an estimate that drifts away from it by a random walk.
struct Pair {
  std::vector<metrics::StampedPose> truth, estimate;
};

Pair make_pair() {
  const core::RandomStream random(1, "bench/metrics");
  Pair pair;
  core::SE3 true_pose = core::SE3::Identity(), drifting = core::SE3::Identity();
  for (int k = 0; k < kPoses; ++k) {
    const core::Time t = core::time_from_s(0.1 * k);
    pair.truth.emplace_back(t, true_pose);
    pair.estimate.emplace_back(t, drifting);
    core::Vector6 step, error;
    step << 0.8 + 0.3 * std::sin(0.01 * k), 0, 0, 0, 0.004 * std::sin(0.02 * k), 0.02 * std::sin(0.005 * k);
    for (int i = 0; i < 6; ++i)
      error[i] = (i < 3 ? 0.01 : 2e-4) * random.normal(static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(i));
    true_pose = core::se3::normalized(true_pose * core::se3::exp(step));
    drifting = core::se3::normalized(drifting * core::se3::exp(step) * core::se3::exp(error));
  }
  return pair;
}

/// Keeps the figures instead of printing them.
class Keep : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration) best_ms = std::min(best_ms, run.GetAdjustedCPUTime());
    }
  }
  double best_ms = std::numeric_limits<double>::infinity();
};

double evaluate_ms(const Pair& pair) {
  metrics::ForeignSettings settings;
  settings.alignment = metrics::alignment("se3");  // what `tarmac evaluate` takes
  benchmark::RegisterBenchmark(
      "evaluate_4541",
      [&](benchmark::State& state) {
        for ([[maybe_unused]] auto _ : state)
          benchmark::DoNotOptimize(metrics::evaluate_poses(pair.truth, pair.estimate, settings));
      })
      ->Unit(benchmark::kMillisecond)
      ->Repetitions(5)
      ->MinTime(0.2);
  Keep reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter, "evaluate_4541");
  benchmark::ClearRegisteredBenchmarks();
  return reporter.best_ms;
}

void write(const std::filesystem::path& file, const std::vector<metrics::StampedPose>& poses) {
  std::vector<io::StampedPose> stamped;
  for (const auto& [t, T] : poses) stamped.push_back({t, T});
  io::write_tum(file, stamped);
}

/// Wall time of `tarmac evaluate --truth --estimate`: start, parse, evaluate, print.
double process_ms(const Pair& pair, const core::Progress& progress) {
  const PrivateFolder folder;
  write(folder.path() / "truth.tum", pair.truth);
  write(folder.path() / "estimate.tum", pair.estimate);
  ChildRequest request;
  request.command = {(program_folder() / "tarmac").string(),
                     "evaluate",
                     "--truth",
                     "truth.tum",
                     "--estimate",
                     "estimate.tum",
                     "--json"};
  request.working_folder = folder.path();
  request.log_file = folder.path() / "log.txt";
  double best_s = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kProcessRuns; ++run) {
    const ChildResult result = run_child(request);
    if (result.end != ChildResult::End::exited || result.code != 0)
      throw std::runtime_error("bench metrics: `tarmac evaluate` failed on the pair that it was given");
    best_s = std::min(best_s, result.wall_s);
    progress(0.5 + 0.5 * (run + 1) / kProcessRuns, "");
  }
  return 1e3 * best_s;
}

}  // namespace

BenchRows bench_metrics(const Console& console) {
  const core::Progress progress = console.progress("metrics");
  const Pair pair = make_pair();
  const double in_process_ms = evaluate_ms(pair);
  progress(0.5, "");
  return {{"metrics", "4541-poses", "evaluate_4541_ms", in_process_ms, "ms"},
          {"metrics", "4541-poses", "evaluate_4541_process_wall_ms", process_ms(pair, progress), "ms"}};
}

}  // namespace tarmac::tools
