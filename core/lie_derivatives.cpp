/// X = curly_hat(xi) obeys X^5 + 2 a^2 X^3 + a^4 X = 0, a the angle, so that every power series in X is a polynomial
/// I + s1 X + s2 X^2 + s3 X^3 + s4 X^4 with coefficients of x = a^2. For the right Jacobian, with Stumpff's functions,
///   s1 = -(sigma_2 - x sigma_2')   s2 = sigma_3 - x sigma_3'   s3 = sigma_2'   s4 = -sigma_3',
/// and for its inverse, with D(x) = (1 - h)/x and h = (a/2) cot(a/2),
///   s1 = 1/2   s2 = D - x D'   s3 = 0   s4 = -D'.
/// Source of the polynomial: Barfoot, State Estimation for Robotics (2017), 7.1.5; the coefficients by Stumpff's
/// functions and D are derived here from X^(2k+1) = (-1)^(k-1) x^(k-1) (k X^3 + (k-1) x X).
#include "core/lie_derivatives.h"

#include <array>
#include <cmath>

#include "core/stumpff.h"

namespace tarmac::core::se3 {
namespace {

/// Values, first and second derivatives by x of s1 to s4.
struct Polynomial {
  std::array<double, 4> s, ds, dds;
};

Polynomial right_jacobian_polynomial(double x) {
  const auto [p, q] = stumpff_derivatives(x);  // sigma_2, sigma_3
  return {{-(p[0] - x * p[1]), q[0] - x * q[1], p[1], -q[1]},
          {x * p[2], -x * q[2], p[2], -q[2]},
          {p[2] + x * p[3], -q[2] - x * q[3], p[3], -q[3]}};
}

/// Coefficients of D = sum d_k x^k, from 2 x h' = h - h^2 - x/4 with h = 1 - x D: all of one sign, nothing cancels.
constexpr int kTerms = 16;
constexpr std::array<double, kTerms> series_of_D() {
  std::array<long double, kTerms + 1> h{1};
  std::array<double, kTerms> d{};
  for (std::size_t k = 1; k <= kTerms; ++k) {
    long double sum = k == 1 ? 0.25L : 0.0L;
    for (std::size_t i = 1; i < k; ++i) sum += h[i] * h[k - i];
    h[k] = -sum / static_cast<long double>(2 * k + 1);
    d[k - 1] = static_cast<double>(-h[k]);
  }
  return d;
}

/// D, D', D''. The series' terms fall by (2 pi)^-2 each; the closed form loses digits below x = 1.
std::array<double, 3> inverse_coefficient(double x) {
  if (x < 1) {
    static constexpr auto d = series_of_D();
    double D = 0, D1 = 0, D2 = 0;
    for (int k = kTerms - 1; k >= 0; --k) {
      D2 = D2 * x + 2 * D1;
      D1 = D1 * x + D;
      D = D * x + d[static_cast<std::size_t>(k)];
    }
    return {D, D1, D2};
  }
  const double half = std::sqrt(x) / 2, h = half * std::cos(half) / std::sin(half);
  const double h1 = (h - h * h - x / 4) / (2 * x);
  const double h2 = (h1 - 2 * h * h1 - 0.25) / (2 * x) - h1 / x;
  const double D = (1 - h) / x, D1 = (-h1 - D) / x;
  return {D, D1, (-h2 - 2 * D1) / x};
}

Polynomial inverse_polynomial(double x) {
  const auto [D, D1, D2] = inverse_coefficient(x);
  return {{0.5, D - x * D1, 0, -D1}, {0, -x * D2, 0, -D2}, {}};
}

/// curly_hat matrices and their products are [[D, U], [0, D]].
struct Upper {
  Eigen::Matrix3d D, U;
};
Upper upper(const Vector6& xi) {
  return {so3::hat(xi.tail<3>()), so3::hat(xi.head<3>())};
}
Upper times_plus(const Upper& a, const Upper& b, const Upper& c) {
  return {a.D * b.D + c.D, a.D * b.U + a.U * b.D + c.U};
}
Vector6 times(const Upper& a, const Vector6& v) {
  Vector6 out;
  out << a.D * v.head<3>() + a.U * v.tail<3>(), a.D * v.tail<3>();
  return out;
}

/// d(P(X) w)/dxi. With u_k = X^k w and d(X y) = -curly_hat(y) dxi + X dy, Horner's scheme gives
///   -[curly(s1 u0 + s2 u1 + s3 u2 + s4 u3) + X (curly(s2 u0 + s3 u1 + s4 u2) + X (curly(s3 u0 + s4 u1) + X curly(s4
///   u0)))] + (sum of ds_k u_k) d(x)/dxi.
Matrix6 derivative(const Polynomial& p, const Vector6& xi, const Vector6& w) {
  const Upper X = upper(xi);
  const Vector6 u1 = times(X, w), u2 = times(X, u1), u3 = times(X, u2), u4 = times(X, u3);
  Upper sum = upper(p.s[3] * w);
  sum = times_plus(X, sum, upper(p.s[2] * w + p.s[3] * u1));
  sum = times_plus(X, sum, upper(p.s[1] * w + p.s[2] * u1 + p.s[3] * u2));
  sum = times_plus(X, sum, upper(p.s[0] * w + p.s[1] * u1 + p.s[2] * u2 + p.s[3] * u3));
  Matrix6 J = Matrix6::Zero();
  J.topLeftCorner<3, 3>() = -sum.D;
  J.bottomRightCorner<3, 3>() = -sum.D;
  J.topRightCorner<3, 3>() = -sum.U;
  const Vector6 slope = p.ds[0] * u1 + p.ds[1] * u2 + p.ds[2] * u3 + p.ds[3] * u4;
  J.rightCols<3>() += slope * (2 * xi.tail<3>().transpose());
  return J;
}

}  // namespace

Matrix6 curly_hat(const Vector6& xi) {
  Matrix6 X = Matrix6::Zero();
  X.topLeftCorner<3, 3>() = so3::hat(xi.tail<3>());
  X.bottomRightCorner<3, 3>() = X.topLeftCorner<3, 3>();
  X.topRightCorner<3, 3>() = so3::hat(xi.head<3>());
  return X;
}

Matrix6 right_jacobian_derivative(const Vector6& xi, const Vector6& w) {
  return derivative(right_jacobian_polynomial(xi.tail<3>().squaredNorm()), xi, w);
}

Matrix6 right_jacobian_inverse_derivative(const Vector6& xi, const Vector6& w) {
  return derivative(inverse_polynomial(xi.tail<3>().squaredNorm()), xi, w);
}

Vector6 right_jacobian_rate(const Vector6& xi, const Vector6& w, Matrix6* by_xi, Matrix6* by_w) {
  const Polynomial p = right_jacobian_polynomial(xi.tail<3>().squaredNorm());
  // u_k = X^k w and v_k = du_k/ds for xi moving at w, X' = W: v_k = W u_(k-1) + X v_(k-1), where W w = 0.
  const Matrix6 X = curly_hat(xi), W = curly_hat(w);
  std::array<Vector6, 5> u, v;
  u[0] = w;
  v[0].setZero();
  for (std::size_t k = 1; k < 5; ++k) {
    u[k] = X * u[k - 1];
    v[k] = W * u[k - 1] + X * v[k - 1];
  }
  Row6 x_by_xi, x_by_w;  // of dx/ds = 2 phi . w_phi; x_by_w is also dx/dxi
  x_by_xi << 0, 0, 0, 2 * w.tail<3>().transpose();
  x_by_w << 0, 0, 0, 2 * xi.tail<3>().transpose();
  const double dx = x_by_w * w;
  Vector6 g = Vector6::Zero(), su = Vector6::Zero(), ssu_sv = Vector6::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    g += p.ds[k] * dx * u[k + 1] + p.s[k] * v[k + 1];
    su += p.ds[k] * u[k + 1];
    ssu_sv += p.dds[k] * dx * u[k + 1] + p.ds[k] * v[k + 1];
  }
  if (!by_xi && !by_w) return g;
  // The same sums with u_k, v_k differentiated: U and V by xi, Y and Z by w.
  Matrix6 U = Matrix6::Zero(), V = U, Y = Matrix6::Identity(), Z = U;
  Matrix6 g_xi = su * x_by_xi + ssu_sv * x_by_w, g_w = su * x_by_w;
  for (std::size_t k = 0; k < 4; ++k) {
    V = (W * U + X * V - curly_hat(v[k])).eval();
    U = (X * U - curly_hat(u[k])).eval();
    Z = (W * Y + X * Z - curly_hat(u[k])).eval();
    Y = (X * Y).eval();
    g_xi += p.ds[k] * dx * U + p.s[k] * V;
    g_w += p.ds[k] * dx * Y + p.s[k] * Z;
  }
  if (by_xi) *by_xi = g_xi;
  if (by_w) *by_w = g_w;
  return g;
}

}  // namespace tarmac::core::se3
