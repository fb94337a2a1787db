#include "tools/estimate/outputs.h"

#include <fmt/format.h>

#include <system_error>

#include "core/error.h"

namespace tarmac::tools {
namespace {

constexpr std::int64_t kMaxStepNs = 10'000'000;

/// Where the trajectory is covered, and not twice at one instant.
void add_pose(const core::PiecewiseTrajectory& trajectory, core::Time t, std::vector<io::StampedPose>& poses) {
  if (!poses.empty() && t <= poses.back().t) return;
  if (const core::Segment* segment = trajectory.find(t)) poses.push_back({t, segment->pose(t)});
}

}  // namespace

std::vector<io::StampedPose> dense_poses(const core::Estimate& estimate) {
  std::vector<io::StampedPose> poses;
  for (const core::SweepResult& sweep : estimate.sweeps) {
    if (sweep.status == core::SweepStatus::out_of_order) continue;
    const std::int64_t span_ns = (sweep.end - sweep.begin).count();
    const std::int64_t steps = std::max<std::int64_t>(1, (span_ns + kMaxStepNs - 1) / kMaxStepNs);
    for (std::int64_t k = 0; k <= steps; ++k) {
      add_pose(estimate.headline(), sweep.begin + core::Duration(span_ns * k / steps), poses);
    }
  }
  return poses;
}

std::vector<io::StampedPose> reference_poses(const core::Estimate& estimate) {
  std::vector<io::StampedPose> poses;
  for (const core::SweepResult& sweep : estimate.sweeps) {
    if (sweep.status == core::SweepStatus::ok) poses.push_back({sweep.reference, sweep.T_map_body});
  }
  return poses;
}

void begin_outputs(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const char* earlier : {"trajectory.bin", "diagnostics.bin"})
    if (!error) std::filesystem::remove(folder / earlier, error);
  if (error) {
    throw core::InputError(fmt::format("--output {}: {}; give a folder that can be created and written to",
                                       folder.string(), error.message()));
  }
}

void write_outputs(const std::filesystem::path& folder, const estimators::RunResult& run) {
  const std::string& name = run.estimate.estimator;
  core::save_timing(folder / "timing.json", run.timing);
  io::write_tum(folder / "trajectory.tum", dense_poses(run.estimate), fmt::format("T_map_body of {}, dense", name));
  io::write_tum(folder / "reference.tum", reference_poses(run.estimate),
                fmt::format("T_map_body of {} at the reference instants of its sweeps that are ok", name));
  core::save_estimate(folder / "trajectory.bin", run.estimate);
}

}  // namespace tarmac::tools
