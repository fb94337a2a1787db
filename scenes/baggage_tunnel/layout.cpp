#include "scenes/baggage_tunnel/layout.h"

#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double vertical_curve_m = 80;  ///< smallest radius where a ramp begins or ends

/// Level between the first ramp's foot and the turn: as long as the side corridor, which runs above nothing but level
/// ground.
double first_leg_of(const BaggageTunnelOptions& o) {
  return BaggageTunnelLayout::ramp_begin_m + o.drop_m / (o.ramp_percent / 100) + 16;
}

PathPiece straight(double length_m) {
  PathPiece piece;
  piece.straight_m = length_m;
  return piece;
}

PathPiece turn(const BaggageTunnelOptions& o, double turn_deg, double blend_m) {
  PathPiece piece;
  piece.turn_deg = turn_deg;
  piece.radius_m = o.turn_radius_m;
  piece.blend_m = blend_m;
  return piece;
}

CentreLine line_of(const BaggageTunnelOptions& o) {
  constexpr double blend_m = BaggageTunnelLayout::turn_blend_m;
  return CentreLine(StartOptions{}, {straight(first_leg_of(o)), turn(o, 90, blend_m), straight(o.north_leg_m),
                                     turn(o, -90, blend_m), straight(o.last_leg_m)});
}

/// A ramp of height `rise_m` from u0 on, as points of a profile that is level outside.
RoundedProfile ramps(std::vector<std::array<double, 2>> begin_and_rise, double grade) {
  std::vector<RoundedProfile::Point> points{{-200, 0}};
  double z = 0;
  const double rounding = grade * vertical_curve_m / 4;
  for (const auto& [begin, rise] : begin_and_rise) {
    if (rise == 0) continue;
    points.push_back({begin, z, rounding});
    z += rise;
    points.push_back({begin + std::abs(rise) / grade, z, rounding});
  }
  points.push_back({1000, z});
  return RoundedProfile(points);
}

}  // namespace

BaggageTunnelLayout::BaggageTunnelLayout(const BaggageTunnelOptions& o)
    : half_m(o.width_m / 2),
      height_m(o.height_m),
      line(line_of(o)),
      first_leg_m(first_leg_of(o)),
      turn_m(o.turn_radius_m * std::numbers::pi / 2 + turn_blend_m),
      junction_m(first_leg_m + turn_m + o.north_leg_m / 2),
      side(CentreLine::straight(line.at(junction_m).p_m.x(), line.at(junction_m).p_m.y(), 180, half_m + side_length_m)),
      hall_length_m(8 * o.column_pitch_m),
      hall_half_m(3 * o.column_pitch_m) {}

std::shared_ptr<const SectionGround> baggage_ground(const BaggageTunnelOptions& options, std::uint64_t seed) {
  const BaggageTunnelLayout layout(options);
  const double last_leg_x = layout.line.at(layout.line.length_m() - options.last_leg_m).p_m.x();
  SectionSpec spec;
  spec.along =
      ramps({{layout.ramp_begin_m, -options.drop_m}, {last_leg_x + 8, options.rise_m}}, options.ramp_percent / 100);
  spec.undulation_mm = options.undulation_mm;
  spec.stream = "scenes/baggage_tunnel";
  // Along x: the northern leg lies where the profile is level.
  return std::make_shared<SectionGround>(CentreLine::straight(0, 0, 0, 1), spec, seed);
}

}  // namespace tarmac::scenes
