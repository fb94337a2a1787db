/// Truncated Taylor series: exact derivatives of any order of what is put together from products, quotients, roots and
/// compositions. For motions that need more derivatives than a Jet has: a drone's tilt is made of its acceleration, so
/// its angular acceleration needs four derivatives of the position.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// f(t0 + x) = sum of c[k] x^k: c[k] is the k-th derivative divided by k!.
template <int N>
struct Series {
  std::array<double, N + 1> c{};

  static Series constant(double value) {
    Series s;
    s.c[0] = value;
    return s;
  }
  /// value + slope x.
  static Series line(double value, double slope) {
    Series s;
    s.c[0] = value;
    if constexpr (N > 0) s.c[1] = slope;
    return s;
  }
  double value() const { return c[0]; }
  /// First and second derivative.
  double d1() const { return c[1]; }
  double d2() const { return 2 * c[2]; }

  template <int M>
  Series<M> truncated() const {
    static_assert(M <= N);
    Series<M> s;
    for (int k = 0; k <= M; ++k) s.c[k] = c[k];
    return s;
  }

  Series& operator+=(const Series& b) {
    for (int k = 0; k <= N; ++k) c[k] += b.c[k];
    return *this;
  }
  friend Series operator+(Series a, const Series& b) { return a += b; }
  friend Series operator-(const Series& a) { return -1.0 * a; }
  friend Series operator-(Series a, const Series& b) { return a += -b; }
  friend Series operator*(double k, Series a) {
    for (double& value : a.c) value *= k;
    return a;
  }
  friend Series operator*(const Series& a, const Series& b) {
    Series s;
    for (int i = 0; i <= N; ++i)
      for (int j = 0; i + j <= N; ++j) s.c[i + j] += a.c[i] * b.c[j];
    return s;
  }
  friend Series operator/(const Series& a, const Series& b) {
    Series s;
    for (int k = 0; k <= N; ++k) {
      s.c[k] = a.c[k];
      for (int j = 1; j <= k; ++j) s.c[k] -= b.c[j] * s.c[k - j];
      s.c[k] /= b.c[0];
    }
    return s;
  }
};

template <int N>
Series<N - 1> derivative(const Series<N>& a) {
  Series<N - 1> s;
  for (int k = 1; k <= N; ++k) s.c[k - 1] = k * a.c[k];
  return s;
}

/// The integral that has this value at the point of expansion.
template <int N>
Series<N + 1> integral(const Series<N>& a, double value) {
  Series<N + 1> s;
  s.c[0] = value;
  for (int k = 0; k <= N; ++k) s.c[k + 1] = a.c[k] / (k + 1);
  return s;
}

/// outer(inner(t)): `outer` is expanded by its argument at inner.value().
template <int N>
Series<N> compose(const Series<N>& outer, Series<N> inner) {
  inner.c[0] = 0;
  Series<N> s = Series<N>::constant(outer.c[N]);
  for (int k = N - 1; k >= 0; --k) {
    s = s * inner;
    s.c[0] += outer.c[k];
  }
  return s;
}

template <int N>
Series<N> sqrt(const Series<N>& a) {
  Series<N> s;
  s.c[0] = std::sqrt(a.c[0]);
  for (int k = 1; k <= N; ++k) {
    s.c[k] = a.c[k];
    for (int j = 1; j < k; ++j) s.c[k] -= s.c[j] * s.c[k - j];
    s.c[k] /= 2 * s.c[0];
  }
  return s;
}

template <int N>
struct SeriesSinCos {
  Series<N> sin, cos;
};

template <int N>
SeriesSinCos<N> sin_cos(const Series<N>& angle) {
  const double s = std::sin(angle.c[0]), c = std::cos(angle.c[0]);
  const double turn[4] = {s, c, -s, -c};
  Series<N> sine, cosine;
  double factorial = 1;
  for (int k = 0; k <= N; ++k) {
    if (k > 0) factorial *= k;
    sine.c[k] = turn[k % 4] / factorial;
    cosine.c[k] = turn[(k + 1) % 4] / factorial;
  }
  return {compose(sine, angle), compose(cosine, angle)};
}

template <int N>
Series<N> exp(const Series<N>& a) {
  Series<N> outer;
  outer.c[0] = std::exp(a.c[0]);
  for (int k = 1; k <= N; ++k) outer.c[k] = outer.c[k - 1] / k;
  return compose(outer, a);
}

inline Series<3> series_of(const Jet& a) {
  Series<3> s;
  s.c = {a.f, a.d1, a.d2 / 2, a.d3 / 6};
  return s;
}

/// scenes::smooth_step to any order.
template <int N>
Series<N> smooth_step(const Series<N>& u) {
  const double at = u.c[0];
  if (at <= 0) return {};
  if (at >= 1) return Series<N>::constant(1);
  const Series<N> one = Series<N>::constant(1);
  const Series<N> w = one / (one - u) - one / u;
  // Beyond this h differs from 0 or 1 by less than 1e-260, and powers of it would overflow.
  if (w.c[0] < -600) return {};
  if (w.c[0] > 600) return one;
  // From the smaller side, so that 1 - h keeps its digits.
  return w.c[0] < 0 ? exp(w) / (one + exp(w)) : one / (one + exp(-w));
}

}  // namespace tarmac::sim::truth
