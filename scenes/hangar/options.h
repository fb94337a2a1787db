/// What a scenario may say of a hangar: `scene: {kind: hangar, ...}`.
#pragma once

#include <string>

#include "scenes/apron/paving_options.h"
#include "scenes/buildings/hangar.h"

namespace tarmac::scenes {

struct HangarOptions {
  double width_m = 55;
  double depth_m = 52;
  double door_width_m = 46;
  double door_height_m = 14;
  double eaves_m = 16;
  double frame_pitch_m = 8;
  std::string aircraft = "a320";
  bool with_docking = true;
  int cabinets = 36;
  int loose_items = 14;
  // A floor is made level; the apron in front is part of the same plane.
  PavingOptions paving{.crossfall_percent = 0, .undulation_mm = 6, .slab_tilt_mm = 1, .relief_rms_mm = 1};

  void visit(core::OptionVisitor& v) {
    v("width_m", width_m, "outside, along the door", {.at_least = 40, .at_most = 110});
    v("depth_m", depth_m, "outside", {.at_least = 40, .at_most = 110});
    v("door_width_m", door_width_m, "of the open door", {.at_least = 20, .at_most = 100});
    v("door_height_m", door_height_m, "of the open door", {.at_least = 8, .at_most = 30});
    v("eaves_m", eaves_m, "where the walls end; the ridge is 3 m higher", {.at_least = 10, .at_most = 34});
    v("frame_pitch_m", frame_pitch_m, "from one steel frame to the next", {.at_least = 4, .at_most = 15});
    v("aircraft", aircraft, "the type inside, its nose at the back (tarmac list aircraft); none: an empty hangar");
    v("with_docking", with_docking, "working platforms around the aircraft");
    v("cabinets", cabinets, "tool cabinets and benches along the walls", {.at_least = 0, .at_most = 80});
    v("loose_items", loose_items, "tool carts, ladders, drums and people near the aircraft",
      {.at_least = 0, .at_most = 40});
    paving.visit(v);
  }

  HangarSpec spec() const {
    return {.width_m = width_m,
            .depth_m = depth_m,
            .eaves_m = eaves_m,
            .ridge_m = eaves_m + 3,
            .door_width_m = door_width_m,
            .door_height_m = door_height_m,
            .door_leaves = 8,
            .open = true,
            .hollow = true,
            .frame_pitch_m = frame_pitch_m};
  }
};

}  // namespace tarmac::scenes
