/// Motions in closed form, for sensors and for actors.
#pragma once

#include <cmath>
#include <limits>

#include "core/lie.h"
#include "core/trajectory.h"
#include "scenes/scene.h"

namespace tarmac::tests {

/// p(t) = p0 + v t + a t^2 / 2, R(t) = Exp(w_world t) R0: straight or bent flight with a steady turn.
class SteadyMotion final : public core::SmoothTrajectory {
 public:
  Eigen::Vector3d p0_m = Eigen::Vector3d::Zero(), v_m_s = Eigen::Vector3d::Zero(), a_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_world_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R0 = Eigen::Matrix3d::Identity();
  double length_s = 10;

  core::Time begin() const override { return core::Time{}; }
  core::Time end() const override { return core::time_from_s(length_s); }
  core::Kinematics at(core::Time time) const override {
    if (!covers(time)) throw core::OutOfSpan("asked beyond the motion");
    const double t = core::to_s(time);
    core::Kinematics k;
    k.T_world_body.linear() = core::so3::exp(omega_world_rad_s * t) * R0;
    k.T_world_body.translation() = p0_m + v_m_s * t + 0.5 * t * t * a_m_s2;
    k.v_world = v_m_s + a_m_s2 * t;
    k.a_world = a_m_s2;
    k.omega_body = k.T_world_body.linear().transpose() * omega_world_rad_s;
    return k;
  }
};

/// 20 m/s and 90 degrees a second, tilted, so that no axis is special.
inline SteadyMotion fast_turn(const Eigen::Vector3d& p0_m) {
  SteadyMotion motion;
  motion.p0_m = p0_m;
  motion.v_m_s = Eigen::Vector3d(16, 12, 0);
  motion.omega_world_rad_s = Eigen::Vector3d(0.1, -0.15, 1).normalized() * (M_PI / 2);
  motion.R0 = core::so3::exp(Eigen::Vector3d(0.03, -0.05, 0.4));
  return motion;
}

/// The same for an actor.
class SteadyActor final : public scenes::ActorMotion {
 public:
  Eigen::Vector3d p0_m = Eigen::Vector3d::Zero(), v_m_s = Eigen::Vector3d::Zero(), a_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_world_rad_s = Eigen::Vector3d::Zero();

  core::SE3 T_world_actor(core::Time time) const override {
    const double t = core::to_s(time);
    core::SE3 T = core::SE3::Identity();
    T.linear() = core::so3::exp(omega_world_rad_s * t);
    T.translation() = p0_m + v_m_s * t + 0.5 * t * t * a_m_s2;
    return T;
  }
  double acceleration_bound_m_s2(core::Time, core::Time, double radius_m) const override {
    return a_m_s2.norm() + omega_world_rad_s.squaredNorm() * radius_m;  // centripetal
  }
};

}  // namespace tarmac::tests
