/// What a scenario may say of the hills: `scene: {kind: rough-hills, ...}`.
#pragma once

#include <Eigen/Core>

#include "core/options.h"

namespace tarmac::scenes {

struct HillsOptions {
  double relief_m = 5;
  double longest_m = 180, shortest_m = 18;
  double roughness = 1;
  double texture_rms_mm = 8;
  int rocks = 120;
  int trees = 110;
  double lane_m = 5;
  double half_size_m = 200;

  void visit(core::OptionVisitor& v) {
    v("relief_m", relief_m, "amplitude of the longest waves of the ground", {.at_least = 0.1, .at_most = 30});
    v("longest_m", longest_m, "longest wave of the ground", {.at_least = 60, .at_most = 600});
    v("shortest_m", shortest_m, "shortest wave of the ground", {.at_least = 10, .at_most = 50});
    v("roughness", roughness,
      "amplitudes fall with the wavelength to the power 1.4 / roughness: above 1, more of the "
      "short waves",
      {.at_least = 0.5, .at_most = 1.5});
    v("texture_rms_mm", texture_rms_mm, "tufts and clods, root mean square", {.at_least = 0, .at_most = 40});
    v("rocks", rocks, "rocks of 0.3 to 2.2 m", {.at_least = 0, .at_most = 600});
    v("trees", trees, "broad-leaved and coniferous", {.at_least = 0, .at_most = 600});
    v("lane_m", lane_m, "half the width of the track that is kept free", {.at_least = 2, .at_most = 20});
    v("half_size_m", half_size_m, "the ground reaches from -this to +this in x and y",
      {.at_least = 120, .at_most = 600});
  }
};

}  // namespace tarmac::scenes
