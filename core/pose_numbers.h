/// A pose as twelve plain numbers, every digit kept.
#pragma once

#include "core/lie.h"

namespace tarmac::core {

/// The upper three rows of the 4x4 matrix, column by column.
using PoseNumbers = Eigen::Matrix<double, 12, 1>;

inline PoseNumbers numbers_of(const SE3& T) {
  PoseNumbers numbers;
  Eigen::Map<Eigen::Matrix<double, 3, 4>>(numbers.data()) = T.matrix().topRows<3>();
  return numbers;
}

inline SE3 pose_of(const PoseNumbers& numbers) {
  SE3 T = SE3::Identity();
  T.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(numbers.data());
  return T;
}

}  // namespace tarmac::core
