#include "scenes/road_tunnel/layout.h"

#include <cmath>

#include "scenes/paths/smooth_step.h"

namespace tarmac::scenes {

namespace {

PavingSpec waves_of(const RoadTunnelOptions& options) {
  PavingSpec spec;
  spec.crossfall_percent = 0;
  spec.undulation_mm = options.undulation_mm;
  spec.stream = "scenes/road_tunnel";
  return spec;
}

RoundedProfile ramps_of(const RoadTunnelLayout& l) {
  return RoundedProfile({{-l.ramp_head_m - 10, 0},
                         {-l.ramp_head_m, 0, l.rounding_m},
                         {-l.ramp_foot_m, -l.depth_m, l.rounding_m},
                         {l.ramp_foot_m, -l.depth_m, l.rounding_m},
                         {l.ramp_head_m, 0, l.rounding_m},
                         {l.ramp_head_m + 10, 0}});
}

}  // namespace

RoadTunnelLayout::RoadTunnelLayout(const RoadTunnelOptions& o)
    : half_m(o.width_m / 2), height_m(o.height_m), portal_m(o.length_m / 2) {
  depth_m = height_m + roof_m + o.cover_m;
  const double grade = o.ramp_percent / 100;
  ramp_foot_m = portal_m + 6;
  ramp_head_m = ramp_foot_m + depth_m / grade;
  rounding_m = grade * o.vertical_curve_m / 4;  // the smallest radius is 4 w / grade
  wall_end_m = ramp_head_m + 6;
  road_end_m = ramp_head_m + 60;
}

RoadTunnelGround::RoadTunnelGround(const RoadTunnelOptions& options, std::uint64_t seed)
    : layout_(options), ramps_(ramps_of(layout_)), waves_(waves_of(options), seed) {}

double RoadTunnelGround::height_m(double x_m, double y_m, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const {
  const double waves = waves_.height_m(x_m, y_m, gradient, hessian);
  const RoundedProfile::Value ramp = ramps_.at(x_m);
  const double width = 0.8 * layout_.wall_m, side = y_m < 0 ? -1 : 1;
  const Jet step = smooth_step((std::abs(y_m) - layout_.half_m - 0.1 * layout_.wall_m) / width);
  const double beside = 1 - step.f, d1 = -side * step.d1 / width, d2 = -step.d2 / (width * width);
  if (gradient != nullptr) *gradient += Eigen::Vector2d(ramp.grade * beside, ramp.z_m * d1);
  if (hessian != nullptr) *hessian += Eigen::Vector3d(ramp.curvature_per_m * beside, ramp.grade * d1, ramp.z_m * d2);
  return waves + ramp.z_m * beside;
}

}  // namespace tarmac::scenes
