/// The residuals of a window at one moment: which there are, what each says, and their sums.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "estimators/window/banded_system.h"
#include "estimators/window/lidar_factors.h"
#include "estimators/window/local_sum.h"
#include "estimators/window/marginal_prior.h"
#include "estimators/window/term.h"
#include "estimators/window/window_model.h"
#include "estimators/window/window_state.h"

namespace tarmac::estimators {

/// A Gaussian prior on the whole state at one time; rows of sigma that are 0 or less say nothing.
struct StateAnchor {
  core::Time t;
  core::Kinematics mean;
  core::StateVector sigma = core::StateVector::Zero();
};

/// A Gaussian prior on one bias knot.
struct BiasAnchor {
  int knot = 0;
  core::Vector6 mean = core::Vector6::Zero(), sigma = core::Vector6::Zero();
};

/// What a window knows beside its unknowns.
struct WindowData {
  std::vector<ImuReading> readings;  ///< ascending
  std::size_t spent = 0;             ///< so many of the first are no residuals any more: they went into the prior
  std::map<std::int64_t, LidarFactors> lidar;
  std::vector<StateAnchor> anchors;
  std::vector<BiasAnchor> bias_anchors;
  MarginalPrior prior;
  Eigen::Vector3d gravity_start = -Eigen::Vector3d::UnitZ();
};

/// The residuals that hold at a state: IMU readings that its trajectory covers, knots as they are. They stay the same
/// ones while the state moves, except that readings which the offset moves out of the span are left out.
class WindowProblem {
 public:
  WindowProblem(const WindowModel& model, const WindowData& data, const WindowState& state);

  /// Residuals other than LiDAR's and the marginal prior.
  struct Item {
    enum class Kind : std::uint8_t {
      reading,
      increment,
      smoothness,
      anchor,
      model_prior,
      bias_walk,
      bias_anchor,
      gravity_prior,
      offset_prior
    };
    Kind kind = Kind::reading;
    int index = 0;
    core::Time t;         ///< of reading, increment (its begin), smoothness, anchor, at the state it was made for
    double weight_s = 0;  ///< smoothness: its share of time
  };
  const std::vector<Item>& items() const { return items_; }
  struct Stamp {
    const LidarFactors* factors = nullptr;
    std::size_t index = 0;
    core::Time t;
  };
  const std::vector<Stamp>& stamps() const { return stamps_; }
  /// LiDAR stamps and anchors that the trajectory does not cover.
  int uncovered() const { return uncovered_; }

  /// Keeps only what is asked for: of a marginalisation.
  void keep(const std::function<bool(const Item&)>& item, const std::function<bool(const Stamp&)>& stamp);

  const BorderLayout& layout() const { return layout_; }
  BandedSystem system(const WindowState& state) const;
  int half_bandwidth(const WindowState& state) const;

  /// Half the sum of weighted squares; infinite where an IMU reading has left the span by more than 20 ms.
  double cost(const WindowState& state, bool lidar) const;
  /// Adds to the systems that are given; the marginal prior goes to `rest`.
  void assemble(const WindowState& state, BandedSystem* lidar, BandedSystem* rest) const;
  /// Readings that the offset has moved out of the trajectory's span.
  int left_out(const WindowState& state) const;

  /// Whitened residuals of one item, with Jacobians if asked for; empty where it is left out.
  void terms(const WindowState& state, const Item& item, bool jacobians, std::vector<Term>& out) const;
  /// Those of one LiDAR stamp, by the pose: a term a factor, `first` and J that of the trajectory.
  void lidar_terms(const WindowState& state, const Stamp& stamp, std::vector<Term>& out) const;
  const MarginalPrior& prior() const { return data_->prior; }

 private:
  void list_readings(const WindowState& state);
  void list_between_knots(const WindowState& state);
  void list_priors(const WindowState& state);
  void list_lidar(const WindowState& state);
  void reading_terms(const WindowState& state, const Item& item, bool jacobians, std::vector<Term>& out) const;
  void increment_term(const WindowState& state, const Item& item, std::vector<Term>& out) const;
  void smoothness_term(const WindowState& state, const Item& item, bool jacobians, std::vector<Term>& out) const;
  void anchor_term(const WindowState& state, const Item& item, std::vector<Term>& out) const;
  void model_prior_term(const WindowState& state, const Item& item, std::vector<Term>& out) const;
  void border_term(const WindowState& state, const Item& item, std::vector<Term>& out) const;
  void add_bias(const WindowState& state, core::Time stamp, int axis, const Eigen::Matrix3d& by_bias, Term& term) const;
  double stamp_cost(const LidarFactors& factors, std::size_t index, const core::SE3& T_map_body) const;
  void stamp_sum(const WindowState& state, const Stamp& stamp, core::StateJet& jet, LocalSum& sum) const;

  const WindowModel* model_;
  const WindowData* data_;
  BorderLayout layout_;
  std::vector<core::Time> breaks_;
  std::vector<Item> items_;
  std::vector<Stamp> stamps_;
  int uncovered_ = 0;
};

/// A one on the diagonal of each border unknown that no residual looks at, so that it stays where it is.
void hold_untouched(BandedSystem& system);

}  // namespace tarmac::estimators
