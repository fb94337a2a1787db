/// What a scenario may say of the highway: `scene: {kind: highway, ...}`.
#pragma once

#include <string>

#include "core/options.h"

namespace tarmac::scenes {

struct HighwayOptions {
  double length_m = 1600;
  double radius_m = 900;
  double turn_deg = 20;
  double grade_percent = 1.5;
  int lanes = 2;
  double lane_m = 3.75;
  double median_m = 4;
  double crossfall_percent = 2.5;
  double undulation_mm = 12;
  double relief_rms_mm = 1.2;
  bool guard_rails = true;
  double post_pitch_m = 4;
  std::string noise_barrier = "none";
  double gantry_pitch_m = 450;
  double sign_pitch_m = 240;
  double delineator_pitch_m = 50;
  int trees = 90;
  int parked_vehicles = 3;

  void visit(core::OptionVisitor& v) {
    v("length_m", length_m, "of the road along its centre line", {.at_least = 300, .at_most = 3500});
    v("radius_m", radius_m, "of its two bends, one to the left and one to the right",
      {.at_least = 300, .at_most = 10000});
    v("turn_deg", turn_deg, "how far each bend turns (0: straight)", {.at_least = 0, .at_most = 60});
    v("grade_percent", grade_percent, "climb over the first third, as much down over the last",
      {.at_least = 0, .at_most = 6});
    v("lanes", lanes, "lanes of a carriageway", {.at_least = 1, .at_most = 4});
    v("lane_m", lane_m, "width of a lane", {.at_least = 3, .at_most = 4.5});
    v("median_m", median_m, "between the two carriageways", {.at_least = 3, .at_most = 20});
    v("crossfall_percent", crossfall_percent, "fall of both carriageways to the outside",
      {.at_least = 0, .at_most = 4});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the road", {.at_least = 0, .at_most = 40});
    v("relief_rms_mm", relief_rms_mm, "texture of asphalt, root mean square", {.at_least = 0, .at_most = 10});
    v("guard_rails", guard_rails, "W-beams on posts at all four edges");
    v("post_pitch_m", post_pitch_m, "from post to post of the rails", {.at_least = 1, .at_most = 8});
    v.choice("noise_barrier", noise_barrier, {"none", "right", "left", "both"}, "walls of 4 m beyond the verge");
    v("gantry_pitch_m", gantry_pitch_m, "from sign gantry to sign gantry (0: none)", {.at_least = 0});
    v("sign_pitch_m", sign_pitch_m, "from sign to sign on the verge (0: none)", {.at_least = 0});
    v("delineator_pitch_m", delineator_pitch_m, "from post to post with reflectors (0: none)", {.at_least = 0});
    v("trees", trees, "beyond the verges", {.at_least = 0, .at_most = 1000});
    v("parked_vehicles", parked_vehicles, "on the right shoulder, broken down", {.at_least = 0, .at_most = 20});
  }
};

}  // namespace tarmac::scenes
