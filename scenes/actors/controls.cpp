#include "scenes/actors/controls.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

core::SE3 UniformlyAccelerated::T_world_actor(core::Time t) const {
  const double t_s = core::to_s(t);
  core::SE3 T = core::SE3::Identity();
  const double heading = p_.heading_rad + t_s * (p_.turn_rad_s + 0.5 * t_s * p_.turn_rad_s2);
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = p_.position_m + t_s * (p_.velocity_m_s + 0.5 * t_s * p_.acceleration_m_s2);
  return T;
}

double UniformlyAccelerated::acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const {
  const auto rate = [&](core::Time t) { return std::abs(p_.turn_rad_s + core::to_s(t) * p_.turn_rad_s2); };
  const double omega = std::max(rate(t0), rate(t1));  // linear in between
  return p_.acceleration_m_s2.norm() + (std::abs(p_.turn_rad_s2) + omega * omega) * radius_m;
}

}  // namespace tarmac::scenes
