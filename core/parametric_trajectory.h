/// Trajectories that an estimator solves for: the state at a time, and how it depends on the parameters.
///
/// A residual knows its Jacobian by the state at its time, a trajectory knows how that state depends on its parameters;
/// whoever chains the two makes any residual work on any trajectory. Parameters come in blocks of one size, in order of
/// time: a control point (6), a pose (6), a knot of a Gaussian process (12 or 18). What holds at a time depends on a
/// run of neighbouring blocks, so that normal equations are banded.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "core/trajectory.h"

namespace tarmac::core {

/// How far the derivatives go that are asked for.
enum class Derivative : std::uint8_t { pose = 0, velocity = 1, acceleration = 2 };

/// Where the parts of a state's tangent stand: the pose perturbed on the right, T Exp(rho, phi), the others by adding.
namespace state_row {
inline constexpr int pose = 0;           ///< rho, phi
inline constexpr int velocity = 6;       ///< v_world
inline constexpr int omega = 9;          ///< omega_body
inline constexpr int acceleration = 12;  ///< a_world
inline constexpr int alpha = 15;         ///< alpha_body
inline constexpr int count = 18;
/// Rows that are filled when asked for derivatives up to `upto`: 6, 12 or 18.
constexpr int filled(Derivative upto) {
  return 6 * (static_cast<int>(upto) + 1);
}
}  // namespace state_row

using StateVector = Eigen::Matrix<double, state_row::count, 1>;

/// The state at one time, and its Jacobian by the parameters first, first + 1, ... (scalars, not blocks).
/// Rows as in state_row; those beyond what was asked for are not set.
struct StateJet {
  static constexpr int kMaxColumns = 36;
  Kinematics state;
  int first = 0;
  Eigen::Matrix<double, state_row::count, Eigen::Dynamic, Eigen::ColMajor, state_row::count, kMaxColumns> J;

  int columns() const { return static_cast<int>(J.cols()); }
};

/// A prior between neighbouring blocks: cost e^T information e / 2, e by the parameters from `first` on.
struct PriorJet {
  int first = 0;
  Eigen::VectorXd e;
  Eigen::MatrixXd J;  ///< e.size() x the columns from `first` on
  Eigen::MatrixXd information;
};

/// A motion with parameters. Blocks have one size each; parameter block_size() * i + j is the j-th of block i.
class ParametricTrajectory : public SmoothTrajectory {
 public:
  virtual int block_size() const = 0;
  virtual int blocks() const = 0;
  /// The state at a time depends on so many neighbouring blocks at most; a prior no more.
  virtual int reach() const = 0;
  int parameters() const { return block_size() * blocks(); }
  /// The highest derivative that the model has; at() and jet() give those above as zero.
  virtual Derivative has() const = 0;

  /// Throws OutOfSpan where covers(t) is false.
  virtual void jet(Time t, Derivative upto, StateJet& jet) const = 0;
  /// d(state)/dt in the state's tangent: (R^T v, omega), a, alpha, jerk, d(alpha)/dt; rows as filled by `upto`. It is
  /// the Jacobian by a shift of time.
  virtual StateVector rate(Time t, Derivative upto) const = 0;
  /// Poses at many times, ascending (equal ones allowed), faster than one by one and to the same bits.
  virtual void poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const;

  /// parameters <- parameters (+) step. Poses are normalised afterwards.
  virtual void retract(const Eigen::Ref<const Eigen::VectorXd>& step) = 0;
  /// A block's value, as plain numbers for difference().
  virtual Eigen::VectorXd value(int block) const = 0;
  /// d with block = base (+) d, and dd/d(step) of a further step: block = base (+) (d + J step) to first order.
  virtual void difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const = 0;

  /// Priors that are part of the model (a Gaussian process's): prior i ties block i to block i + 1.
  virtual int priors() const { return 0; }
  virtual void prior(int i, PriorJet& jet) const;
  /// Covariance of the state at t when all parameters are held, rows filled by `upto`: what a Gaussian process may do
  /// between two knots. Zero for motions that their parameters determine. To it comes J P J^T.
  virtual Eigen::MatrixXd conditional_covariance(Time t, Derivative upto) const;

  /// Grows so that [begin, end] is covered, moving on as the model itself expects to (at constant velocity, or as the
  /// process's mean). `knots`: times after the last knot, ascending, the last at or after `end`; models of one or two
  /// poses a sweep need none. Throws InputError for knots that do not ascend.
  virtual void extend(Time begin, Time end, std::span<const Time> knots) = 0;
  /// The first block that any state at or after t depends on.
  virtual int first_block_at(Time t) const = 0;
  /// Forgets the first `count` blocks; afterwards begin() is the first time that does not depend on them.
  virtual void drop(int count) = 0;

  /// The motion over [t0, t1] with its parameters, to be kept. Throws OutOfSpan.
  virtual Segment segment(Time t0, Time t1) const = 0;
  virtual std::unique_ptr<ParametricTrajectory> clone() const = 0;
};

}  // namespace tarmac::core
