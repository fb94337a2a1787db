#include "sim/truth/suspension.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "scenes/paths/hermite7.h"
#include "scenes/paths/quadrature.h"
#include "sim/truth/block_table.h"

namespace tarmac::sim::truth {

using scenes::Gauss3;

namespace {

using Real = scenes::Extended;
constexpr Real h = 1e-3L;

/// Value and three derivatives at a node.
using NodeState = scenes::ExtendedJet;

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
    Real q = from.f * (g_rate + 2 * zeta_ * w_ * g) + from.d1 * g;
    Real d1 = -from.f * w_ * w_ * g + from.d1 * g_rate;
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

using States = std::array<NodeState, 3>;

constexpr std::size_t block_nodes = 256;
/// 66 s or 13 MB. Sweeps, IMU and checks each go through the drive once: most drives are solved once for all of them.
constexpr std::size_t blocks_in_memory = 256;

using Block = std::vector<std::array<scenes::Hermite7, 3>>;

Jet jet_of(const NodeState& s) {
  return {static_cast<double>(s.f), static_cast<double>(s.d1), static_cast<double>(s.d2), static_cast<double>(s.d3)};
}

}  // namespace

class Suspension::Solution {
 public:
  Solution(const std::array<Oscillator, 3>& modes, Forcing forcing, double end_s, const std::array<double, 3>& q,
           const std::array<double, 3>& q_dot, const Visitor& visit)
      : propagators_{Propagator(modes[0]), Propagator(modes[1]), Propagator(modes[2])},
        forcing_(std::move(forcing)),
        count_(static_cast<std::size_t>(std::ceil(end_s / node_spacing_s)) + 1),
        blocks_(blocks_in_memory, [this](std::size_t index) {
          States state = kept_[index];
          return make(index, state, {});
        }) {
    States state;
    const std::array<Jet, 3> F_begin = forcing_(0);
    for (int m = 0; m < 3; ++m) state[m] = propagators_[m].complete(q[m], q_dot[m], F_begin[m]);
    for (std::size_t index = 0; index * block_nodes < count_; ++index) {
      kept_.push_back(state);
      blocks_.put(index, std::make_shared<const Block>(make(index, state, visit)));
    }
  }

  std::array<Jet, 3> at(double t_s) const {
    const auto wanted = static_cast<std::size_t>(std::max(0.0, t_s / node_spacing_s));
    const std::size_t k = std::min(wanted, count_ - 1);
    const double x = t_s / node_spacing_s - static_cast<double>(k);
    const std::shared_ptr<const Block> block = blocks_.get(k / block_nodes);
    std::array<Jet, 3> result;
    for (int m = 0; m < 3; ++m) result[m] = scenes::evaluate((*block)[k % block_nodes][m], x, 1 / node_spacing_s);
    return result;
  }

 private:
  /// From node k to the node after it.
  States next(std::size_t k, const States& state) const {
    const double begin_s = static_cast<double>(k) * node_spacing_s;
    std::array<std::array<Real, 3>, 3> F_inside;  // [mode][node]
    for (int j = 0; j < 3; ++j) {
      const std::array<Jet, 3> F = forcing_(begin_s + Gauss3::node[j] * node_spacing_s);
      for (int m = 0; m < 3; ++m) F_inside[m][j] = F[m].f;
    }
    const std::array<Jet, 3> F_end = forcing_(static_cast<double>(k + 1) * node_spacing_s);
    States result;
    for (int m = 0; m < 3; ++m) result[m] = propagators_[m].next(state[m], F_inside[m], F_end[m]);
    return result;
  }

  /// `state` is that of the block's first node, and becomes that of the next block's.
  Block make(std::size_t index, States& state, const Visitor& visit) const {
    const std::size_t first = index * block_nodes, end = std::min(first + block_nodes, count_);
    Block result(end - first);
    for (std::size_t k = first; k < end; ++k) {
      if (visit) visit(static_cast<double>(k) * node_spacing_s, {jet_of(state[0]), jet_of(state[1]), jet_of(state[2])});
      const States after = next(k, state);
      for (int m = 0; m < 3; ++m) result[k - first][m] = scenes::hermite7(state[m], after[m], h);
      state = after;
    }
    return result;
  }

  std::array<Propagator, 3> propagators_;
  Forcing forcing_;
  std::size_t count_;         ///< of intervals
  std::vector<States> kept_;  ///< at the first node of every block
  BlockTable<Block> blocks_;
};

Suspension::Suspension(const std::array<Oscillator, 3>& modes, Forcing forcing, double end_s,
                       const std::array<double, 3>& q, const std::array<double, 3>& q_dot, const Visitor& visit)
    : solution_(std::make_shared<const Solution>(modes, std::move(forcing), end_s, q, q_dot, visit)) {}

std::array<Jet, 3> Suspension::at(double t_s) const {
  return solution_->at(t_s);
}

}  // namespace tarmac::sim::truth
