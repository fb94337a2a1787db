#include "estimators/window_odometry/estimator.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimators/blocks/stopwatch.h"
#include "estimators/window_odometry/record.h"

namespace tarmac::estimators {

WindowOdometryEstimator::WindowOdometryEstimator(const WindowOdometrySettings& settings,
                                                 const EstimatorContext& context)
    : odometry_(settings, context.rig), level_(context.diagnostics), arena_(std::max(1, context.threads)) {}

SweepOutcome WindowOdometryEstimator::add(const core::LidarSweep& sweep) {
  WindowOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep); });
  if (!step.started) return initialising_outcome(sweep);
  started_ = true;
  SweepOutcome outcome;
  outcome.stages_ms = std::move(step.stages_ms);
  Stopwatch stopwatch(outcome.stages_ms);
  outcome.result = {.index = sweep.index,
                    .begin = sweep.begin,
                    .end = sweep.end,
                    .reference = sweep.end,
                    .status = sweep.empty() ? core::SweepStatus::empty
                                            : (step.lost ? core::SweepStatus::lost : core::SweepStatus::ok),
                    .T_map_body = step.T_map_body_end};
  if (step.clipped_stamps > 0)
    outcome.note =
        fmt::format("{} keypoints' stamps outside the sweep, moved to its begin or end", step.clipped_stamps);
  if (level_ != core::DiagnosticsLevel::none) {
    outcome.diagnostics = arena_.execute([&] { return record_of(sweep, odometry_, step, level_); });
    stopwatch.lap(kRecordStage);
  }
  outcome.diagnostics.index = sweep.index;
  outcome.motion = {std::move(step.motion)};
  return outcome;
}

void WindowOdometryEstimator::finish(core::Estimate& estimate) {
  // Where gravity's direction is an unknown, the map keeps the tilt that the start gave it.
  const ImuSettings& imu = odometry_.settings().imu;
  estimate.gravity_aligned = imu.gyro() && !imu.free_gravity;
  if (started_) {
    estimate.message = arena_.execute([&] { return offset_message(odometry_.window()); });
    return;
  }
  estimate.status = core::RunStatus::not_initialised;
  estimate.message = odometry_.why_not();
}

}  // namespace tarmac::estimators
