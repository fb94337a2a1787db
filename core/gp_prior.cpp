#include "core/gp_prior.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "core/error.h"

namespace tarmac::core {
namespace {

/// With g(s) = Phi(s) L for a unit step and y = a d, g_i(s) = sum over n of (-y)^n s^(n+p) / (n+p)!, p = 2, 1, 0, and
/// Q is the integral of g g^T over [0, 1]. Entries of Q fall below their leading term by cancellation for small y: the
/// closed forms lose 1e-11 at y = 0.2 and 3e-15 at y = 1 (measured against long double), so that the series holds up
/// to there; its terms fall like 2^n/n!, the 24th is below 1e-17 of the first.
constexpr double kSeriesBelow = 1.0;
constexpr int kTerms = 24;
using Series = std::array<double, kTerms>;

constexpr std::array<long double, 64> reciprocal_factorials() {
  std::array<long double, 64> r{1};
  for (std::size_t n = 1; n < r.size(); ++n) r[n] = r[n - 1] / static_cast<long double>(n);
  return r;
}

/// Of (-y)^n in g_p(1).
constexpr Series g_series(std::size_t p) {
  constexpr auto r = reciprocal_factorials();
  Series c{};
  for (std::size_t n = 0; n < kTerms; ++n) c[n] = static_cast<double>(n % 2 == 0 ? r[n + p] : -r[n + p]);
  return c;
}

/// Of (-y)^n in the integral of g_p g_q.
constexpr Series q_series(std::size_t p, std::size_t q) {
  constexpr auto r = reciprocal_factorials();
  Series c{};
  for (std::size_t n = 0; n < kTerms; ++n) {
    long double sum = 0;
    for (std::size_t m = 0; m <= n; ++m) sum += r[m + p] * r[n - m + q];
    sum /= static_cast<long double>(n + p + q + 1);
    c[n] = static_cast<double>(n % 2 == 0 ? sum : -sum);
  }
  return c;
}

double horner(const Series& c, double y) {
  double sum = c[kTerms - 1];
  for (std::size_t k = kTerms - 1; k-- > 0;) sum = c[k] + y * sum;
  return sum;
}

/// g at s = 1: position, velocity and acceleration that a unit acceleration leaves after a unit of time.
struct Decay {
  double p, v, a;
};
Decay decay(double y) {
  if (y < kSeriesBelow) {
    static constexpr Series kp = g_series(2);
    const double p = horner(kp, y), v = 1 - y * p;
    return {p, v, 1 - y * v};
  }
  const double v = -std::expm1(-y) / y;
  return {(1 - v) / y, v, std::exp(-y)};
}

/// Q of a unit of time.
struct UnitNoise {
  double pp, pv, pa, vv, va, aa;
};

UnitNoise unit_noise(double y) {
  const double aa = y > 0 ? -std::expm1(-2 * y) / (2 * y) : 1;
  if (y < kSeriesBelow) {
    static constexpr Series kpp = q_series(2, 2), kpv = q_series(2, 1), kpa = q_series(2, 0), kvv = q_series(1, 1),
                            kva = q_series(1, 0);
    return {horner(kpp, y), horner(kpv, y), horner(kpa, y), horner(kvv, y), horner(kva, y), aa};
  }
  const double e = std::exp(-y), e2 = e * e, y2 = y * y, y3 = y2 * y;
  return {(1 - e2 + 2 * y + 2 * y3 / 3 - 2 * y2 - 4 * y * e) / (2 * y3 * y2),
          (e2 + 1 - 2 * e + 2 * y * e - 2 * y + y2) / (2 * y2 * y2),
          (1 - e2 - 2 * y * e) / (2 * y3),
          (4 * e - 3 - e2 + 2 * y) / (2 * y3),
          (e2 + 1 - 2 * e) / (2 * y2),
          aa};
}

GpBlock unit_noise_matrix(GpModel model, double y) {
  GpBlock Q(gp_order(model), gp_order(model));
  if (model == GpModel::wnoa) {
    Q << 1. / 3, 1. / 2, 1. / 2, 1;
  } else if (model == GpModel::wnoj) {
    Q << 1. / 20, 1. / 8, 1. / 6, 1. / 8, 1. / 3, 1. / 2, 1. / 6, 1. / 2, 1;
  } else {
    const UnitNoise q = unit_noise(y);
    Q << q.pp, q.pv, q.pa, q.pv, q.vv, q.va, q.pa, q.va, q.aa;
  }
  return Q;
}

GpBlock unit_noise_inverse(GpModel model, double y) {
  GpBlock I(gp_order(model), gp_order(model));
  if (model == GpModel::wnoa) {
    I << 12, -6, -6, 4;
  } else if (model == GpModel::wnoj) {
    I << 720, -360, 60, -360, 192, -36, 60, -36, 9;
  } else {
    // The correlations' matrix is as well conditioned for large y as for small.
    const Eigen::Matrix3d Q = unit_noise_matrix(model, y);
    const Eigen::Vector3d scale = Q.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d inverse = (scale.asDiagonal() * Q * scale.asDiagonal()).eval().inverse();
    I = scale.asDiagonal() * inverse * scale.asDiagonal();
    I = (0.5 * (I + I.transpose())).eval();
  }
  return I;
}

/// Q(d)_ij = d^(2n - 1 - i - j) Q(1)_ij, n = 2 or 3 entries; its inverse by 1/d.
void scale_noise(GpBlock& Q, double d) {
  const Eigen::Index n = Q.rows();
  std::array<double, 6> power{1};
  for (std::size_t k = 1; k < 6; ++k) power[k] = power[k - 1] * d;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) Q(i, j) *= power[static_cast<std::size_t>(2 * n - 1 - i - j)];
  }
}

/// A matrix of one axis, the same for all six or one each, laid out as vectors of 6.
template <class OneAxis>
Eigen::MatrixXd over_axes(int order, const OneAxis& one_axis) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(6 * order, 6 * order);
  for (int axis = 0; axis < 6; ++axis) {
    const GpBlock block = one_axis(axis);
    for (int i = 0; i < order; ++i) {
      for (int j = 0; j < order; ++j) M(6 * i + axis, 6 * j + axis) = block(i, j);
    }
  }
  return M;
}

}  // namespace

GpBlock gp_transition(GpModel model, double rate, double d) {
  if (model == GpModel::wnoa) {
    GpBlock Phi(2, 2);
    Phi << 1, d, 0, 1;
    return Phi;
  }
  const Decay g = model == GpModel::singer ? decay(rate * d) : Decay{0.5, 1, 1};
  GpBlock Phi(3, 3);
  Phi << 1, d, g.p * d * d, 0, 1, g.v * d, 0, 0, g.a;
  return Phi;
}

GpBlock gp_noise(GpModel model, double rate, double d) {
  GpBlock Q = unit_noise_matrix(model, rate * d);
  scale_noise(Q, d);
  return Q;
}

GpBlock gp_noise_inverse(GpModel model, double rate, double d) {
  GpBlock I = unit_noise_inverse(model, rate * d);
  scale_noise(I, 1 / d);
  return I;
}

void GpPrior::check() const {
  if (!qc.allFinite() || !(qc.array() > 0).all()) {
    throw InputError(
        fmt::format("a motion prior's power spectral density must be positive on all six axes; it is {}, "
                    "{}, {}, {}, {}, {}",
                    qc[0], qc[1], qc[2], qc[3], qc[4], qc[5]));
  }
  if (model == GpModel::singer && (!rate.allFinite() || !(rate.array() >= 0).all())) {
    throw InputError(fmt::format("a Singer prior's rates must be 0 or more [1/s]; they are {}, {}, {}, {}, {}, {}",
                                 rate[0], rate[1], rate[2], rate[3], rate[4], rate[5]));
  }
}

Eigen::MatrixXd GpPrior::transition(double d) const {
  return over_axes(order(), [&](int axis) { return gp_transition(model, rate[axis], d); });
}

Eigen::MatrixXd GpPrior::noise(double d) const {
  return over_axes(order(), [&](int axis) -> GpBlock { return qc[axis] * gp_noise(model, rate[axis], d); });
}

Eigen::MatrixXd GpPrior::information(double d) const {
  return over_axes(order(), [&](int axis) -> GpBlock { return gp_noise_inverse(model, rate[axis], d) / qc[axis]; });
}

GpAxis::GpAxis(GpModel model, double rate, double T) : model_(model), rate_(rate), T_(T) {
  if (model != GpModel::singer) return;
  transition_ = gp_transition(model, rate, T);
  noise_inverse_ = gp_noise_inverse(model, rate, T);
}

namespace {

/// Hermite's cubic in r = d/T and its derivatives.
void cubic_weights(double r, double T, GpWeights& w) {
  const double r2 = r * r, r3 = r2 * r;
  w.Psi = {{{3 * r2 - 2 * r3, T * (r3 - r2), 0},
            {6 * (r - r2) / T, 3 * r2 - 2 * r, 0},
            {6 * (1 - 2 * r) / (T * T), (6 * r - 2) / T, 0},
            {-12 / (T * T * T), 6 / (T * T), 0}}};
  for (std::size_t i = 0; i < 4; ++i) w.Lambda[i][0] = (i == 0 ? 1 : 0) - w.Psi[i][0];
  w.Lambda[0][1] = T * (r - 2 * r2 + r3);
  w.Lambda[1][1] = 1 - 4 * r + 3 * r2;
  w.Lambda[2][1] = (6 * r - 4) / T;
  w.Lambda[3][1] = 6 / (T * T);
}

/// Derivatives 0 to 3 of sum c_k r^k by d, times `scale`, into column `column`.
void polynomial_column(const std::array<double, 6>& c, double r, double T, double scale, std::size_t column,
                       std::array<std::array<double, 3>, 4>& rows) {
  double p = 0, p1 = 0, p2 = 0, p3 = 0;  // p2, p3 without their factorials
  for (std::size_t k = 6; k-- > 0;) {
    p3 = p3 * r + p2;
    p2 = p2 * r + p1;
    p1 = p1 * r + p;
    p = p * r + c[k];
  }
  rows[0][column] = scale * p;
  rows[1][column] = scale * p1 / T;
  rows[2][column] = scale * 2 * p2 / (T * T);
  rows[3][column] = scale * 6 * p3 / (T * T * T);
}

/// Hermite's quintic.
void quintic_weights(double r, double T, GpWeights& w) {
  polynomial_column({0, 0, 0, 10, -15, 6}, r, T, 1, 0, w.Psi);
  polynomial_column({0, 0, 0, -4, 7, -3}, r, T, T, 1, w.Psi);
  polynomial_column({0, 0, 0, 0.5, -1, 0.5}, r, T, T * T, 2, w.Psi);
  polynomial_column({1, 0, 0, -10, 15, -6}, r, T, 1, 0, w.Lambda);
  polynomial_column({0, 1, 0, -6, 8, -3}, r, T, T, 1, w.Lambda);
  polynomial_column({0, 0, 0.5, -1.5, 1.5, -0.5}, r, T, T * T, 2, w.Lambda);
}

}  // namespace

GpWeights GpAxis::weights(double d) const {
  GpWeights w;
  if (model_ == GpModel::wnoa) {
    cubic_weights(d / T_, T_, w);
    return w;
  }
  if (model_ == GpModel::wnoj) {
    quintic_weights(d / T_, T_, w);
    return w;
  }
  // Psi = Q(d) Phi(T - d)^T Q(T)^-1 and Lambda = Phi(d) - Psi Phi(T); the derivative of the last row follows from
  // gamma' = A gamma + L L^T Phi(T - d)^T Q(T)^-1 (gamma_2 - Phi(T) gamma_1).
  const Eigen::Matrix3d rest = gp_transition(model_, rate_, T_ - d);
  Eigen::Matrix<double, 4, 3> Psi, Lambda;
  const Eigen::Matrix3d back = rest.transpose() * noise_inverse_;
  Psi.topRows<3>() = gp_noise(model_, rate_, d) * back;
  Lambda.topRows<3>() = gp_transition(model_, rate_, d) - Psi.topRows<3>() * transition_;
  Psi.row(3) = -rate_ * Psi.row(2) + back.row(2);
  Lambda.row(3) = -rate_ * Lambda.row(2) - back.row(2) * transition_;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      w.Psi[i][j] = Psi(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      w.Lambda[i][j] = Lambda(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  return w;
}

GpBlock GpAxis::conditional_noise(double d) const {
  const GpBlock rest = gp_transition(model_, rate_, T_ - d);
  const GpBlock information =
      gp_noise_inverse(model_, rate_, d) + rest.transpose() * gp_noise_inverse(model_, rate_, T_ - d) * rest;
  // Scaled to a unit diagonal before it is inverted: entries span the fifth power of d.
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const GpBlock unit = scale.asDiagonal() * information * scale.asDiagonal();
  return scale.asDiagonal() * unit.inverse() * scale.asDiagonal();
}

namespace {

/// Up to here t4 and t5 by series in z^2 <= 1; above, their closed forms lose a digit and a half at most.
constexpr double kCurveSeriesBelow = 2.0;

/// sum over k of x^k / (2k + n)!: t_n(z) = z^n tail(n, z^2), nine terms for x <= 1.
template <std::size_t n>
double tail(double x) {
  static constexpr auto r = reciprocal_factorials();
  static constexpr std::array<double, 9> c = [] {
    std::array<double, 9> out{};
    for (std::size_t k = 0; k < 9; ++k) out[k] = static_cast<double>(r[2 * k + n]);
    return out;
  }();
  double sum = c[8];
  for (std::size_t k = 8; k-- > 0;) sum = c[k] + x * sum;
  return sum;
}

/// t2 to t5 times exp(-y/2), at z = y/2: cosh and sinh less the first terms of their series.
std::array<double, 4> scaled_tails_at_end(double y) {
  const double h = y / 2, x = h * h;
  if (y < kCurveSeriesBelow) {
    const double E = std::exp(-h);
    return {E * x * tail<2>(x), E * x * h * tail<3>(x), E * x * x * tail<4>(x), E * x * x * h * tail<5>(x)};
  }
  const double E = std::exp(-h), c = 0.5 * (1 + E * E), s = -0.5 * std::expm1(-2 * h);
  return {c - E, s - h * E, c - (1 + x / 2) * E, s - (h + x * h / 6) * E};
}

}  // namespace

SingerCurve::SingerCurve(double rate, double T) : y_(rate * T) {
  // Rows: value, first and second derivative by s at s = -1/2, then at 1/2.
  Eigen::Matrix<double, 6, 6> hermite = Eigen::Matrix<double, 6, 6>::Zero();
  for (const int end : {-1, 1}) {
    const double s = 0.5 * end;
    auto rows = hermite.middleRows<3>(end < 0 ? 0 : 3);
    rows.leftCols<4>() << 1, s, s * s, s * s * s, 0, 1, 2 * s, 3 * s * s, 0, 0, 2, 6 * s;
    double C1 = 8, C2 = 48, S1 = 10, S2 = 80;  // of (2s)^4 and (2s)^5
    if (y_ > 0) {
      const auto [t2, t3, t4, t5] = scaled_tails_at_end(y_);
      C1 = y_ * t3 / t4;
      C2 = y_ * y_ * t2 / t4;
      S1 = y_ * t4 / t5;
      S2 = y_ * y_ * t3 / t5;
    }
    rows.col(4) << 1, end * C1, C2;
    rows.col(5) << end, S1, end * S2;
  }
  // Second derivatives reach y^2: rows of one size.
  const Eigen::Matrix<double, 6, 1> scale = hermite.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
  const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * hermite;
  fit_ = scaled.fullPivLu().inverse() * scale.asDiagonal();
  if (y_ < kCurveSeriesBelow) {
    const double x = y_ * y_ / 4;
    norm_C_ = 16 / tail<4>(x);
    norm_S_ = 32 / tail<5>(x);
  } else {
    const auto [t2, t3, t4, t5] = scaled_tails_at_end(y_);
    norm_C_ = 1 / t4;
    norm_S_ = 1 / t5;
  }
}

SingerCurve::Coefficients SingerCurve::fit(const Eigen::Vector3d& at_first, const Eigen::Vector3d& at_second) const {
  Eigen::Matrix<double, 6, 1> ends;
  ends << at_first, at_second;
  Coefficients c;
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(c.data()) = fit_ * ends;
  return c;
}

void SingerCurve::basis(double s, double& C, double& S) const {
  const double z = y_ * s, x = z * z;
  if (y_ < kCurveSeriesBelow) {
    const double s2 = s * s, s4 = s2 * s2;
    if (y_ == 0) {
      C = 16 * s4;
      S = 32 * s4 * s;
      return;
    }
    C = norm_C_ * s4 * tail<4>(x);
    S = norm_S_ * s4 * s * tail<5>(x);
    return;
  }
  const double h = y_ / 2, E = std::exp(-h), up = 0.5 * std::exp(z - h), down = 0.5 * std::exp(-z - h);
  C = norm_C_ * (up + down - (1 + x / 2) * E);
  S = norm_S_ * (up - down - (z + z * x / 6) * E);
}

}  // namespace tarmac::core
