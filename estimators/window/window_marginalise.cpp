// How states leave a window.
#include <algorithm>
#include <stdexcept>

#include "estimators/window/window.h"

namespace tarmac::estimators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = WindowProblem::Item::Kind;

/// Which unknowns go, and which of the rest share residuals with them.
struct Cut {
  core::Time begin;               ///< of what stays
  int blocks = 0;                 ///< that go
  int bias_knots = 0;             ///< that go
  int touched_blocks = 0;         ///< that stay, after those
  MarginalPrior::Border touched;  ///< that stays, columns as they are before the cut
};

bool goes(const Cut& cut, const std::vector<BiasAnchor>& bias_anchors, const WindowProblem::Item& item) {
  switch (item.kind) {
    case Kind::reading:
    case Kind::increment:
    case Kind::smoothness:
    case Kind::anchor:
      return item.t < cut.begin;
    case Kind::model_prior:
      return item.index < cut.blocks;
    case Kind::bias_walk:
      return item.index < cut.bias_knots;
    case Kind::bias_anchor:
      return bias_anchors[static_cast<std::size_t>(item.index)].knot < cut.bias_knots;
    case Kind::gravity_prior:
    case Kind::offset_prior:
      return false;  // what they speak of stays
  }
  return false;
}

/// All knots before the last one that no residual which stays looks behind. Biases run on the recording's clock, a
/// reading's state on that less the offset, so that the first reading that stays may be stamped before `begin`.
int bias_knots_before(const std::vector<BiasKnot>& biases, core::Time begin, double offset_s) {
  const core::Time limit = std::min(begin, begin + core::duration_from_s(offset_s));
  const auto after =
      std::upper_bound(biases.begin(), biases.end(), limit, [](core::Time t, const BiasKnot& b) { return t < b.t; });
  return std::max(0, static_cast<int>(after - biases.begin()) - 1);
}

void find_touched(const BandedSystem& system, const BorderLayout& layout, int block_size, Cut& cut) {
  const auto touches = [&](int scalar) { return system.diagonal(scalar) != 0; };
  int last = block_size * cut.blocks;
  for (int i = last; i < system.band(); ++i)
    if (touches(i)) last = i + 1;
  cut.touched_blocks = (last + block_size - 1) / block_size - cut.blocks;
  for (int i = 6 * cut.bias_knots; i < 6 * layout.biases; ++i)
    if (touches(system.band() + i)) cut.touched.biases.push_back(i);
  cut.touched.gravity =
      layout.gravity >= 0 && (touches(system.band() + layout.gravity) || touches(system.band() + layout.gravity + 1));
  cut.touched.offset = layout.offset >= 0 && touches(system.band() + layout.offset);
}

/// Scalars of the system in the order: those that go, then those that stay and are touched.
std::vector<Index> order(const BandedSystem& system, const BorderLayout& layout, int block_size, const Cut& cut) {
  std::vector<Index> scalars;
  const auto append = [&](Index first, Index count) {
    for (Index i = 0; i < count; ++i) scalars.push_back(first + i);
  };
  append(0, block_size * cut.blocks);
  append(system.band(), 6 * cut.bias_knots);
  append(block_size * cut.blocks, block_size * cut.touched_blocks);
  for (const int column : cut.touched.biases) append(system.band() + column, 1);
  if (cut.touched.gravity) append(system.band() + layout.gravity, 2);
  if (cut.touched.offset) append(system.band() + layout.offset, 1);
  return scalars;
}

/// Only those unknowns that Marginalisation::fix holds.
Schur held(int block_size, Cut& cut) {
  cut.touched.gravity = cut.touched.offset = false;
  if (cut.bias_knots == 0) cut.touched.biases.clear();
  std::erase_if(cut.touched.biases, [&](int column) { return column >= 6 * (cut.bias_knots + 1); });
  const Index n = block_size * cut.touched_blocks + static_cast<Index>(cut.touched.biases.size());
  return {MatrixXd(MatrixXd::Identity(n, n) / (kFixedSigma * kFixedSigma)), VectorXd::Zero(n)};
}

}  // namespace

void hold_untouched(BandedSystem& system) {
  for (int i = system.band(); i < system.size(); ++i)
    if (system.diagonal(i) == 0) system.add_to_diagonal(i, 1);
}

void Window::marginalise_before(core::Time t, Marginalisation rule, double eigenvalue_threshold) {
  Cut cut;
  cut.blocks = trajectory().first_block_at(t);
  if (cut.blocks <= 0) return;
  if (cut.blocks >= trajectory().blocks()) throw std::invalid_argument("nothing of the window would stay");
  const auto rest = trajectory().clone();
  rest->drop(cut.blocks);
  cut.begin = rest->begin();
  cut.bias_knots = bias_knots_before(state_.biases, cut.begin, state_.imu_offset_s);

  WindowProblem leaving = problem();
  leaving.keep([&](const auto& item) { return goes(cut, data_.bias_anchors, item); },
               [&](const WindowProblem::Stamp& stamp) { return stamp.t < cut.begin; });
  const int size = trajectory().block_size();
  const int reached = std::min(trajectory().blocks(), cut.blocks + trajectory().reach());
  BandedSystem system(size * reached, leaving.half_bandwidth(state_), leaving.layout().size());
  leaving.assemble(state_, &system, &system);
  find_touched(system, leaving.layout(), size, cut);

  Schur information;
  if (rule == Marginalisation::fix) {
    information = held(size, cut);
  } else {
    const std::vector<Index> scalars = order(system, leaving.layout(), size, cut);
    const MatrixXd H = system.dense()(scalars, scalars);
    const VectorXd g = system.g()(scalars);
    information = marginalise(H, g, size * cut.blocks + 6 * cut.bias_knots,
                              rule == Marginalisation::eigenvalue ? eigenvalue_threshold : 0.0);
  }
  forget_before(cut.begin, cut.bias_knots);
  state_.trajectory->drop(cut.blocks);
  for (int& column : cut.touched.biases) column -= 6 * cut.bias_knots;
  data_.prior = information.g.size() > 0
                    ? MarginalPrior(state_, cut.touched_blocks, std::move(cut.touched), std::move(information))
                    : MarginalPrior();
}

/// Residuals before `begin` and the first bias knots. The last reading before stays as a neighbour of the first that
/// counts: velocity increments share the time between the two.
void Window::forget_before(core::Time begin, int bias_knots) {
  const core::Time first_stamp = begin + core::duration_from_s(state_.imu_offset_s);
  const auto first = std::lower_bound(data_.readings.begin(), data_.readings.end(), first_stamp,
                                      [](const ImuReading& r, core::Time t) { return r.t < t; });
  const auto spent = std::max<std::size_t>(data_.spent, static_cast<std::size_t>(first - data_.readings.begin()));
  const std::size_t erased = spent > 0 ? spent - 1 : 0;
  data_.readings.erase(data_.readings.begin(), data_.readings.begin() + static_cast<std::ptrdiff_t>(erased));
  data_.spent = spent - erased;

  for (auto& [sweep, factors] : data_.lidar) {
    LidarFactors kept;
    kept.distributions = factors.distributions;
    for (std::size_t i = 0; i < factors.stamps.size(); ++i) {
      if (factors.stamps[i] < begin) continue;
      kept.stamps.push_back(factors.stamps[i]);
      kept.factors.insert(kept.factors.end(), factors.factors.begin() + factors.first[i],
                          factors.factors.begin() + factors.first[i + 1]);
      kept.first.push_back(static_cast<std::uint32_t>(kept.factors.size()));
    }
    factors = std::move(kept);
  }
  std::erase_if(data_.lidar, [](const auto& entry) { return entry.second.stamps.empty(); });
  std::erase_if(data_.anchors, [&](const StateAnchor& anchor) { return anchor.t < begin; });

  state_.biases.erase(state_.biases.begin(), state_.biases.begin() + bias_knots);
  std::erase_if(data_.bias_anchors, [&](const BiasAnchor& anchor) { return anchor.knot < bias_knots; });
  for (BiasAnchor& anchor : data_.bias_anchors) anchor.knot -= bias_knots;
}

}  // namespace tarmac::estimators
