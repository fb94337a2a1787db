#include "sim/truth/suspension.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/paths/quadrature.h"

namespace tarmac::sim::truth {

using scenes::Gauss3;

namespace {

/// Extended, since the polynomials' higher coefficients are small differences of the states at two nodes.
using Real = long double;
constexpr Real h = 1e-3L;

/// Value and three derivatives at a node.
struct NodeState {
  Real q = 0, d1 = 0, d2 = 0, d3 = 0;
};

class Propagator {
 public:
  explicit Propagator(const Suspension::Oscillator& oscillator)
      : w_(2 * std::numbers::pi_v<Real> * oscillator.frequency_hz), zeta_(oscillator.damping) {
    for (int j = 0; j < 3; ++j) {
      const Real rest = h * (1 - static_cast<Real>(Gauss3::node[j]));
      to_value_[j] = h * static_cast<Real>(Gauss3::weight[j]) * impulse(rest);
      to_rate_[j] = h * static_cast<Real>(Gauss3::weight[j]) * impulse_rate(rest);
    }
  }

  /// The node's second and third derivative follow from the equation of motion.
  NodeState complete(Real q, Real d1, const Jet& F) const {
    const Real d2 = F.f - 2 * zeta_ * w_ * d1 - w_ * w_ * q;
    return {q, d1, d2, F.d1 - 2 * zeta_ * w_ * d2 - w_ * w_ * d1};
  }

  NodeState next(const NodeState& from, const std::array<Real, 3>& F_inside, const Jet& F_end) const {
    const Real g = impulse(h), g_rate = impulse_rate(h);
    Real q = from.q * (g_rate + 2 * zeta_ * w_ * g) + from.d1 * g;
    Real d1 = -from.q * w_ * w_ * g + from.d1 * g_rate;
    for (int j = 0; j < 3; ++j) {
      q += to_value_[j] * F_inside[j];
      d1 += to_rate_[j] * F_inside[j];
    }
    return complete(q, d1, F_end);
  }

 private:
  Real damped() const { return w_ * std::sqrt(1 - zeta_ * zeta_); }
  Real impulse(Real x) const { return std::exp(-zeta_ * w_ * x) * std::sin(damped() * x) / damped(); }
  Real impulse_rate(Real x) const {
    return std::exp(-zeta_ * w_ * x) * (std::cos(damped() * x) - zeta_ * w_ / damped() * std::sin(damped() * x));
  }
  Real w_, zeta_;
  std::array<Real, 3> to_value_{}, to_rate_{};
};

/// The polynomial of degree 7 on [0, 1] with these values and derivatives at both ends.
std::array<double, 8> hermite7(const NodeState& a, const NodeState& b) {
  const Real c0 = a.q, c1 = h * a.d1, c2 = h * h * a.d2 / 2, c3 = h * h * h * a.d3 / 6;
  const Real e0 = b.q - (c0 + c1 + c2 + c3), e1 = h * b.d1 - (c1 + 2 * c2 + 3 * c3);
  const Real e2 = h * h * b.d2 - (2 * c2 + 6 * c3), e3 = h * h * h * b.d3 - 6 * c3;
  const Real c4 = 35 * e0 - 15 * e1 + 2.5L * e2 - e3 / 6, c5 = -84 * e0 + 39 * e1 - 7 * e2 + e3 / 2;
  const Real c6 = 70 * e0 - 34 * e1 + 6.5L * e2 - e3 / 2, c7 = -20 * e0 + 10 * e1 - 2 * e2 + e3 / 6;
  const auto d = [](Real x) { return static_cast<double>(x); };
  return {d(c0), d(c1), d(c2), d(c3), d(c4), d(c5), d(c6), d(c7)};
}

}  // namespace

Suspension::Suspension(const std::array<Oscillator, 3>& modes, const Forcing& forcing, double end_s,
                       const std::array<double, 3>& q, const std::array<double, 3>& q_dot) {
  const std::array<Propagator, 3> propagators{Propagator(modes[0]), Propagator(modes[1]), Propagator(modes[2])};
  std::array<NodeState, 3> state;
  const std::array<Jet, 3> F_begin = forcing(0);
  for (int m = 0; m < 3; ++m) state[m] = propagators[m].complete(q[m], q_dot[m], F_begin[m]);
  const auto count = static_cast<std::size_t>(std::ceil(end_s / node_spacing_s)) + 1;
  intervals_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double begin_s = static_cast<double>(k) * node_spacing_s;
    std::array<std::array<Real, 3>, 3> F_inside;  // [mode][node]
    for (int j = 0; j < 3; ++j) {
      const std::array<Jet, 3> F = forcing(begin_s + Gauss3::node[j] * node_spacing_s);
      for (int m = 0; m < 3; ++m) F_inside[m][j] = F[m].f;
    }
    const std::array<Jet, 3> F_end = forcing(static_cast<double>(k + 1) * node_spacing_s);
    for (int m = 0; m < 3; ++m) {
      const NodeState next = propagators[m].next(state[m], F_inside[m], F_end[m]);
      intervals_[k][m] = hermite7(state[m], next);
      state[m] = next;
    }
  }
}

std::array<Jet, 3> Suspension::at(double t_s) const {
  const auto wanted = static_cast<std::size_t>(std::max(0.0, t_s / node_spacing_s));
  const std::size_t k = std::min(wanted, intervals_.size() - 1);
  const double x = t_s / node_spacing_s - static_cast<double>(k);
  constexpr double r = 1 / node_spacing_s;
  std::array<Jet, 3> result;
  for (int m = 0; m < 3; ++m) {
    const Polynomial& c = intervals_[k][m];
    double f = 0, d1 = 0, d2 = 0, d3 = 0;  // d2 and d3 are collected divided by 2 and 6
    for (int i = 7; i >= 0; --i) {
      d3 = d3 * x + d2;
      d2 = d2 * x + d1;
      d1 = d1 * x + f;
      f = f * x + c[i];
    }
    result[m] = {f, d1 * r, 2 * d2 * r * r, 6 * d3 * r * r * r};
  }
  return result;
}

}  // namespace tarmac::sim::truth
