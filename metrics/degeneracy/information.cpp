#include "metrics/degeneracy/information.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/symmetric_eigen.h"

namespace tarmac::metrics {

using core::Matrix6;

namespace {

constexpr double kNullRatio = 1e-13;  // of the largest eigenvalue: what counts as free when a block is eliminated

/// The three moments with rotation in metres at the mean range, per unit of translational information.
std::array<Matrix6, 3> scaled_moments(const SweepInformation& information, double mean_range_m) {
  core::Vector6 scale = core::Vector6::Ones();
  scale.tail<3>() /= mean_range_m;
  std::array<Matrix6, 3> moments;
  for (int k = 0; k < 3; ++k)
    moments[static_cast<std::size_t>(k)] =
        scale.asDiagonal() * information.moment(k) * scale.asDiagonal() / information.translation_trace();
  return moments;
}

/// Pseudo-inverse of a positive semi-definite matrix; what is free stays free.
Matrix6 pseudo_inverse(const Matrix6& H, double largest) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(H);
  core::Vector6 inverse = core::Vector6::Zero();
  for (int i = 0; i < 6; ++i)
    if (solver.eigenvalues()[i] > kNullRatio * largest) inverse[i] = 1 / solver.eigenvalues()[i];
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

void SweepInformation::add(const core::Row6& J, double weight, double phase) {
  if (!(weight > 0) || !std::isfinite(weight) || !J.allFinite() || !std::isfinite(phase)) return;
  const Matrix6 H = weight * (J.transpose() * J);
  moments_[0] += H;
  moments_[1] += phase * H;
  moments_[2] += phase * phase * H;
  ++rows_;
}

void SweepInformation::add_block(const Matrix6& H, std::size_t rows) {
  if (!H.allFinite()) return;
  moments_[0] += H;
  rows_ += rows;
  has_phases_ = false;
}

double Spectrum::condition() const {
  const double largest = values[values.size() - 1];
  return largest / std::max(values[0], 1e-16 * largest);
}

Spectrum spectrum_of(const Eigen::MatrixXd& symmetric) {
  const core::SymmetricEigen solver(0.5 * (symmetric + symmetric.transpose()));
  return {solver.eigenvalues().cwiseMax(0.0), solver.eigenvectors()};
}

Matrix6 scaled_pose_block(const SweepInformation& information, double mean_range_m) {
  return scaled_moments(information, mean_range_m)[0];
}

Matrix12 scaled_two_pose_block(const SweepInformation& information, double mean_range_m) {
  const auto [H0, H1, H2] = scaled_moments(information, mean_range_m);
  Matrix12 H;
  H << H0 - 2 * H1 + H2, H1 - H2, H1 - H2, H2;
  return H;
}

std::optional<BlockAnalysis> analyse(const SweepInformation& information, double mean_range_m, std::size_t min_rows) {
  if (information.rows() < std::max<std::size_t>(min_rows, 6)) return std::nullopt;
  if (!(information.translation_trace() > 0) || !(mean_range_m > 0) || !std::isfinite(mean_range_m))
    return std::nullopt;
  const auto [H0, H1, H2] = scaled_moments(information, mean_range_m);
  BlockAnalysis result{spectrum_of(H0), {}, {}, {}};
  if (!information.has_phases()) return result;
  result.two_pose = spectrum_of(scaled_two_pose_block(information, mean_range_m));
  // b = m - d/2, e = m + d/2: J_m = J, J_d = (a - 1/2) J.
  const Matrix6 H_md = H1 - 0.5 * H0, H_dd = H2 - H1 + 0.25 * H0;
  const double largest = result.pose.values[5];
  result.mean = spectrum_of(H0 - H_md * pseudo_inverse(H_dd, largest) * H_md.transpose());
  result.difference = spectrum_of(H_dd - H_md.transpose() * pseudo_inverse(H0, largest) * H_md);
  return result;
}

}  // namespace tarmac::metrics
