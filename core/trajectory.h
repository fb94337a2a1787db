/// Motion as a function of time.
///
/// A trajectory answers for the pose at any time of its span and never extrapolates. Estimators' trajectories are made
/// of segments; between two of them it may jump (CT-ICP's and KISS-ICP's do), and it may have gaps (a spinning sensor
/// fires nothing between a sweep's last column and the next sweep's first).
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::core {

/// Asked for a time that the trajectory does not cover.
class OutOfSpan : public std::out_of_range {
 public:
  using std::out_of_range::out_of_range;
};

/// Body frame: x forward, y left, z up. Derivatives are of the body frame's origin, seen in the world.
struct Kinematics {
  SE3 T_world_body = SE3::Identity();
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();     ///< [m/s]
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();     ///< [m/s^2], gravity not included
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d alpha_body = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual Time begin() const = 0;
  virtual Time end() const = 0;
  /// False before begin(), after end(), and in gaps.
  virtual bool covers(Time t) const { return begin() <= t && t <= end(); }
  /// Throws OutOfSpan where covers(t) is false.
  virtual SE3 pose(Time t) const = 0;
};

/// A trajectory whose derivatives exist and are known exactly (truth; splines).
class SmoothTrajectory : public Trajectory {
 public:
  virtual Kinematics at(Time t) const = 0;
  SE3 pose(Time t) const override { return at(t).T_world_body; }
};

/// How the pose at one time depends on one 6-dimensional parameter block:
/// T(t; theta (+) d) = T(t; theta) Exp(jacobian d) to first order, blocks being poses perturbed on the right.
struct BlockJacobian {
  int block = 0;
  Matrix6 jacobian = Matrix6::Zero();
};

/// The models that a segment may have. Values are written to files: never renumber.
enum class SegmentModel : std::uint8_t {
  two_pose_slerp = 1,  ///< slerp of rotation and lerp of translation between the poses at t0 and t1 (CT-ICP's)
  two_pose_screw = 2,  ///< constant twist: T0 Exp(s Log(T0^-1 T1))
  held = 3,            ///< one pose over the whole span
  sampled_screw = 4,   ///< poses at listed times, a constant twist between neighbours
  sampled_slerp = 5,   ///< poses at listed times, slerp and lerp between neighbours
  sampled_hold = 6,    ///< poses at listed times, each held until the next
  spline_split = 7,    ///< cumulative B-spline of rotation, B-spline of position, same knots (spline_trajectory.h)
  spline_se3 = 8,      ///< cumulative B-spline on SE(3)
  gp_wnoa = 9,         ///< Gaussian process with white noise on acceleration, its mean between knots (gp_trajectory.h)
  gp_wnoj = 10,        ///< with white noise on jerk
  gp_singer = 11,      ///< with an acceleration that forgets itself (Singer)
};

/// A model with its parameters over [t0, t1]. `poses` holds 2 (two_pose_*), 1 (held) or `times.size()` entries
/// (sampled_*, strictly ascending times, the first t0, the last t1). Splines: `poses` are control points, n of them, and
/// `times` their n + order knots. Gaussian processes: poses at the knots `times` (two or more), and `twists` their
/// body-centric velocities one after the other, then (wnoj, singer) their derivatives, then (singer) the six rates [1/s].
struct Segment {
  Time t0, t1;
  SegmentModel model = SegmentModel::held;
  std::vector<SE3> poses;
  std::vector<Time> times;       ///< not of two_pose_* and held
  std::vector<Vector6> twists = {};  ///< of gp_* only

  static Segment two_pose(SegmentModel model, Time t0, const SE3& T0, Time t1, const SE3& T1);
  static Segment hold(Time t0, Time t1, const SE3& T);
  /// Throws InputError unless times are strictly ascending, as many as poses, at least one.
  static Segment sampled(SegmentModel model, std::vector<Time> times, std::vector<SE3> poses);

  /// Throws OutOfSpan outside [t0, t1].
  SE3 pose(Time t) const;
  /// The pose at t with its Jacobian by each pose that it depends on (block = index into `poses`).
  SE3 pose(Time t, std::vector<BlockJacobian>& jacobians) const;
};

/// Ordered segments. A boundary instant belongs to the later one.
class PiecewiseTrajectory final : public Trajectory {
 public:
  PiecewiseTrajectory() = default;
  /// Throws InputError unless segments are ordered and do not overlap (touching is fine).
  explicit PiecewiseTrajectory(std::vector<Segment> segments);

  /// Throws InputError when the segment starts before the last one's end.
  void append(Segment segment);

  bool empty() const { return segments_.empty(); }
  const std::vector<Segment>& segments() const { return segments_; }
  Time begin() const override;
  Time end() const override;
  bool covers(Time t) const override { return find(t) != nullptr; }
  SE3 pose(Time t) const override;
  /// The segment that holds at t; nullptr in gaps and outside.
  const Segment* find(Time t) const;

 private:
  std::vector<Segment> segments_;
};

}  // namespace tarmac::core
