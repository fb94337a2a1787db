/// A value with its first three derivatives: closed forms put together by the chain rule stay exact to the last one.
#pragma once

#include <cmath>
#include <numbers>

namespace tarmac::scenes {

/// Derivatives are by whatever the jet's maker says: the time [s], or an argument such as the distance [m].
struct Jet {
  double f = 0, d1 = 0, d2 = 0, d3 = 0;
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.f + b.f, a.d1 + b.d1, a.d2 + b.d2, a.d3 + b.d3};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.f - b.f, a.d1 - b.d1, a.d2 - b.d2, a.d3 - b.d3};
}
inline Jet operator*(double k, const Jet& a) {
  return {k * a.f, k * a.d1, k * a.d2, k * a.d3};
}
inline Jet operator-(const Jet& a) {
  return -1.0 * a;
}

/// Leibniz' rule.
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.f * b.f, a.d1 * b.f + a.f * b.d1, a.d2 * b.f + 2 * a.d1 * b.d1 + a.f * b.d2,
          a.d3 * b.f + 3 * a.d2 * b.d1 + 3 * a.d1 * b.d2 + a.f * b.d3};
}

/// outer(inner(t)): `outer` holds derivatives by its argument, taken at inner.f (Faa di Bruno's rule).
inline Jet chain(const Jet& outer, const Jet& inner) {
  return {outer.f, outer.d1 * inner.d1, outer.d2 * inner.d1 * inner.d1 + outer.d1 * inner.d2,
          outer.d3 * inner.d1 * inner.d1 * inner.d1 + 3 * outer.d2 * inner.d1 * inner.d2 + outer.d1 * inner.d3};
}

struct SinCos {
  Jet sin, cos;
};

/// Sine and cosine of an angle [rad].
inline SinCos sin_cos(const Jet& angle) {
  const double s = std::sin(angle.f), c = std::cos(angle.f);
  return {chain({s, c, -s, -c}, angle), chain({c, -s, -c, s}, angle)};
}

/// The derivative as a jet of its own; its third derivative is not known and is left at 0.
inline Jet derivative(const Jet& a) {
  return {a.d1, a.d2, a.d3, 0};
}

inline double radians(double degrees) {
  return degrees * (std::numbers::pi / 180);
}

}  // namespace tarmac::scenes
