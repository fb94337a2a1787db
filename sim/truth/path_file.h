/// Recorded poses as text: TUM (t x y z qx qy qz qw) or CSV with the same columns.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/time.h"

namespace tarmac::sim::truth {

struct RecordedPose {
  core::Time t;
  Eigen::Vector3d xyz_m;
  Eigen::Vector4d quat_xyzw;  ///< as given, of unit length
  int line = 0;               ///< of its file, counted from 1
};

/// Columns are separated by spaces, tabs or commas; '#' begins a comment; a first line of column names is passed over.
/// Times are in seconds and keep their nanoseconds. Throws InputError with `name` and line: what is no number, NaN, no
/// rotation, or a time that is not later than the one before it.
std::vector<RecordedPose> parse_path(const std::string& text, const std::string& name);

}  // namespace tarmac::sim::truth
