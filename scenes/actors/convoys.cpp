#include "scenes/actors/convoys.h"

#include <cmath>
#include <numbers>

namespace tarmac::scenes {
namespace {

/// A point of the path with derivatives by distance.
PlanarJets jets_of(const PlanarPath& path, double s_m) {
  const PlanarPath::Point p = path.at(s_m);
  const SinCos direction = sin_cos(p.heading);
  return {{p.x_m, direction.cos.f, direction.cos.d1, direction.cos.d2},
          {p.y_m, direction.sin.f, direction.sin.d1, direction.sin.d2},
          p.heading};
}

PlanarPose pose_of(const PlanarPath& path, double s_m) {
  const PlanarPath::Point p = path.at(s_m);
  return {p.x_m, p.y_m, p.heading.f};
}

Jet arc_tangent(const Jet& x) {
  const double q = 1 / (1 + x.f * x.f);
  return chain({std::atan(x.f), q, -2 * x.f * q * q, (6 * x.f * x.f - 2) * q * q * q}, x);
}

}  // namespace

PlanarPose SingleVehicle::body(std::size_t, double s_m) const {
  return pose_of(course_.path(), s_m);
}

Train::Train(Course course, const std::vector<TrailerChain::Link>& carts)
    : course_(std::move(course)),
      chain_([this](double s_m) { return jets_of(course_.path(), s_m); }, carts, course_.length_m()) {}

PlanarPose Train::body(std::size_t index, double s_m) const {
  const PlanarPose leader = pose_of(course_.path(), s_m);
  return index == 0 ? leader : chain_.pose(index - 1, s_m, leader);
}

Pushback::Pushback(Course course, double wheelbase_m, double towbar_m, double tractor_m)
    : course_(std::move(course)),
      wheelbase_m_(wheelbase_m),
      towbar_m_(towbar_m),
      chain_([this](double s_m) { return coupling(s_m); }, {{0, tractor_m}}, course_.length_m()) {}

PlanarJets Pushback::coupling(double s_m) const {
  const PlanarJets p = jets_of(course_.path(), s_m);
  const SinCos chi = sin_cos(p.heading);
  const Jet mu = p.heading - arc_tangent(wheelbase_m_ * course_.path().curvature(s_m));
  const SinCos roll = sin_cos(mu);
  return {p.x_m - wheelbase_m_ * chi.cos - towbar_m_ * roll.cos, p.y_m - wheelbase_m_ * chi.sin - towbar_m_ * roll.sin,
          mu};
}

PlanarPose Pushback::body(std::size_t index, double s_m) const {
  if (index == aircraft) {
    PlanarPose pose = pose_of(course_.path(), s_m);
    pose.heading_rad += std::numbers::pi;
    return pose;
  }
  const PlanarJets h = coupling(s_m);
  const PlanarPose end{h.x_m.f, h.y_m.f, h.heading.f};
  return index == towbar ? end : chain_.pose(0, s_m, end);
}

TrailerChain::Bend Pushback::sharpest_steer() const {
  TrailerChain::Bend sharpest;
  for (double s_m = 0; s_m < course_.length_m(); s_m += 0.1) {
    const double angle = std::atan(wheelbase_m_ * std::abs(course_.path().heading(s_m).d1));
    if (angle > sharpest.angle_rad) sharpest = {angle, s_m, 0};
  }
  return sharpest;
}

}  // namespace tarmac::scenes
