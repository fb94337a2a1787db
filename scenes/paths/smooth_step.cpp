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

}  // namespace tarmac::scenes
