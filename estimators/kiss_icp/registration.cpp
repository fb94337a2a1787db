#include "estimators/kiss_icp/registration.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace tarmac::estimators {

using core::Matrix6;
using core::SE3;
using core::Vector6;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The normal equations by their moments: 17 numbers a point to add instead of 42.
struct Registration::Sums {
  int count = 0;
  double w = 0;
  Vector3d ws = Vector3d::Zero();
  Vector3d wr = Vector3d::Zero();
  Vector3d w_s_cross_r = Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< sum of w s s^T

  void add(double weight, const Vector3d& s, const Vector3d& r) {
    const Vector3d a = weight * s;
    ++count;
    w += weight;
    ws += a;
    wr += weight * r;
    w_s_cross_r += a.cross(r);
    xx += a.x() * s.x(), xy += a.x() * s.y(), xz += a.x() * s.z();
    yy += a.y() * s.y(), yz += a.y() * s.z(), zz += a.z() * s.z();
  }
  void add(const Sums& other) {
    count += other.count;
    w += other.w;
    ws += other.ws;
    wr += other.wr;
    w_s_cross_r += other.w_s_cross_r;
    xx += other.xx, xy += other.xy, xz += other.xz;
    yy += other.yy, yz += other.yz, zz += other.zz;
  }
  /// sum w [s]x^T [s]x
  Matrix3d H_rotation() const {
    Matrix3d H;
    H << yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy;
    return H;
  }
  Matrix6 H() const {
    Matrix6 H;
    H.topLeftCorner<3, 3>() = w * Matrix3d::Identity();
    H.topRightCorner<3, 3>() = -core::so3::hat(ws);
    H.bottomLeftCorner<3, 3>() = core::so3::hat(ws);
    H.bottomRightCorner<3, 3>() = H_rotation();
    return H;
  }
  Vector6 gradient() const {
    Vector6 g;
    g << wr, w_s_cross_r;
    return g;
  }
  /// Three points off one line fix all six degrees of freedom; seen from their centre, the rotation's block says so.
  bool fixes_pose() const {
    if (count < 3 || !(w > 0)) return false;
    const Matrix3d centre = core::so3::hat(ws);
    const Matrix3d about_centre = H_rotation() + centre * centre / w;
    const Vector3d lambda = Eigen::SelfAdjointEigenSolver<Matrix3d>(about_centre, Eigen::EigenvaluesOnly).eigenvalues();
    // Far from the map's origin the subtraction keeps few digits; collinear points give about 1e-16 near it.
    return lambda[2] > 0 && lambda[0] > 1e-10 * lambda[2];
  }
};

Registration::Sums Registration::iterate(const VoxelMap& map, const SE3& step, double sigma_m, bool with_hints) {
  const double reach2 = 9 * sigma_m * sigma_m;
  const auto chunk = [&](const tbb::blocked_range<std::size_t>& range, Sums sums) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Vector3d s = step.linear() * s_map_[i] + step.translation();
      s_map_[i] = s;
      Match& match = matches_[i];
      const bool hint = with_hints && match.weight > 0;
      const VoxelMap::Neighbour neighbour = map.nearest(s, reach2, hint ? &q_map_[i] : nullptr);
      match.weight = 0;
      if (!neighbour.found) continue;
      q_map_[i] = neighbour.point;
      match.residual_m = s - neighbour.point;
      const double spread = sigma_m + neighbour.distance2_m2;
      match.weight = sigma_m * sigma_m / (spread * spread);
      sums.add(match.weight, s, match.residual_m);
    }
    return sums;
  };
  const auto join = [](Sums a, const Sums& b) {
    a.add(b);
    return a;
  };
  return tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, s_map_.size(), 256), Sums{}, chunk,
                                            join);
}

IcpResult Registration::align(std::span<const Vector3d> source_m, const VoxelMap& map, const SE3& T_predicted,
                              double sigma_m) {
  IcpResult result{.T_map_lidar = T_predicted, .T_map_lidar_linearised = T_predicted};
  matches_.clear();
  result.solved = map.empty();
  if (map.empty()) return result;

  s_map_.assign(source_m.begin(), source_m.end());
  q_map_.resize(source_m.size());
  matches_.resize(source_m.size());
  SE3 step = T_predicted;
  while (!result.converged && result.iterations < settings_.max_iterations) {
    const Sums sums = iterate(map, step, sigma_m, result.iterations > 0);
    ++result.iterations;
    result.T_map_lidar_linearised = result.T_map_lidar;
    const Vector6 xi = sums.H().ldlt().solve(-sums.gradient());
    if (!sums.fixes_pose() || !xi.allFinite()) {
      result.T_map_lidar = result.T_map_lidar_linearised = T_predicted;
      result.solved = false;
      matches_.clear();
      return result;
    }
    step = core::se3::exp(xi);
    result.T_map_lidar = core::se3::normalized(step * result.T_map_lidar);
    result.solved = true;
    result.converged = xi.norm() < settings_.convergence;
  }
  return result;
}

}  // namespace tarmac::estimators
