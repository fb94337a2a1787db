#include "scenes/stand/tug.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

/// ln cosh without overflow.
double log_cosh(double x) {
  const double a = std::abs(x);
  return a + std::log1p(std::exp(-2 * a)) - std::numbers::ln2;
}

double sech_squared(double x) {
  const double c = 1 / std::cosh(std::min(std::abs(x), 350.0));
  return c * c;
}

/// The value in [low, high] nearest to 0, where sech is largest.
double nearest_to_zero(double low, double high) {
  return low > 0 ? low : high < 0 ? high : 0;
}

}  // namespace

LaneMotion::LaneMotion(const Lane& lane, std::shared_ptr<const WavyGround> ground)
    : lane_(lane),
      direction_(lane.to_x_m > lane.from_x_m ? 1 : -1),
      stop_s_(lane.start_s + std::abs(lane.to_x_m - lane.from_x_m) / lane.speed_m_s),
      wave_per_m_(2 * std::numbers::pi / lane.wander_length_m),
      ground_(std::move(ground)) {}

core::SE3 LaneMotion::T_world_actor(core::Time t) const {
  const double t_s = core::to_s(t), tau = lane_.ramp_s;
  const double begin = (t_s - lane_.start_s) / tau, end = (t_s - stop_s_) / tau;
  const double total_s = stop_s_ - lane_.start_s;
  // The difference of the two ramps runs from -total to +total.
  const double s = 0.5 * lane_.speed_m_s * (tau * (log_cosh(begin) - log_cosh(end)) + total_s);
  const double x = lane_.from_x_m + direction_ * s;
  const double phase = wave_per_m_ * x + lane_.phase_rad;
  const double y = lane_.y_m + lane_.wander_m * std::sin(phase);
  const double path_slope = lane_.wander_m * wave_per_m_ * std::cos(phase);

  Eigen::Vector2d gradient;
  const double z = ground_->height_m(x, y, &gradient);
  const Vector3d up = Vector3d(-gradient.x(), -gradient.y(), 1).normalized();
  Vector3d forward(direction_, direction_ * path_slope, 0);
  forward.z() = gradient.dot(forward.head<2>());  // tangent to the ground, over the path's direction
  forward.normalize();
  core::SE3 T = core::SE3::Identity();
  T.linear().col(0) = forward;
  T.linear().col(1) = up.cross(forward);
  T.linear().col(2) = up;
  T.translation() = Vector3d(x, y, z);
  return T;
}

// Bounds, with path p(x) = (x, Y(x)), |Y'| <= a k, |Y''| <= a k^2, |Y'''| <= a k^3 and ground derivatives g1, g2, g3:
//   origin: horizontal |a_h| <= u' sqrt(1 + Y'^2) + |Y''| u^2 with u = |dx/dt|, vertical g1 |a_h| + g2 v^2;
//   rotation: yaw rate <= |Y''| u, yaw acceleration <= |Y'''| u^2 + |Y''| u' + 2 |Y'| Y''^2 u^2;
//   tilt: the normal turns at no more than g2 v, and its rate changes by no more than g3 v^2 + g2 |a_h| + 2 (g2 v)^2.
// A point at distance r adds (|alpha| + |omega|^2) r. Slopes of one percent couple yaw and tilt to second order only;
// the factor 1.05 holds them.
double LaneMotion::acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const {
  const double tau = lane_.ramp_s, v = lane_.speed_m_s;
  const auto scaled = [&](core::Time t, double centre_s) { return (core::to_s(t) - centre_s) / tau; };
  const double begin0 = scaled(t0, lane_.start_s), begin1 = scaled(t1, lane_.start_s);
  const double end0 = scaled(t0, stop_s_), end1 = scaled(t1, stop_s_);
  const double u = 0.5 * v * (std::tanh(begin1) - std::tanh(end0));
  const double du =
      0.5 * v / tau * (sech_squared(nearest_to_zero(begin0, begin1)) + sech_squared(nearest_to_zero(end0, end1)));
  const double y1 = lane_.wander_m * wave_per_m_, y2 = y1 * wave_per_m_, y3 = y2 * wave_per_m_;
  const double stretch = std::sqrt(1 + y1 * y1), speed = u * stretch;
  const GroundBounds g = ground_->bounds();

  const double horizontal = du * stretch + y2 * u * u;
  const double vertical = g.slope * horizontal + g.curvature_per_m * speed * speed;
  const double omega = y2 * u + g.curvature_per_m * speed;
  const double alpha = y3 * u * u + y2 * du + 2 * y1 * y2 * y2 * u * u + g.third_per_m2 * speed * speed +
                       g.curvature_per_m * horizontal + 2 * std::pow(g.curvature_per_m * speed, 2);
  const double bound = 1.05 * (std::hypot(horizontal, vertical) + (alpha + omega * omega) * radius_m);
  return bound < 1e-9 ? 0 : bound;
}

Mesh make_tug() {
  MeshBuilder b("tug");
  add_baggage_tractor(b);
  return std::move(b).build();
}

double mesh_radius_m(const Mesh& mesh) {
  float radius = 0;
  for (const Eigen::Vector3f& p : mesh.vertices) radius = std::max(radius, p.norm());
  return static_cast<double>(radius) * (1 + 1e-6);
}

}  // namespace tarmac::scenes
