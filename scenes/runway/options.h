/// What a scenario may say of the runway crossing: `scene: {kind: runway-crossing, ...}`.
#pragma once

#include <string>

#include "core/options.h"

namespace tarmac::scenes {

struct RunwayOptions {
  double runway_width_m = 45;
  double runway_shoulder_m = 7.5;
  double crown_percent = 1.25;
  double longitudinal_slope_percent = 0.3;
  double undulation_mm = 8;
  double relief_rms_mm = 1.5;
  double threshold_west_m = 330;
  double runway_east_m = 320;
  std::string code_letter = "E";
  double fillet_radius_m = 40;
  double holding_distance_m = 90;
  double taxiway_south_m = 250;
  double taxiway_north_m = 220;
  bool with_road = true;
  double road_behind_hold_m = 55;
  bool with_lights = true;
  double edge_light_spacing_m = 55;
  bool with_stop_bars = true;
  bool with_signs = true;
  bool with_papi = true;
  bool with_windsock = true;
  double grass_m = 60;

  void visit(core::OptionVisitor& v) {
    v("runway_width_m", runway_width_m, "between the side stripes' outer edges", {.at_least = 30, .at_most = 60});
    v("runway_shoulder_m", runway_shoulder_m, "paved shoulder on each side", {.at_least = 0, .at_most = 15});
    v("crown_percent", crown_percent, "fall from the runway's centre line", {.at_least = 1, .at_most = 1.5});
    v("longitudinal_slope_percent", longitudinal_slope_percent, "rise to the east", {.at_least = -1.5, .at_most = 1.5});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the ground", {.at_least = 0, .at_most = 100});
    v("relief_rms_mm", relief_rms_mm, "texture of the pavement, root mean square", {.at_least = 0, .at_most = 10});
    v("threshold_west_m", threshold_west_m, "from the crossing to the western threshold",
      {.at_least = 160, .at_most = 900});
    v("runway_east_m", runway_east_m, "runway shown east of the crossing", {.at_least = 100, .at_most = 900});
    v.choice("code_letter", code_letter, {"A", "B", "C", "D", "E", "F"}, "aerodrome code of the crossing taxiway");
    v("fillet_radius_m", fillet_radius_m, "where runway and taxiway meet", {.at_least = 15, .at_most = 45});
    v("holding_distance_m", holding_distance_m, "of the holding positions from the runway's centre line",
      {.at_least = 85, .at_most = 110});
    v("taxiway_south_m", taxiway_south_m, "length of the taxiway south of the runway's centre line",
      {.at_least = 180, .at_most = 600});
    v("taxiway_north_m", taxiway_north_m, "length of the taxiway north of it", {.at_least = 150, .at_most = 600});
    v("with_road", with_road, "the service road that crosses the taxiway");
    v("road_behind_hold_m", road_behind_hold_m, "from the southern holding position back to the road's middle",
      {.at_least = 30, .at_most = 120});
    v("with_lights", with_lights, "edge and threshold lights, blue lights along the taxiway");
    v("edge_light_spacing_m", edge_light_spacing_m, "along the runway", {.at_least = 20, .at_most = 60});
    v("with_stop_bars", with_stop_bars, "red lights across the holding positions, guard lights beside them");
    v("with_signs", with_signs, "mandatory and location signs, stop signs on the road");
    v("with_papi", with_papi, "four boxes of the approach slope indicator, left of the landing");
    v("with_windsock", with_windsock, "a windsock south-east of the crossing");
    v("grass_m", grass_m, "grass beyond the taxiway's ends and the runway's western end",
      {.at_least = 20, .at_most = 200});
  }
};

}  // namespace tarmac::scenes
