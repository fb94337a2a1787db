#include "estimators/window/banded_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "estimators/window/banded_factor.h"

namespace tarmac::estimators {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

BandedSystem::BandedSystem(int band, int half_bandwidth, int border)
    : band_(band),
      half_(std::max(0, std::min(half_bandwidth, band - 1))),
      border_(border),
      panels_(static_cast<std::size_t>(panels()) * static_cast<std::size_t>(panel_rows() * kPanel), 0.0),
      E_(MatrixXd::Zero(band, border)),
      C_(MatrixXd::Zero(border, border)),
      g_(VectorXd::Zero(band + border)) {}

void BandedSystem::set_zero() {
  std::fill(panels_.begin(), panels_.end(), 0.0);
  E_.setZero();
  C_.setZero();
  g_.setZero();
}

double* BandedSystem::column(int j) {
  const int k = j / kPanel, c = j % kPanel;
  return panels_.data() +
         (static_cast<std::size_t>(k) * kPanel + static_cast<std::size_t>(c)) * static_cast<std::size_t>(panel_rows()) +
         c;
}

const double* BandedSystem::column(int j) const {
  return const_cast<BandedSystem*>(this)->column(j);
}

void BandedSystem::add(int first, const Eigen::Ref<const MatrixXd>& J, std::span<const BorderJacobian> border,
                       const Eigen::Ref<const MatrixXd>& H_local, const Eigen::Ref<const VectorXd>& g_local) {
  const Index count = J.cols();
  Index all = count;
  for (const BorderJacobian& part : border) all += part.J.cols();
  MatrixXd whole(J.rows(), all);
  whole.leftCols(count) = J;
  std::vector<int> columns;
  Index at = count;
  for (const BorderJacobian& part : border) {
    whole.middleCols(at, part.J.cols()) = part.J;
    at += part.J.cols();
    for (int c = 0; c < part.J.cols(); ++c) columns.push_back(part.column + c);
  }
  const MatrixXd H = whole.transpose() * (H_local * whole);
  const VectorXd g = whole.transpose() * g_local;
  add(first, static_cast<int>(count), columns, H, g);
}

void BandedSystem::add(int first, int count, std::span<const int> columns, const Eigen::Ref<const MatrixXd>& H,
                       const Eigen::Ref<const VectorXd>& g) {
  if (first < 0 || count > half_ + 1 || first + count > band_)
    throw std::invalid_argument(fmt::format("scalars {} to {} do not fit a band of {} with half bandwidth {}", first,
                                            first + count, band_, half_));
  for (int c = 0; c < count; ++c) {
    Eigen::Map<VectorXd>(column(first + c), count - c) += H.col(c).segment(c, count - c);
  }
  g_.segment(first, count) += g.head(count);
  const auto borders = static_cast<int>(columns.size());
  for (int b = 0; b < borders; ++b) {
    const int to = columns[static_cast<std::size_t>(b)];
    if (to < 0 || to >= border_)
      throw std::invalid_argument(fmt::format("no column {} in a border of {}", to, border_));
    E_.col(to).segment(first, count) += H.row(count + b).head(count).transpose();
    g_[band_ + to] += g[count + b];
    for (int a = 0; a <= b; ++a) {
      const int other = columns[static_cast<std::size_t>(a)];
      C_(std::max(to, other), std::min(to, other)) += H(count + b, count + a);
    }
  }
}

void BandedSystem::add(const BandedSystem& other) {
  if (other.band_ != band_ || other.half_ != half_ || other.border_ != border_)
    throw std::invalid_argument("systems of different shapes do not add");
  for (std::size_t i = 0; i < panels_.size(); ++i) panels_[i] += other.panels_[i];
  E_ += other.E_;
  C_ += other.C_;
  g_ += other.g_;
}

void BandedSystem::add_to_diagonal(int scalar, double value) {
  (scalar < band_ ? *column(scalar) : C_(scalar - band_, scalar - band_)) += value;
}

double BandedSystem::diagonal(int scalar) const {
  return scalar < band_ ? *column(scalar) : C_(scalar - band_, scalar - band_);
}

double BandedSystem::quadratic(const Eigen::Ref<const VectorXd>& x) const {
  double sum = 0;
  for (int j = 0; j < band_; ++j) {
    const double* entries = column(j);
    sum += entries[0] * x[j] * x[j];
    const int n = std::min(half_, band_ - 1 - j);
    if (n > 0) sum += 2 * x[j] * Eigen::Map<const VectorXd>(entries + 1, n).dot(x.segment(j + 1, n));
  }
  if (border_ == 0) return sum;
  const auto xb = x.tail(border_);
  return sum + 2 * x.head(band_).dot(E_ * xb) + xb.dot(C_.selfadjointView<Eigen::Lower>() * xb);
}

bool BandedSystem::solve(double lambda, bool identity, VectorXd& step) const {
  const BandedFactor factor(*this, lambda, identity);
  if (!factor.ok()) return false;
  MatrixXd x = -g_;
  factor.solve(x);
  if (!x.allFinite()) return false;
  step = x.col(0);
  return true;
}

bool BandedSystem::solve(double lambda, VectorXd& step) const {
  return solve(lambda, false, step);
}

bool BandedSystem::solve_with_identity(double lambda, VectorXd& step) const {
  return solve(lambda, true, step);
}

MatrixXd BandedSystem::covariance(int first, int count) const {
  const BandedFactor factor(*this, 0, false);
  if (!factor.ok()) return {};
  MatrixXd x = MatrixXd::Zero(size(), count);
  x.middleRows(first, count).setIdentity();
  factor.solve(x);
  const MatrixXd rows = x.middleRows(first, count);
  return (rows + rows.transpose()) / 2;
}

MatrixXd BandedSystem::covariance_with_border(int first, int count) const {
  const BandedFactor factor(*this, 0, false);
  if (!factor.ok()) return {};
  MatrixXd x = MatrixXd::Zero(size(), count + border_);
  x.block(first, 0, count, count).setIdentity();
  x.block(band_, count, border_, border_).setIdentity();
  factor.solve(x);
  MatrixXd rows(count + border_, count + border_);
  rows << x.middleRows(first, count), x.bottomRows(border_);
  return (rows + rows.transpose()) / 2;
}

std::vector<MatrixXd> BandedSystem::covariance_runs(int block, int run) const {
  if (block <= 0 || run <= 0 || run > half_ + 1)
    throw std::invalid_argument(fmt::format("a run of {} does not fit half bandwidth {}", run, half_));
  const BandedFactor factor(*this, 0, false);
  return factor.ok() ? factor.runs(block, run) : std::vector<MatrixXd>();
}

MatrixXd BandedSystem::dense() const {
  MatrixXd H = MatrixXd::Zero(size(), size());
  for (int j = 0; j < band_; ++j) {
    const int n = std::min(half_ + 1, band_ - j);
    H.col(j).segment(j, n) = Eigen::Map<const VectorXd>(column(j), n);
  }
  H.bottomLeftCorner(border_, band_) = E_.transpose();
  H.bottomRightCorner(border_, border_) = C_;
  return H.selfadjointView<Eigen::Lower>();
}

std::size_t BandedSystem::stored() const {
  return panels_.size() + static_cast<std::size_t>(E_.size() + C_.size() + g_.size());
}

double BandedSystem::factor_operations() const {
  return BandedFactor(*this, 0, false).operations();
}

}  // namespace tarmac::estimators
