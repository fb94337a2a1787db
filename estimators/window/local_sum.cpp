#include "estimators/window/local_sum.h"

#include <cmath>

namespace tarmac::estimators {
namespace {

using Eigen::Index;

constexpr int kMaxWidth = core::StateJet::kMaxColumns + 6 * Term::kMaxBorders;
/// Transposed Jacobians: a column a row of the residual, so that the sums below run down columns.
using Transposed = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxWidth, Term::kMaxRows>;

/// H += A B^T, lower triangle.
template <class Left, class Right>
void add_lower(const Left& A, const Right& B, Eigen::MatrixXd& H) {
  const Index n = A.rows(), rows = A.cols();
  for (Index c = 0; c < n; ++c) {
    auto column = H.col(c).tail(n - c);
    for (Index r = 0; r < rows; ++r) column += B(c, r) * A.col(r).tail(n - c);
  }
}

/// The same for six columns of A at once: a column of H is loaded and stored once, not six times.
template <class Columns>
void add_lower_six(const Columns& A, const Columns& B, Eigen::MatrixXd& H) {
  const Index n = A.rows();
  for (Index c = 0; c < n; ++c) {
    const Index m = n - c;
    H.col(c).tail(m) += B(c, 0) * A.col(0).tail(m) + B(c, 1) * A.col(1).tail(m) + B(c, 2) * A.col(2).tail(m) +
                        B(c, 3) * A.col(3).tail(m) + B(c, 4) * A.col(4).tail(m) + B(c, 5) * A.col(5).tail(m);
  }
}

bool same_columns(const std::vector<int>& columns, const Term& term) {
  std::size_t at = 0;
  for (int b = 0; b < term.borders; ++b) {
    const Term::Border& border = term.border[static_cast<std::size_t>(b)];
    for (int c = 0; c < border.J.cols(); ++c, ++at) {
      if (at >= columns.size() || columns[at] != border.column + c) return false;
    }
  }
  return at == columns.size();
}

}  // namespace

void LocalSum::clear() {
  parts_.clear();
  cost = 0;
}

/// Gyro and accelerometer of one reading alternate, so that the last two parts are looked at.
LocalSum::Part& LocalSum::part(int first, int count, const Term* term) {
  for (std::size_t back = 1; back <= 2 && back <= parts_.size(); ++back) {
    Part& last = parts_[parts_.size() - back];
    if (last.first != first || last.count != count) continue;
    if (term == nullptr ? last.columns.empty() : same_columns(last.columns, *term)) return last;
  }
  Part& fresh = parts_.emplace_back();
  fresh.first = first;
  fresh.count = count;
  for (int b = 0; term != nullptr && b < term->borders; ++b) {
    const Term::Border& border = term->border[static_cast<std::size_t>(b)];
    for (int c = 0; c < border.J.cols(); ++c) fresh.columns.push_back(border.column + c);
  }
  const Index n = count + static_cast<Index>(fresh.columns.size());
  fresh.H.setZero(n, n);
  fresh.g.setZero(n);
  return fresh;
}

void LocalSum::add(const Term& term) {
  const RobustLoss::Value rho = term.rho();
  cost += rho.rho / 2;
  if (rho.first == 0) return;
  const auto count = static_cast<int>(term.J.cols());
  Part& sum = part(term.first, count, &term);
  Transposed A(sum.g.size(), term.e.size());
  A.topRows(count) = term.J.transpose();
  Index at = count;
  for (int b = 0; b < term.borders; ++b) {
    const auto& J = term.border[static_cast<std::size_t>(b)].J;
    A.middleRows(at, J.cols()) = J.transpose();
    at += J.cols();
  }
  A *= std::sqrt(rho.first);
  add_lower(A, A, sum.H);
  sum.g.noalias() += A * (std::sqrt(rho.first) * term.e);
}

void LocalSum::add_pose(int first, const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& J,
                        const core::Matrix6& H, const core::Vector6& g) {
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, core::StateJet::kMaxColumns, 6>;
  Part& sum = part(first, static_cast<int>(J.cols()), nullptr);
  const Columns A = J.transpose();
  const Columns HA = A * H;
  add_lower_six(A, HA, sum.H);
  sum.g.noalias() += A * g;
}

void LocalSum::add_to(BandedSystem& system) const {
  for (const Part& part : parts_) system.add(part.first, part.count, part.columns, part.H, part.g);
}

}  // namespace tarmac::estimators
