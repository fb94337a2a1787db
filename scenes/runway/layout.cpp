#include "scenes/runway/layout.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

RunwayLayout::RunwayLayout(const RunwayOptions& o)
    : half_m(o.runway_width_m / 2),
      shoulder_m(half_m + o.runway_shoulder_m),
      west_m(-o.threshold_west_m - 8),
      east_m(o.runway_east_m),
      threshold_m(-o.threshold_west_m),
      taxiway(taxiway_section(taxiway_code(o.code_letter))),
      south_m(-o.taxiway_south_m),
      north_m(o.taxiway_north_m),
      fillet_m(o.fillet_radius_m),
      hold_m(o.holding_distance_m),
      road_y_m(-o.holding_distance_m - o.road_behind_hold_m),
      has_road(o.with_road),
      field{{west_m - o.grass_m, south_m}, {east_m, north_m}} {}

std::vector<Rectangle> RunwayLayout::pavements() const {
  const double t = taxiway.shoulder_m;
  std::vector<Rectangle> list{{{west_m, -shoulder_m}, {east_m, shoulder_m}},
                              {{-t, south_m}, {t, -shoulder_m}},
                              {{-t, shoulder_m}, {t, north_m}}};
  if (has_road) {
    list.push_back({{-road_reach_m, road_y_m - road_half_m}, {-t, road_y_m + road_half_m}});
    list.push_back({{t, road_y_m - road_half_m}, {road_reach_m, road_y_m + road_half_m}});
  }
  return list;
}

std::vector<RunwayLayout::Corner> RunwayLayout::corners() const {
  std::vector<Corner> list;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) list.push_back({{x * taxiway.shoulder_m, y * shoulder_m}, {x, 0}, {0, y}});
  }
  return list;
}

std::shared_ptr<const SectionGround> runway_ground(const RunwayOptions& options, std::uint64_t seed) {
  const RunwayLayout layout(options);
  // Crown, shoulder and strip; nowhere steeper than a taxiway may climb (1.5 %).
  const double edge = -options.crown_percent / 100 * layout.half_m;
  const double shoulder = edge - 0.015 * (layout.shoulder_m + 0.1 - layout.half_m);
  const double strip_m = 75, strip = shoulder - 0.01 * (strip_m - layout.shoulder_m);
  SectionSpec spec;
  std::vector<RoundedProfile::Point> points{{-strip_m - 5, strip},
                                            {-strip_m, strip, 2},
                                            {-layout.shoulder_m - 0.1, shoulder, 0.8},
                                            {-layout.half_m, edge, 0.5},
                                            {0, 0, 1}};
  for (std::size_t k = 4; k-- > 0;) points.push_back({-points[k].u_m, points[k].z_m, points[k].rounding_m});
  spec.across = RoundedProfile(points);
  spec.slope = {options.longitudinal_slope_percent / 100, 0};
  spec.undulation_mm = options.undulation_mm;
  spec.stream = "scenes/runway";
  return std::make_shared<SectionGround>(CentreLine::straight(0, 0, 0, 100), spec, seed);
}

}  // namespace tarmac::scenes
