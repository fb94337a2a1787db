/// Trajectory text formats: TUM (t x y z qx qy qz qw), KITTI (3x4 row-major, no time), EuRoC (t_ns,x,y,z,qw,qx,qy,qz,...).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::io {

struct StampedPose {
  core::Time t;
  core::SE3 T;
};

/// All nanosecond digits, 9 decimals and more; written whole or not at all.
void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses, const std::string& comment = {});
/// Throws InputError with file, line and what was expected: a wrong number of fields, a number that is none, a
/// quaternion far from unit norm, times that do not ascend.
std::vector<StampedPose> read_tum(const std::filesystem::path& file);
void write_kitti_poses(const std::filesystem::path& file, const std::vector<StampedPose>& poses);
/// KITTI has no times: pose k gets k * period, or the k-th line of `times_file` (seconds) when that is not empty.
std::vector<StampedPose> read_kitti_poses(const std::filesystem::path& file, const std::filesystem::path& times_file,
                                          core::Duration period);
std::vector<StampedPose> read_euroc(const std::filesystem::path& file);
void write_euroc(const std::filesystem::path& file, const std::vector<StampedPose>& poses);
/// By content: EuRoC has commas, KITTI 12 columns, TUM 8.
std::vector<StampedPose> read_trajectory(const std::filesystem::path& file);

}  // namespace tarmac::io
