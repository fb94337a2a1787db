// `tarmac import` and `tarmac export`.
#include <fmt/format.h>

#include "core/error.h"
#include "core/estimate.h"
#include "core/recording.h"
#include "io/sensor/plain.h"
#include "io/sensor/tum.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/export_images.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// The trajectory that `export` writes: an estimator's dense one, or the truth.
fs::path trajectory_of(const TransferArguments& arguments) {
  const fs::path from = arguments.from;
  if (fs::is_regular_file(from)) return from;
  const fs::path file =
      arguments.estimator.empty() ? from / "truth" / "truth.tum" : from / arguments.estimator / "trajectory.tum";
  if (!fs::is_regular_file(file)) {
    throw core::InputError(
        fmt::format("{}: there is no such trajectory; expected the folder of a run{}", file.string(),
                    arguments.estimator.empty() ? " with truth, or -e with an estimator's name" : ""));
  }
  return file;
}

/// One pose of the LiDAR a sweep (its clouds are in its frame), at the instant that the export's times.txt names.
std::vector<io::StampedPose> poses_at_mid_sweep(const core::Estimate& estimate, const core::Rig& rig) {
  std::vector<io::StampedPose> poses;
  for (const core::SweepResult& sweep : estimate.sweeps) {
    const core::Time middle = sweep.begin + (sweep.end - sweep.begin) / 2;
    if (!estimate.headline().covers(middle)) {
      throw core::InputError(fmt::format(
          "{}: sweep {} has no pose, and KITTI's poses.txt needs one a sweep; export as tum, or the recording alone",
          estimate.estimator, sweep.index));
    }
    // Of several LiDARs the clouds are merged, in the body's frame.
    const core::SE3 T_body_cloud = rig.lidars.size() > 1 ? core::SE3::Identity() : rig.lidars.at(0).T_body_lidar;
    poses.push_back({middle, estimate.headline().pose(middle) * T_body_cloud});
  }
  return poses;
}

}  // namespace

int import_command(const TransferArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  if (arguments.format == "tum") {
    io::write_tum(arguments.to, io::read_trajectory(arguments.from));
    fmt::print("{}\n", arguments.to);
    return 0;
  }
  const auto import = arguments.format == "kitti" ? io::import_kitti : io::import_plain;
  const std::string hash = import(arguments.from, arguments.to, console.progress("import"));
  fmt::print("{} {}\n", hash, arguments.to);
  return 0;
}

int export_command(const TransferArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  if (arguments.format == "tum") {
    io::write_tum(arguments.to, io::read_trajectory(trajectory_of(arguments)));
    fmt::print("{}\n", arguments.to);
    return 0;
  }
  if (arguments.format == "exr") return export_images(arguments, console);
  const core::Recording recording = core::Recording::open(recording_of(arguments.from));
  if (arguments.format == "plain") {
    if (!arguments.estimator.empty()) {
      throw core::InputError("export --format plain: -e has no place in it; use --format tum for a trajectory");
    }
    io::export_plain(recording, arguments.to, console.progress("export"));
  } else {
    fs::remove(fs::path(arguments.to) / "poses.txt");  // of an earlier export
    io::export_kitti(recording, arguments.to, console.progress("export"));
    if (!arguments.estimator.empty()) {
      const fs::path file = fs::path(arguments.from) / arguments.estimator / "trajectory.bin";
      io::write_kitti_poses(fs::path(arguments.to) / "poses.txt",
                            poses_at_mid_sweep(core::load_estimate(file), recording.rig()));
    }
  }
  fmt::print("{}\n", arguments.to);
  return 0;
}

}  // namespace tarmac::tools
