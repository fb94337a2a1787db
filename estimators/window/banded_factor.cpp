#include "estimators/window/banded_factor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tarmac::estimators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Of a matrix of unit diagonal: a pivot is what one unknown's information has left once those before it are free.
/// Below this it is rounding.
constexpr double kSmallestPivot = 1e-14;

/// In-place lower Cholesky; false where a pivot is too small or not a number.
template <class Block>
bool cholesky(Block&& A) {
  const Index n = A.cols();
  for (Index j = 0; j < n; ++j) {
    const double pivot = A(j, j) - A.row(j).head(j).squaredNorm();
    if (!(pivot > kSmallestPivot)) return false;
    const double root = std::sqrt(pivot);
    A(j, j) = root;
    const Index below = n - j - 1;
    if (below == 0) break;
    if (j > 0) A.col(j).tail(below).noalias() -= A.bottomLeftCorner(below, j) * A.row(j).head(j).transpose();
    A.col(j).tail(below) /= root;
  }
  return true;
}

double damped(double diagonal, double lambda, bool identity) {
  return identity ? diagonal + lambda : diagonal * (1 + lambda);
}

}  // namespace

BandedFactor::BandedFactor(const BandedSystem& system, double lambda, bool identity)
    : band_(system.band_),
      half_(system.half_),
      border_(system.border_),
      panels_(system.panels()),
      rows_(system.panel_rows()),
      scale_(system.size()),
      L_(system.panels_) {
  for (int i = 0; i < system.size(); ++i) {
    const double d = damped(system.diagonal(i), lambda, identity);
    if (!(d > 0) || !std::isfinite(d)) return;
    scale_[i] = 1 / std::sqrt(d);
  }
  scale(system, lambda, identity);
  ok_ = factor_band() && factor_border(system, lambda, identity);
}

void BandedFactor::scale(const BandedSystem& system, double lambda, bool identity) {
  for (int k = 0; k < panels_; ++k) {
    Panel P = panel(k);
    for (int c = 0; c < kPanel; ++c) {
      const int j = kPanel * k + c;
      if (j >= band_) {  // padding: the identity, tied to nothing
        P.col(c).setZero();
        P(c, c) = 1;
        continue;
      }
      const int n = std::min(half_ + 1, band_ - j);
      P.col(c).segment(c, n).array() *= scale_[j] * scale_.segment(j, n).array();
      P(c, c) = damped(system.diagonal(j), lambda, identity) * scale_[j] * scale_[j];
    }
  }
}

bool BandedFactor::factor_band() {
  for (int k = 0; k < panels_; ++k) {
    Panel P = panel(k);
    auto top = P.topRows<kPanel>();
    if (!cholesky(top)) return false;
    top.triangularView<Eigen::StrictlyUpper>().setZero();
    const int below = rows_of(k) - kPanel;
    operations_ += kPanel * kPanel * (kPanel / 3.0 + std::max(0, below));
    if (below <= 0) continue;
    auto R = P.middleRows(kPanel, below);
    top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(R);
    for (int done = 0, next = k + 1; done < below; done += kPanel, ++next) {
      const int n = below - done, width = std::min(kPanel, n);
      operations_ += 1.0 * n * width * kPanel;
      panel(next).topLeftCorner(n, width).noalias() -= R.bottomRows(n) * R.middleRows(done, width).transpose();
    }
  }
  return true;
}

bool BandedFactor::factor_border(const BandedSystem& system, double lambda, bool identity) {
  if (border_ == 0) return true;
  W_ = MatrixXd::Zero(kPanel * panels_, border_);
  W_.topRows(band_) = scale_.head(band_).asDiagonal() * system.E_ * scale_.tail(border_).asDiagonal();
  forward(W_);
  for (int k = 0; k < panels_; ++k) operations_ += 1.0 * kPanel * border_ * (rows_of(k) - kPanel / 2);
  M_ = scale_.tail(border_).asDiagonal() * system.C_ * scale_.tail(border_).asDiagonal();
  for (int i = 0; i < border_; ++i) {
    const double s = scale_[band_ + i];
    M_(i, i) = damped(system.C_(i, i), lambda, identity) * s * s;
  }
  operations_ += border_ * border_ * (W_.rows() / 2.0 + border_ / 3.0);
  M_.selfadjointView<Eigen::Lower>().rankUpdate(W_.transpose(), -1.0);
  if (!cholesky(M_)) return false;
  M_.triangularView<Eigen::StrictlyUpper>().setZero();
  return true;
}

void BandedFactor::forward(Eigen::Ref<MatrixXd> x) const {
  for (int k = 0; k < panels_; ++k) {
    const ConstPanel P = panel(k);
    auto xk = x.middleRows(kPanel * k, kPanel);
    P.topRows<kPanel>().triangularView<Eigen::Lower>().solveInPlace(xk);
    const int below = rows_of(k) - kPanel;
    if (below > 0) x.middleRows(kPanel * (k + 1), below).noalias() -= P.middleRows(kPanel, below) * xk;
  }
}

void BandedFactor::backward(Eigen::Ref<MatrixXd> x) const {
  for (int k = panels_ - 1; k >= 0; --k) {
    const ConstPanel P = panel(k);
    auto xk = x.middleRows(kPanel * k, kPanel);
    const int below = rows_of(k) - kPanel;
    if (below > 0) xk.noalias() -= P.middleRows(kPanel, below).transpose() * x.middleRows(kPanel * (k + 1), below);
    P.topRows<kPanel>().triangularView<Eigen::Lower>().transpose().solveInPlace(xk);
  }
}

void BandedFactor::solve(Eigen::Ref<MatrixXd> x) const {
  MatrixXd y = MatrixXd::Zero(kPanel * panels_, x.cols());
  y.topRows(band_) = scale_.head(band_).asDiagonal() * x.topRows(band_);
  forward(y);
  if (border_ > 0) {
    MatrixXd z = scale_.tail(border_).asDiagonal() * x.bottomRows(border_);
    z.noalias() -= W_.transpose() * y;
    M_.triangularView<Eigen::Lower>().solveInPlace(z);
    M_.triangularView<Eigen::Lower>().transpose().solveInPlace(z);
    y.noalias() -= W_ * z;
    x.bottomRows(border_) = scale_.tail(border_).asDiagonal() * z;
  }
  backward(y);
  x.topRows(band_) = scale_.head(band_).asDiagonal() * y.topRows(band_);
}

/// Z = (L L^T)^-1 within the band, from the last panel up: with J a panel's columns and R the rows below it,
///   Z_RJ = -Z_RR L_RJ L_JJ^-1      Z_JJ = L_JJ^-T (L_JJ^-1 - L_RJ^T Z_RJ)
/// The border adds V S^-1 V^T with V = B^-1 E = L^-T W, S = M M^T.
/// Source: Takahashi, Fagan, Chin 1973; Erisman and Tinney, CACM 18(3) 1975.
std::vector<MatrixXd> BandedFactor::runs(int block, int run) const {
  std::vector<double> inverse(L_.size(), 0.0);
  const auto at = [&](int k) { return Panel(inverse.data() + panel_offset(k), rows_, kPanel); };
  // A square of Z's rows and columns from `first` on, taken from the panels.
  const auto square = [&](int first, int n, MatrixXd& Z) {
    Z.resize(n, n);
    for (int j = 0; j < n; ++j) {
      const int k = (first + j) / kPanel, c = (first + j) % kPanel;
      Z.col(j).tail(n - j) = at(k).col(c).segment(c, n - j);
      Z.row(j).tail(n - j) = Z.col(j).tail(n - j).transpose();
    }
  };
  MatrixXd Z_RR;
  for (int k = panels_ - 1; k >= 0; --k) {
    const ConstPanel P = panel(k);
    const auto L_JJ = P.topRows<kPanel>().triangularView<Eigen::Lower>();
    Eigen::Matrix<double, kPanel, kPanel> L_inverse = Eigen::Matrix<double, kPanel, kPanel>::Identity();
    L_JJ.solveInPlace(L_inverse);
    Eigen::Matrix<double, kPanel, kPanel> Z_JJ = L_inverse;
    const int below = rows_of(k) - kPanel;
    if (below > 0) {
      square(kPanel * (k + 1), below, Z_RR);
      const auto L_RJ = P.middleRows(kPanel, below);
      const MatrixXd Z_RJ = -(Z_RR * (L_RJ * L_inverse));
      Z_JJ -= L_RJ.transpose() * Z_RJ;
      at(k).middleRows(kPanel, below) = Z_RJ;
    }
    at(k).topRows<kPanel>() = L_inverse.transpose() * Z_JJ;
  }
  MatrixXd V;
  if (border_ > 0) {
    V = W_;
    backward(V);
    M_.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(V);
  }
  std::vector<MatrixXd> result;
  for (int first = 0; first + run <= band_; first += block) {
    MatrixXd& Z = result.emplace_back();
    square(first, run, Z);
    if (border_ > 0) Z.noalias() += V.middleRows(first, run) * V.middleRows(first, run).transpose();
    const auto D = scale_.segment(first, run).asDiagonal();
    Z = (D * Z * D).eval();
  }
  return result;
}

}  // namespace tarmac::estimators
