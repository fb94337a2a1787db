#include "tools/tarmac/foreign.h"

#include <fmt/format.h>

#include <optional>

#include "core/diagnostics.h"
#include "core/error.h"
#include "core/merged_sweeps.h"
#include "tools/estimate/outputs.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForeignPoses = "foreign.tum";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 29;  // ten hours at 1 kHz are less

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size()) {
    text.replace(at, what.size(), with);
  }
  return text;
}

core::SegmentModel model_of(const std::string& interpolation) {
  if (interpolation == "slerp") return core::SegmentModel::sampled_slerp;
  if (interpolation == "hold") return core::SegmentModel::sampled_hold;
  return core::SegmentModel::sampled_screw;
}

}  // namespace

ChildRequest foreign_command(const ForeignTool& tool, const fs::path& workplace) {
  ChildRequest child;
  for (std::string word : tool.command) {
    word = replaced(word, "{input}", (workplace / "input").string());
    word = replaced(word, "{output}", (workplace / "output" / kForeignPoses).string());
    // The child works in a folder of its own: what names a file from here must keep naming it from there.
    const bool option = word.starts_with('-');
    if (!option && !word.empty() && !fs::path(word).is_absolute() && fs::is_regular_file(word)) {
      word = fs::absolute(word).lexically_normal().string();
    }
    child.command.push_back(word);
  }
  return child;
}

core::Estimate estimate_from_poses(const std::string& name, const ForeignTool& tool,
                                   const std::vector<io::StampedPose>& poses, const core::Recording& recording) {
  if (poses.empty()) throw core::InputError("the trajectory holds no pose");
  // Several LiDARs were handed over as one, whose frame is the body's.
  std::optional<core::MergedSweeps> merged;
  if (recording.rig().lidars.size() > 1) merged.emplace(recording);
  const core::Rig& rig = merged ? merged->rig() : recording.rig();
  const core::SE3 T_lidar_body = rig.lidars.at(0).T_body_lidar.inverse();
  std::vector<core::Time> times;
  std::vector<core::SE3> T_map_body;
  for (const io::StampedPose& pose : poses) {
    times.push_back(pose.t);
    T_map_body.push_back(tool.frame == "lidar" ? pose.T * T_lidar_body : pose.T);
  }
  core::Estimate estimate;
  estimate.estimator = name;
  estimate.causal.append(core::Segment::sampled(model_of(tool.interpolation), std::move(times), std::move(T_map_body)));
  for (std::size_t i = 0; i < recording.sweep_count(); ++i) {
    const core::LidarSweep sweep = merged ? merged->sweep(i) : recording.sweep(i);
    core::SweepResult result{sweep.index,          sweep.begin, sweep.end, sweep.end, core::SweepStatus::lost,
                             core::SE3::Identity()};
    if (estimate.causal.covers(sweep.end)) {
      result.status = core::SweepStatus::ok;
      result.T_map_body = estimate.causal.pose(sweep.end);
    }
    estimate.sweeps.push_back(result);
  }
  return estimate;
}

void adopt_foreign_output(const std::string& name, const ForeignTool& tool, const fs::path& recording_folder,
                          const fs::path& output, const ChildResult& child, Outcome& outcome) {
  if (outcome.failed()) return;
  const fs::path poses_file = output / kForeignPoses;
  if (!fs::is_regular_file(poses_file)) {
    outcome.status = "no_output";
    outcome.message = "the program ended well but wrote no trajectory to {output}";
    return;
  }
  if (const std::uintmax_t bytes = fs::file_size(poses_file); bytes > kMostBytes) {
    outcome.status = "bad_output";
    outcome.message = fmt::format("the trajectory has {} bytes; more than {} are not read", bytes, kMostBytes);
    return;
  }
  try {
    const std::vector<io::StampedPose> poses = io::read_tum(poses_file);
    const core::Recording recording = core::Recording::open(recording_folder);
    const core::Estimate estimate = estimate_from_poses(name, tool, poses, recording);
    const std::vector<io::StampedPose> reference = reference_poses(estimate);
    if (reference.empty()) {
      throw core::InputError("its poses cover the end of no sweep; are its stamps seconds on the recording's clock?");
    }
    io::write_tum(output / "trajectory.tum", dense_poses(estimate));
    io::write_tum(output / "reference.tum", reference);
    core::save_timing(output / "timing.json", {0, child.wall_s, child.cpu_s, child.peak_memory_mb, {}});
    core::save_estimate(output / "trajectory.bin", estimate);
  } catch (const core::InputError& error) {
    outcome.status = "bad_output";
    outcome.message = error.what();
  }
}

}  // namespace tarmac::tools
