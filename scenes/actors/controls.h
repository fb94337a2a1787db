/// Motions with an answer in closed form, to hold the ray tracer against.
#pragma once

#include "scenes/scene.h"

namespace tarmac::scenes {

/// x(t) = x0 + v t + a t^2 / 2 and heading(t) = psi0 + w t + alpha t^2 / 2, on and on.
class UniformlyAccelerated final : public ActorMotion {
 public:
  struct Parameters {
    Eigen::Vector3d position_m{0, 0, 0}, velocity_m_s{0, 0, 0}, acceleration_m_s2{0, 0, 0};
    double heading_rad = 0, turn_rad_s = 0, turn_rad_s2 = 0;
  };
  explicit UniformlyAccelerated(const Parameters& parameters) : p_(parameters) {}
  core::SE3 T_world_actor(core::Time t) const override;
  double acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const override;

 private:
  Parameters p_;
};

}  // namespace tarmac::scenes
