#include "estimators/blocks/plane_fit.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tarmac::estimators {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Roots of det(A - l I) in ascending order, A having trace 3m: l = m + 2p cos(.), p^2 = |A - m I|^2 / 6.
Vector3d roots(const Matrix3d& A) {
  constexpr double kThirdOfTurn = 2.0943951023931954923;
  const double m = A.trace() / 3;
  const Matrix3d B = A - m * Matrix3d::Identity();
  const double p2 = B.squaredNorm() / 6;
  if (!(p2 > 0)) return Vector3d::Constant(m);
  const double p = std::sqrt(p2);
  const double r = std::clamp(B.determinant() / (2 * p2 * p), -1.0, 1.0);
  const double phi = std::acos(r) / 3;
  const double largest = m + 2 * p * std::cos(phi), smallest = m + 2 * p * std::cos(phi + kThirdOfTurn);
  return {smallest, 3 * m - largest - smallest, largest};
}

/// A unit vector that the (nearly) singular matrix sends to zero: normal to its rows.
Vector3d null_vector(const Matrix3d& M) {
  const Vector3d a = M.row(0).cross(M.row(1)), b = M.row(0).cross(M.row(2)), c = M.row(1).cross(M.row(2));
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
  const Vector3d v = aa >= bb && aa >= cc ? a : (bb >= cc ? b : c);
  const double norm = v.norm();
  if (norm > 1e-12 * M.squaredNorm()) return v / norm;
  // Rank one or none: any vector normal to the longest row will do.
  int longest = 0;
  M.rowwise().squaredNorm().maxCoeff(&longest);
  const Vector3d row = M.row(longest);
  if (!(row.squaredNorm() > 0)) return Vector3d::UnitZ();
  int smallest = 0;
  row.cwiseAbs().minCoeff(&smallest);
  return row.cross(Vector3d::Unit(smallest)).normalized();
}

}  // namespace

SmallestEigen smallest_eigen(const Matrix3d& symmetric) {
  SmallestEigen result;
  const double scale = symmetric.cwiseAbs().maxCoeff();
  if (!(scale > 0)) return result;
  const Matrix3d A = symmetric / scale;
  Vector3d l = roots(A);
  const Vector3d v = null_vector(A - l[0] * Matrix3d::Identity());
  // The Rayleigh quotient is good to the square of the vector's error, where the root had lost half of the digits.
  l[0] = v.dot(A * v);
  l[1] = std::max(l[1], l[0]);
  result.values = scale * l;
  result.vector = v;
  return result;
}

PlaneFit fit_plane(const NearestPoints& points) {
  PlaneFit fit;
  if (points.count < 3) return fit;
  Vector3d sum = Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(points.count); ++k) {
    const double x = points.x_m[k], y = points.y_m[k], z = points.z_m[k];
    sum += Vector3d(x, y, z);
    xx += x * x, xy += x * y, xz += x * z, yy += y * y, yz += y * z, zz += z * z;
  }
  const double n = points.count;
  fit.mean_m = sum / n;
  const Vector3d& m = fit.mean_m;
  Matrix3d C;
  C << xx / n - m.x() * m.x(), xy / n - m.x() * m.y(), xz / n - m.x() * m.z(),  //
      xy / n - m.x() * m.y(), yy / n - m.y() * m.y(), yz / n - m.y() * m.z(),   //
      xz / n - m.x() * m.z(), yz / n - m.y() * m.z(), zz / n - m.z() * m.z();
  const SmallestEigen eigen = smallest_eigen(C);
  fit.normal = eigen.vector;
  const Vector3d s = eigen.values.cwiseMax(0).cwiseSqrt();
  if (s[2] > 0) fit.planarity = std::clamp((s[1] - s[0]) / s[2], 0.0, 1.0);
  return fit;
}

}  // namespace tarmac::estimators
