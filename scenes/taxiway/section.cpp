#include "scenes/taxiway/section.h"

#include <algorithm>

namespace tarmac::scenes {

namespace {

constexpr double ditch_side_m = 3, shoulder_extra_percent = 0.5, graded_percent = 2.5;

/// The bend blends in over as much as a steering nose wheel needs, and over no more than half of the bend.
PathPiece bend_of(const TaxiwayOptions& options) {
  PathPiece bend;
  bend.turn_deg = options.turn_deg;
  bend.radius_m = options.turn_radius_m;
  bend.blend_m = std::min(25.0, 0.4 * options.turn_radius_m * radians(options.turn_deg));
  return bend;
}

CentreLine line_of(const TaxiwayOptions& options) {
  if (options.shape == "straight") return CentreLine::straight(-options.length_m / 2, 0, 0, options.length_m);
  const PathPiece bend = bend_of(options);
  const double straight_m = (options.length_m - bend.radius_m * radians(bend.turn_deg) - bend.blend_m) / 2;
  StartOptions start;
  start.x_m = -straight_m;
  PathPiece straight;
  straight.straight_m = straight_m;
  return CentreLine(start, {straight, bend, straight});
}

}  // namespace

TaxiwaySection taxiway_section(const TaxiwayCode& code) {
  const double edge = code.width_m / 2, shoulder = code.width_with_shoulders_m / 2;
  // Ditches of parallel taxiways fit beside each other.
  const double graded = shoulder + std::clamp(code.separation_m / 2 - shoulder - 2 * ditch_side_m - 1, 1.2, 10.0);
  return {edge, shoulder, graded, graded + ditch_side_m, graded + 2 * ditch_side_m};
}

TaxiwayLayout::TaxiwayLayout(const TaxiwayOptions& options)
    : code_(&taxiway_code(options.code_letter)),
      section_(taxiway_section(*code_)),
      taxiways_d_m_{0},
      line_(line_of(options)) {
  if (options.with_parallel) taxiways_d_m_.push_back(-code_->separation_m);
  const double bend_m = options.shape == "straight" ? 0 : line_.length_m() - 2 * (-line_.at(0).p_m.x());
  bend_begin_m_ = (line_.length_m() - bend_m) / 2;
  bend_end_m_ = bend_begin_m_ + bend_m;
}

std::shared_ptr<const SectionGround> TaxiwayLayout::ground(const TaxiwayOptions& options, std::uint64_t seed) const {
  const TaxiwaySection& s = section_;
  const double fall = options.transverse_slope_percent / 100, shoulder_fall = fall + shoulder_extra_percent / 100;
  const double z_edge = -fall * s.edge_m, z_shoulder = z_edge - shoulder_fall * (s.shoulder_m - s.edge_m);
  const double z_graded = z_shoulder - graded_percent / 100 * (s.graded_m - s.shoulder_m);
  std::vector<RoundedProfile::Point> half{{0, 0, 0.8}, {s.edge_m, z_edge, 0.3}};
  if (s.shoulder_m > s.edge_m) half.push_back({s.shoulder_m, z_shoulder, 0.3});
  half.insert(
      half.end(),
      {{s.graded_m, z_graded, 0.4}, {s.swale_m, z_graded - options.swale_depth_m, 0.5}, {s.outer_m, z_graded, 0.4}});
  std::vector<double> centres = taxiways_d_m_;
  std::sort(centres.begin(), centres.end());
  std::vector<RoundedProfile::Point> points{{centres.front() - s.outer_m - 5, z_graded}};
  for (const double centre : centres) {
    for (auto p = half.rbegin(); p != half.rend(); ++p) points.push_back({centre - p->u_m, p->z_m, p->rounding_m});
    for (auto p = half.begin() + 1; p != half.end(); ++p) points.push_back({centre + p->u_m, p->z_m, p->rounding_m});
  }
  points.push_back({centres.back() + s.outer_m + 5, z_graded});
  SectionSpec spec;
  spec.across = RoundedProfile(points);
  spec.slope = {options.longitudinal_slope_percent / 100, 0};
  spec.undulation_mm = options.undulation_mm;
  spec.stream = "scenes/taxiway";
  return std::make_shared<SectionGround>(line_, spec, seed);
}

}  // namespace tarmac::scenes
