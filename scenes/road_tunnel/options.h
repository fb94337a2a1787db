/// What a scenario may say of the road tunnel: `scene: {kind: road-tunnel, ...}`.
#pragma once

#include "core/options.h"

namespace tarmac::scenes {

struct RoadTunnelOptions {
  double length_m = 200;
  double width_m = 9.6;
  double height_m = 5.2;
  double ramp_percent = 6;
  double vertical_curve_m = 300;
  double cover_m = 1;
  double walkway_m = 0.75;
  bool niches = false;
  double niche_spacing_m = 60;
  bool with_wall_lights = true;
  double light_spacing_m = 10;
  double undulation_mm = 6;
  double relief_rms_mm = 1.5;
  bool with_taxiway = true;

  void visit(core::OptionVisitor& v) {
    v("length_m", length_m, "of the closed box, between its portals", {.at_least = 60, .at_most = 400});
    v("width_m", width_m, "between the walls", {.at_least = 9, .at_most = 10.5});
    v("height_m", height_m, "from the road to the ceiling", {.at_least = 5, .at_most = 5.5});
    v("ramp_percent", ramp_percent, "grade of the ramps", {.at_least = 5, .at_most = 7});
    v("vertical_curve_m", vertical_curve_m, "smallest radius where the grade changes",
      {.at_least = 200, .at_most = 400});
    v("cover_m", cover_m, "soil between the box and the ground above", {.at_least = 0.5, .at_most = 2.5});
    v("walkway_m", walkway_m, "width of the raised walkways", {.at_least = 0.5, .at_most = 1});
    v("niches", niches, "emergency niches in the walls; without them the box is the same at every place along it");
    v("niche_spacing_m", niche_spacing_m, "of niches along each wall", {.at_least = 50, .at_most = 100});
    v("with_wall_lights", with_wall_lights, "flat lamps along both walls");
    v("light_spacing_m", light_spacing_m, "of lamps along each wall", {.at_least = 8, .at_most = 12});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the ground", {.at_least = 0, .at_most = 50});
    v("relief_rms_mm", relief_rms_mm, "texture of the road, root mean square", {.at_least = 0, .at_most = 10});
    v("with_taxiway", with_taxiway, "the taxiway that crosses above");
  }
};

}  // namespace tarmac::scenes
