#include "estimators/blocks/local_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tarmac::estimators {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::optional<LocalPlane> fit_plane(std::span<const Vector3d> points_m, double max_thickness_m) {
  if (points_m.size() < 6) return std::nullopt;
  const auto n = static_cast<double>(points_m.size());
  LocalPlane plane;
  for (const Vector3d& p : points_m) plane.centre += p / n;
  Matrix3d covariance = Matrix3d::Zero();
  for (const Vector3d& p : points_m) covariance += (p - plane.centre) * (p - plane.centre).transpose() / n;
  // The closed form (computeDirect) loses half the digits where two eigenvalues are close; this does not.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  const double thin = std::sqrt(std::max(0.0, eigen.eigenvalues()[0])), wide = std::sqrt(eigen.eigenvalues()[1]);
  if (thin > max_thickness_m || 3 * thin > wide || !(wide > 0)) return std::nullopt;
  plane.normal = eigen.eigenvectors().col(0);
  plane.thickness_m = thin;
  return plane;
}

}  // namespace tarmac::estimators
