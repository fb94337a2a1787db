#include "scenes/paths/smooth_step.h"

#include <array>
#include <cmath>

#include "scenes/paths/quadrature.h"

namespace tarmac::scenes {

namespace {

/// Beyond this |w| the step differs from 0 or 1 by less than the smallest normal double.
constexpr double w_max = 700;

double value(double u) {
  if (u <= 0) return 0;
  if (u >= 1) return 1;
  const double w = 1 / (1 - u) - 1 / u;
  return w < -w_max ? 0.0 : 1 / (1 + std::exp(-w));
}

/// Integrals up to the nodes k / (2 intervals) of the lower half; the upper half follows by symmetry.
struct LowerHalf {
  static constexpr int intervals = 256;
  static constexpr double width = 0.5 / intervals;
  std::array<double, intervals + 1> at{};
  LowerHalf() {
    for (int k = 0; k < intervals; ++k) at[k + 1] = at[k] + Gauss3::integrate(value, k * width, (k + 1) * width);
  }
};

double lower_half_integral(double u) {
  static const LowerHalf table;
  const int k = static_cast<int>(u / LowerHalf::width);
  return table.at[k] + Gauss3::integrate(value, k * LowerHalf::width, u);
}

}  // namespace

Jet smooth_step(double u) {
  if (u <= 0) return {0, 0, 0, 0};
  if (u >= 1) return {1, 0, 0, 0};
  const double a = 1 / u, b = 1 / (1 - u);
  const double w = b - a;
  if (w < -w_max) return {0, 0, 0, 0};
  if (w > w_max) return {1, 0, 0, 0};
  const Jet w_jet{w, b * b + a * a, 2 * (b * b * b - a * a * a), 6 * (b * b * b * b + a * a * a * a)};
  // The logistic function and its derivatives; 1 - h by its own exponential, since it may be tiny.
  const double h = 1 / (1 + std::exp(-w)), g = 1 / (1 + std::exp(w));
  const double d1 = h * g, d2 = d1 * (g - h), d3 = d2 * (g - h) - 2 * d1 * d1;
  return chain({h, d1, d2, d3}, w_jet);
}

double smooth_step_integral(double u) {
  if (u <= 0) return 0;
  if (u >= 1) return u - 0.5;
  return u < 0.5 ? lower_half_integral(u) : u - 0.5 + lower_half_integral(1 - u);
}

namespace {

/// Integrals of x h(x) up to the nodes k / intervals.
struct Moments {
  static constexpr int intervals = 512;
  static constexpr double width = 1.0 / intervals;
  static double integrand(double x) { return x * value(x); }
  std::array<double, intervals + 1> at{};
  Moments() {
    for (int k = 0; k < intervals; ++k) at[k + 1] = at[k] + Gauss3::integrate(integrand, k * width, (k + 1) * width);
  }
};

double moment(double u) {
  static const Moments table;
  if (u >= 1) return table.at.back();
  const int k = static_cast<int>(u / Moments::width);
  return table.at[k] + Gauss3::integrate(Moments::integrand, k * Moments::width, u);
}

}  // namespace

double smooth_step_second_integral(double u) {
  if (u <= 0) return 0;
  // Integral of (u - x) h(x) up to u, and for u > 1 what follows of the integral x - 1/2.
  if (u < 1) return u * smooth_step_integral(u) - moment(u);
  return 0.5 - moment(1) + (u * u - u) / 2;
}

}  // namespace tarmac::scenes
