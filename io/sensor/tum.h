/// Trajectory text formats: TUM (t x y z qx qy qz qw), KITTI (3x4 row-major, no time), EuRoC
/// (t_ns,x,y,z,qw,qx,qy,qz,...). In all of them '#' begins a comment, and every reader throws core::InputError
/// "file:line: what was expected" for a wrong number of fields, a number that is none, a quaternion or matrix that is
/// no rotation (1e-3), times that do not strictly ascend, and a file without a pose.
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

/// Time between KITTI poses whose times nobody gives: the sensor of that benchmark turns at 10 Hz.
constexpr core::Duration kitti_period{100'000'000};

/// All nanosecond digits; positions with 12 decimals, quaternions with 15 (qw >= 0). Written whole or not at all.
void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses,
               const std::string& comment = {});
/// Times are read from their decimals, exact to the nanosecond.
std::vector<StampedPose> read_tum(const std::filesystem::path& file);
void write_kitti_poses(const std::filesystem::path& file, const std::vector<StampedPose>& poses);
/// KITTI has no times: pose k gets k * period, or the k-th line of `times_file` (seconds) when that is not empty.
std::vector<StampedPose> read_kitti_poses(const std::filesystem::path& file, const std::filesystem::path& times_file,
                                          core::Duration period);
/// Columns after the eighth (velocity, biases) are left out.
std::vector<StampedPose> read_euroc(const std::filesystem::path& file);
void write_euroc(const std::filesystem::path& file, const std::vector<StampedPose>& poses);
/// By content of the first line: EuRoC has commas, KITTI 12 columns, TUM 8. KITTI's times are taken from times.txt
/// beside the file where there is one, else pose k is at k * kitti_period.
std::vector<StampedPose> read_trajectory(const std::filesystem::path& file);

}  // namespace tarmac::io
