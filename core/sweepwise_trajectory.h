/// Models that begin anew with every sweep: one pose, or two.
#pragma once

#include <vector>

#include "core/parametric_trajectory.h"

namespace tarmac::core {

/// What a sweep's motion is made of.
enum class SweepwiseModel : std::uint8_t {
  rigid,              ///< one pose, held over the sweep
  constant_velocity,  ///< one pose, at the sweep's end; inside the sweep the twist between the two ends before
                      ///< (KISS-ICP's)
  two_pose_slerp,     ///< a pose at begin and one at end, slerp and lerp between (CT-ICP's)
  two_pose_screw,     ///< the same with a constant twist between
};

/// Sweeps with gaps between them: covers() is false in a gap, a boundary instant belongs to the later sweep. Blocks are
/// poses (6), T <- T Exp(step): one a sweep, or two (begin, end).
///
/// extend() predicts with the twist of the motion before: that between the last two ends (one pose) or from begin to
/// end (two poses). Two sweeps' blocks never meet: what ties them are residuals.
class SweepwiseTrajectory final : public ParametricTrajectory {
 public:
  /// Empty; `T_start` is where the first sweep begins.
  SweepwiseTrajectory(SweepwiseModel model, const SE3& T_start);

  SweepwiseModel model() const { return model_; }
  /// How many sweeps there are, and the span of one.
  std::size_t sweeps() const { return sweeps_.size(); }

  Time begin() const override;
  Time end() const override;
  bool covers(Time t) const override { return find(t) != nullptr; }
  Kinematics at(Time t) const override;
  int block_size() const override { return 6; }
  int blocks() const override { return poses_a_sweep() * static_cast<int>(sweeps_.size()); }
  int reach() const override { return poses_a_sweep(); }
  Derivative has() const override;
  void jet(Time t, Derivative upto, StateJet& jet) const override;
  StateVector rate(Time t, Derivative upto) const override;
  void retract(const Eigen::Ref<const Eigen::VectorXd>& step) override;
  Eigen::VectorXd value(int block) const override;
  void difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const override;
  /// Needs no knots. Throws InputError unless begin is at or after the last end, and end not before begin.
  void extend(Time begin, Time end, std::span<const Time> knots) override;
  int first_block_at(Time t) const override;
  /// `count` must end with a whole sweep.
  void drop(int count) override;
  Segment segment(Time t0, Time t1) const override;
  std::unique_ptr<ParametricTrajectory> clone() const override;

 private:
  struct Sweep {
    Time begin, end;
    SE3 first = SE3::Identity(), last = SE3::Identity();  ///< equal blocks of one-pose models: `last`
    Vector6 twist = Vector6::Zero();                      ///< of constant_velocity: body-centric, held [m/s, rad/s]
  };
  int poses_a_sweep() const {
    return model_ == SweepwiseModel::two_pose_slerp || model_ == SweepwiseModel::two_pose_screw ? 2 : 1;
  }
  static void fill_constant_velocity(const Sweep& sweep, Time t, Derivative upto, StateJet& jet);
  static void fill_screw(const Sweep& sweep, Time t, Derivative upto, StateJet& jet);
  static void fill_slerp(const Sweep& sweep, Time t, StateJet& jet);
  void fill(const Sweep& sweep, Time t, Derivative upto, StateJet& jet) const;
  SE3 pose_in(const Sweep& sweep, Time t) const;
  const Sweep* find(Time t) const;
  const Sweep& found(Time t) const;
  SE3& block(int i);
  const SE3& block(int i) const;
  /// Twist of the last motion, body-centric.
  Vector6 last_twist() const;

  SweepwiseModel model_;
  SE3 T_start_;
  std::vector<Sweep> sweeps_;
  std::vector<Sweep> before_;  ///< the last two that were dropped, as they were then
};

}  // namespace tarmac::core
