/// The motion between two registrations, from the IMU.
#pragma once

#include <deque>
#include <optional>

#include "core/trajectory.h"
#include "estimators/dead_reckoning/propagate.h"
#include "estimators/dead_reckoning/sample_chain.h"
#include "estimators/dead_reckoning/static_start.h"

namespace tarmac::estimators {

/// Keeps the samples since the last correction and propagates the state along them. Where there are none (a hole, or
/// samples that are late by more than the chain's patience) velocity and rate of turn stay what they were last.
class InertialPath {
 public:
  /// Rest over `rest_s` up to `end`, with the body's origin at the map's.
  InertialPath(const core::ImuSheet& sheet, double gravity_m_s2, double max_gap_periods,
               const StaticStart::Result& start, double rest_s, core::Time end);
  void add(const core::ImuSample& sample);

  const InertialState& state() const { return state_; }
  /// The state at `t`, not before state().t.
  InertialState state_at(core::Time t) const;
  struct Path {
    core::Segment T_map_body;  ///< nodes where spans end; slerp and lerp between
    double coasted_s = 0;      ///< how much of it had no samples
  };
  /// Over [begin, end], begin not before state().t.
  Path over(core::Time begin, core::Time end) const;
  /// A registration has its say; what lies before is forgotten. `omega_rad_s` is the rate for spans without samples.
  void correct(const InertialState& state, const Eigen::Vector3d& omega_rad_s);

 private:
  /// Calls visit(state at the begin, span) for the spans from state().t on, the last one ending at `end`.
  template <class Visit>
  InertialState walk(core::Time end, const Visit& visit) const;
  InertialState step(const InertialState& from, const ImuSpan& span, core::Time to) const;

  core::SE3 T_imu_body_;
  double gravity_m_s2_;
  StaticStart::Result start_;
  SampleChain chain_;
  InertialState state_;
  Eigen::Vector3d omega_rad_s_ = Eigen::Vector3d::Zero();
  std::deque<ImuSpan> spans_;
};

}  // namespace tarmac::estimators
