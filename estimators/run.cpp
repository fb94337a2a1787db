#include "estimators/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>
#include <stdexcept>

#include "core/error.h"
#include "core/merged_sweeps.h"

namespace tarmac::estimators {
namespace {

using core::Duration;
using core::Time;

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CPU time of the whole process, all threads.
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

bool needs(const EstimatorEntry& entry, Needs sensor) {
  return (static_cast<unsigned>(entry.needs) & static_cast<unsigned>(sensor)) != 0;
}

/// Why the estimator cannot run on this recording; empty when it can.
std::string missing_sensor(const core::Recording& recording, const EstimatorEntry& entry) {
  const core::Rig& rig = recording.rig();
  if (rig.lidars.empty() || recording.sweep_count() == 0) return "the recording has no LiDAR sweep";
  if (!needs(entry, Needs::imu)) return {};
  if (rig.imus.empty()) return fmt::format("{} needs an IMU and the recording has none", entry.name);
  if (recording.imu().empty()) return fmt::format("{} needs an IMU and the recording's has no sample", entry.name);
  return {};
}

/// Takes out points with a coordinate that is NaN or infinite. @returns how many
std::size_t drop_non_finite(core::LidarSweep& sweep) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    if (!std::isfinite(sweep.x_m[i]) || !std::isfinite(sweep.y_m[i]) || !std::isfinite(sweep.z_m[i])) continue;
    sweep.x_m[kept] = sweep.x_m[i];
    sweep.y_m[kept] = sweep.y_m[i];
    sweep.z_m[kept] = sweep.z_m[i];
    sweep.t_ns[kept] = sweep.t_ns[i];
    sweep.ring[kept] = sweep.ring[i];
    sweep.intensity[kept] = sweep.intensity[i];
    if (!sweep.point_sensor.empty()) sweep.point_sensor[kept] = sweep.point_sensor[i];
    ++kept;
  }
  const std::size_t dropped = sweep.size() - kept;
  for (std::vector<float>* column : {&sweep.x_m, &sweep.y_m, &sweep.z_m, &sweep.intensity}) column->resize(kept);
  sweep.t_ns.resize(kept);
  sweep.ring.resize(kept);
  if (!sweep.point_sensor.empty()) sweep.point_sensor.resize(kept);
  return dropped;
}

/// The method itself broke: the run is `failed`, what it gave until then is kept.
class EstimatorFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whatever the method throws, or breaks of its contract, is its failure; what progress or the recording throws is not.
template <class Call>
void guarded(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    throw EstimatorFailure(error.what());
  }
}

/// Feeds one estimator and keeps what it says.
class Runner {
 public:
  Runner(const EstimatorEntry& entry, Estimator& estimator, core::DiagnosticsLevel level, std::size_t sweeps,
         const core::Progress& progress, const DiagnosticsSink& sink)
      : entry_(entry), estimator_(estimator), level_(level), sweeps_(sweeps), progress_(progress), sink_(sink) {}

  /// `source`: a recording, or its sweeps merged.
  template <class Source>
  void run(const Source& source, RunResult& result) {
    source.replay(
        [&](std::size_t k, const core::ImuSample& sample) {
          if (k == 0) on_imu(sample);
        },
        [&](const core::LidarSweep& sweep) {
          if (sweep.sensor == 0)
            on_sweep(sweep, result);
          else if (entry_.raw_lidars)
            on_other_sweep(sweep, result);
        });
    if (dropped_imu_ > 0) {
      result.log.push_back(
          fmt::format("{} IMU samples dropped: not finite, or not later than the one before", dropped_imu_));
    }
    guarded([&] { estimator_.finish(result.estimate); });
  }

 private:
  /// Calls the estimator on the clock: the wall's and the process's.
  template <class Call>
  void timed(const Call& call) {
    const double wall = wall_s(), cpu = cpu_s();
    guarded(call);
    wall_ms_ += 1e3 * (wall_s() - wall);
    cpu_ms_ += 1e3 * (cpu_s() - cpu);
  }

  void on_imu(const core::ImuSample& sample) {
    const bool finite = sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite();
    if (!finite || (last_imu_ && sample.t <= *last_imu_)) {
      ++dropped_imu_;
      return;
    }
    last_imu_ = sample.t;
    timed([&] { estimator_.add(sample); });
  }

  void on_sweep(core::LidarSweep sweep, RunResult& result) {
    ++seen_;
    if ((last_end_ && sweep.begin < *last_end_) || sweep.end < sweep.begin) {
      result.log.push_back(fmt::format(
          "sweep {}: dropped, it begins before its predecessor ended or ends before it begins", sweep.index));
      drop(sweep, result);
      return;
    }
    last_end_ = sweep.end;
    if (const std::size_t dropped = drop_non_finite(sweep); dropped > 0) {
      result.log.push_back(
          fmt::format("sweep {}: {} points dropped, their coordinates are not finite", sweep.index, dropped));
    }
    SweepOutcome outcome;
    timed([&] { outcome = estimator_.add(sweep); });
    if (sweep.empty()) {
      result.log.push_back(fmt::format("sweep {}: no point left", sweep.index));
      if (needs(entry_, Needs::lidar)) outcome.result.status = core::SweepStatus::empty;
    }
    guarded([&] { keep(outcome, result); });
    if (level_ != core::DiagnosticsLevel::none) {
      if (sink_) {
        sink_(outcome.diagnostics);
      } else {
        result.diagnostics.push_back(std::move(outcome.diagnostics));
      }
    }
    if (progress_) progress_(static_cast<double>(seen_) / static_cast<double>(sweeps_), note());
  }

  /// Of a LiDAR beside the first, for a method that wants them as they are: no result is expected of it.
  void on_other_sweep(core::LidarSweep sweep, RunResult& result) {
    std::optional<Time>& last_end = last_end_of_[sweep.sensor];
    if ((last_end && sweep.begin < *last_end) || sweep.end < sweep.begin) {
      result.log.push_back(
          fmt::format("lidar{} sweep {}: dropped, it begins before its predecessor ended or ends before it begins",
                      sweep.sensor, sweep.index));
      return;
    }
    last_end = sweep.end;
    if (const std::size_t dropped = drop_non_finite(sweep); dropped > 0)
      result.log.push_back(fmt::format("lidar{} sweep {}: {} points dropped, their coordinates are not finite",
                                       sweep.sensor, sweep.index, dropped));
    timed([&] { estimator_.add(sweep); });
  }

  std::string note() const {
    return fmt::format("sweep {} of {}, {:.1f} ms a sweep", seen_, sweeps_,
                       total_wall_ms_ / static_cast<double>(seen_));
  }

  void drop(const core::LidarSweep& sweep, RunResult& result) {
    core::SweepResult dropped{.index = sweep.index, .begin = sweep.begin, .end = sweep.end, .reference = sweep.end};
    dropped.status = core::SweepStatus::out_of_order;
    result.estimate.sweeps.push_back(dropped);
  }

  /// What the method spent on its record is the instrument's cost, not the method's.
  void leave_out_the_record(const SweepOutcome& outcome) {
    double record_ms = 0;
    for (const auto& [stage, ms] : outcome.stages_ms)
      if (stage == kRecordStage || stage == kSurfacesStage) record_ms += ms;
    const double share = wall_ms_ > 0 ? std::clamp(1 - record_ms / wall_ms_, 0.0, 1.0) : 1;
    wall_ms_ *= share;
    cpu_ms_ *= share;
  }

  void keep(SweepOutcome& outcome, RunResult& result) {
    leave_out_the_record(outcome);
    const core::SweepResult& sweep = outcome.result;
    if (sweep.status == core::SweepStatus::lost) {
      result.log.push_back(fmt::format("sweep {}: lost, the prediction was kept", sweep.index));
    }
    if (!outcome.note.empty()) result.log.push_back(fmt::format("sweep {}: {}", sweep.index, outcome.note));
    if (!core::se3::all_finite(sweep.T_map_body)) {
      throw std::runtime_error(
          fmt::format("{} returned a pose that is not finite for sweep {}", entry_.name, sweep.index));
    }
    for (core::Segment& segment : outcome.motion) result.estimate.causal.append(std::move(segment));
    result.estimate.sweeps.push_back(sweep);
    result.timing.sweeps.push_back({sweep.index, wall_ms_, cpu_ms_, std::move(outcome.stages_ms)});
    total_wall_ms_ += wall_ms_;
    wall_ms_ = cpu_ms_ = 0;
  }

  const EstimatorEntry& entry_;
  Estimator& estimator_;
  core::DiagnosticsLevel level_;
  std::size_t sweeps_, seen_ = 0, dropped_imu_ = 0;
  const core::Progress& progress_;
  const DiagnosticsSink& sink_;
  std::optional<Time> last_imu_, last_end_;
  std::map<std::uint16_t, std::optional<Time>> last_end_of_;  // of LiDARs beside the first
  double wall_ms_ = 0, cpu_ms_ = 0, total_wall_ms_ = 0;
};

}  // namespace

RunResult run_estimator(const core::Recording& recording, const EstimatorEntry& entry, const core::ConfigNode& options,
                        const EstimatorContext& context, const core::Progress& progress, const DiagnosticsSink& sink) {
  const double wall = wall_s(), cpu = cpu_s();
  RunResult result;
  result.estimate.estimator = entry.name;
  result.timing.threads = context.threads;
  if (const std::string missing = missing_sensor(recording, entry); !missing.empty()) {
    result.estimate.status = core::RunStatus::not_initialised;
    result.estimate.message = missing;
  } else {
    const bool merge = recording.rig().lidars.size() > 1 && !entry.raw_lidars;
    std::optional<core::MergedSweeps> merged;
    EstimatorContext seen = context;
    if (merge) seen.rig = merged.emplace(recording).rig();
    const std::unique_ptr<Estimator> estimator = entry.make(options, seen);
    if (merge)
      result.log.push_back(
          fmt::format("{} LiDARs: their sweeps are merged, in the body's frame", recording.rig().lidars.size()));
    if (recording.rig().imus.size() > 1) result.log.push_back("several IMUs: only the first one's samples are used");
    try {
      Runner runner(entry, *estimator, context.diagnostics, recording.sweep_count(), progress, sink);
      if (merge)
        runner.run(*merged, result);
      else
        runner.run(recording, result);
    } catch (const EstimatorFailure& failure) {
      result.estimate.status = core::RunStatus::failed;
      result.estimate.message = failure.what();
    }
  }
  result.timing.wall_s = wall_s() - wall;
  result.timing.cpu_s = cpu_s() - cpu;
  result.timing.peak_memory_mb = peak_memory_mb();
  return result;
}

}  // namespace tarmac::estimators
