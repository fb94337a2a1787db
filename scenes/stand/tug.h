/// The baggage tractor that drives along the tail-of-stand road.
#pragma once

#include <memory>

#include "scenes/paving/paving.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Along x from one end of the lane to the other with a wander of sinusoidal form, all closed form and C-infinity:
///   s(t) = v tau/2 [ln cosh((t - t1)/tau) - ln cosh((t - t2)/tau)] + const,  speed = v/2 [tanh((t - t1)/tau) - tanh((t
///   - t2)/tau)] x = x0 + d s,  y = y0 + a sin(k x + phase),  d = +-1.
/// Heading follows the path, z the ground, pitch and roll its gradient. The actor's origin is the ground point between
/// the wheels; x forward.
class LaneMotion final : public ActorMotion {
 public:
  struct Lane {
    double from_x_m, to_x_m, y_m;
    double wander_m = 0.25, wander_length_m = 45, phase_rad = 0;
    double speed_m_s = 4, start_s = 6, ramp_s = 1.5;  ///< ramp_s is tau
  };
  LaneMotion(const Lane& lane, std::shared_ptr<const WavyGround> ground);
  core::SE3 T_world_actor(core::Time t) const override;
  double acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const override;
  /// When the lane's other end is reached (half the speed is left).
  double stop_s() const { return stop_s_; }

 private:
  Lane lane_;
  double direction_, stop_s_, wave_per_m_;
  std::shared_ptr<const WavyGround> ground_;
};

Mesh make_tug();
/// Of a sphere around the origin that holds the mesh.
double mesh_radius_m(const Mesh& mesh);

}  // namespace tarmac::scenes
