/// What a scenario may say of the taxiway: `scene: {kind: taxiway, ...}`.
#pragma once

#include <string>

#include "core/options.h"

namespace tarmac::scenes {

struct TaxiwayOptions {
  std::string shape = "straight";
  std::string code_letter = "E";
  double length_m = 900;
  double turn_deg = 90;
  double turn_radius_m = 75;
  double longitudinal_slope_percent = 0.4;
  double transverse_slope_percent = 1.2;
  double undulation_mm = 5;
  double relief_rms_mm = 1.5;
  double swale_depth_m = 0.45;
  double grass_m = 110;
  bool with_parallel = true;
  bool with_lights = true;
  double light_spacing_m = 50;
  double curve_light_spacing_m = 10;
  bool with_signs = true;
  double sign_spacing_m = 220;
  bool with_drains = true;
  double drain_spacing_m = 55;
  int huts = 2;

  void visit(core::OptionVisitor& v) {
    v.choice("shape", shape, {"straight", "curve"}, "one straight, or two that a bend joins at the origin");
    v.choice("code_letter", code_letter, {"A", "B", "C", "D", "E", "F"},
             "aerodrome code: widths, and the parallel taxiway's distance");
    v("length_m", length_m, "along the centre line", {.at_least = 200, .at_most = 2000});
    v("turn_deg", turn_deg, "of the bend, to the left", {.at_least = 20, .at_most = 120});
    v("turn_radius_m", turn_radius_m, "of the bend's centre line, at its tightest", {.at_least = 40, .at_most = 400});
    v("longitudinal_slope_percent", longitudinal_slope_percent, "rise to the east (code A and B: at most 3, else 1.5)",
      {.at_least = -3, .at_most = 3});
    v("transverse_slope_percent", transverse_slope_percent, "fall from the crown (code A and B: at most 2, else 1.5)",
      {.at_least = 0, .at_most = 2});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the ground", {.at_least = 0, .at_most = 100});
    v("relief_rms_mm", relief_rms_mm, "texture of the pavement, root mean square", {.at_least = 0, .at_most = 10});
    v("swale_depth_m", swale_depth_m, "depth of the ditches in the grass", {.at_least = 0, .at_most = 1});
    v("grass_m", grass_m, "grass beyond the outermost pavement", {.at_least = 30, .at_most = 200});
    v("with_parallel", with_parallel, "a parallel taxiway to the right, at the code's separation");
    v("with_lights", with_lights, "blue edge lights, and lights set into the centre line");
    v("light_spacing_m", light_spacing_m, "of edge lights on straights", {.at_least = 15, .at_most = 60});
    v("curve_light_spacing_m", curve_light_spacing_m, "of edge lights around the bend",
      {.at_least = 7.5, .at_most = 15});
    v("with_signs", with_signs, "location and direction signs");
    v("sign_spacing_m", sign_spacing_m, "of signs along each side", {.at_least = 40, .at_most = 1000});
    v("with_drains", with_drains, "catch pits in the ditches");
    v("drain_spacing_m", drain_spacing_m, "of catch pits", {.at_least = 50, .at_most = 90});
    v("huts", huts, "equipment huts on the grass", {.at_least = 0, .at_most = 12});
  }
};

}  // namespace tarmac::scenes
