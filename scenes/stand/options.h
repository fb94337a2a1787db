/// What a scenario may say of the stand: `scene: {kind: stand, ...}`.
#pragma once

#include "core/options.h"
#include "scenes/paving/paving.h"
#include "scenes/stand/layout.h"

namespace tarmac::scenes {

struct StandOptions {
  double slab_size_m = 7.5;
  double crossfall_percent = 0.8;
  double undulation_mm = 24;
  double slab_tilt_mm = 2;
  double relief_rms_mm = 2;
  double joint_depth_mm = 3;
  double apron_south_m = layout::apron_south_m;
  bool with_surroundings = true;
  bool with_aircraft = true;
  bool with_equipment = true;
  int cones = 12;
  int carts = 8;
  bool with_tug = true;
  double tug_speed_m_s = 4;
  double tug_start_s = 6;

  void visit(core::OptionVisitor& v) {
    v("slab_size_m", slab_size_m, "edge of a concrete slab", {.at_least = 4, .at_most = 15});
    v("crossfall_percent", crossfall_percent, "fall of the apron away from the terminal",
      {.at_least = -2, .at_most = 2});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the apron's base",
      {.at_least = 0, .at_most = 200});
    v("slab_tilt_mm", slab_tilt_mm, "standard deviation of a slab corner about the base",
      {.at_least = 0, .at_most = 10});
    v("relief_rms_mm", relief_rms_mm, "texture of the pavement, root mean square", {.at_least = 0, .at_most = 10});
    v("joint_depth_mm", joint_depth_mm, "mean depth of the joint grooves", {.at_least = 0, .at_most = 20});
    v("apron_south_m", apron_south_m, "where the pavement ends in the south: farther away, an open apron to come from",
      {.at_least = -600, .at_most = layout::apron_south_m});
    v("with_surroundings", with_surroundings, "hangar, cargo shed, blast fence and the masts along the southern edge");
    v("with_aircraft", with_aircraft, "the A320 on the stand");
    v("with_equipment", with_equipment, "loaders, carts, cones and parked vehicles");
    v("cones", cones, "cones around the aircraft", {.at_least = 0, .at_most = 12});
    v("carts", carts, "baggage carts in the equipment area", {.at_least = 0, .at_most = 16});
    v("with_tug", with_tug, "the baggage tractor that drives along the tail-of-stand road");
    v("tug_speed_m_s", tug_speed_m_s, "its cruising speed", {.at_least = 0.5, .at_most = 8});
    v("tug_start_s", tug_start_s, "when it has half its cruising speed", {.at_least = 0, .at_most = 600});
  }

  PavingSpec paving() const {
    PavingSpec spec;
    spec.low_m = {layout::apron_west_m, apron_south_m};
    spec.high_m = {layout::apron_east_m, layout::apron_north_m};
    spec.slab_size_m = slab_size_m;
    spec.crossfall_percent = crossfall_percent;
    spec.crossfall_zero_y_m = layout::corridor_north_y_m;
    spec.undulation_mm = undulation_mm;
    spec.slab_tilt_mm = slab_tilt_mm;
    spec.relief_rms_mm = relief_rms_mm;
    spec.joint_depth_mm = joint_depth_mm;
    spec.stream = "scenes/stand";
    return spec;
  }
};

}  // namespace tarmac::scenes
