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
    auto column = H.col(c).segment(c, n - c);
    for (Index r = 0; r < rows; ++r) column += B(c, r) * A.col(r).tail(n - c);
  }
}

/// The same for six columns, by tiles of 4x4 that stay in registers. Rows come in fours: beyond A's last they are zero,
/// and H has room for them.
constexpr Index kTile = 4;
using SixColumns = Eigen::Matrix<double, core::StateJet::kMaxColumns, 6>;
static_assert(core::StateJet::kMaxColumns % kTile == 0);
Index padded(Index n) {
  return (n + kTile - 1) / kTile * kTile;
}
void add_lower_six(const SixColumns& A, const SixColumns& B, Index rows, Eigen::MatrixXd& H) {
  for (Index c = 0; c < rows; c += kTile) {
    for (Index r = c; r < rows; r += kTile) {
      Eigen::Matrix<double, kTile, kTile> tile = A.block<kTile, 1>(r, 0) * B.block<kTile, 1>(c, 0).transpose();
      for (Index k = 1; k < 6; ++k) tile += A.block<kTile, 1>(r, k) * B.block<kTile, 1>(c, k).transpose();
      H.block<kTile, kTile>(r, c) += tile;
    }
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
  fresh.H.setZero(padded(n), padded(n));
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
  const Index n = J.cols(), rows = padded(n);
  Part& sum = part(first, static_cast<int>(n), nullptr);
  SixColumns A, HA;
  for (Index c = 0; c < n; ++c) A.row(c) = J.col(c).head<6>().transpose();
  for (Index c = n; c < rows; ++c) A.row(c).setZero();
  for (Index r = 0; r < rows; r += kTile) {
    for (Index c = 0; c < 6; ++c) {
      Eigen::Matrix<double, kTile, 1> four = A.block<kTile, 1>(r, 0) * H(0, c);
      for (Index k = 1; k < 6; ++k) four += A.block<kTile, 1>(r, k) * H(k, c);
      HA.block<kTile, 1>(r, c) = four;
    }
  }
  add_lower_six(A, HA, rows, sum.H);
  sum.g.noalias() += A.topRows(n) * g;
}

void LocalSum::add_to(BandedSystem& system) const {
  for (const Part& part : parts_) system.add(part.first, part.count, part.columns, part.H, part.g);
}

}  // namespace tarmac::estimators
