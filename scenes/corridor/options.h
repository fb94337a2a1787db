/// What a scenario may say of the corridor: `scene: {kind: corridor, ...}`.
#pragma once

#include "core/options.h"
#include "scenes/paving/paving.h"

namespace tarmac::scenes {

struct CorridorOptions {
  double length_m = 120;
  double width_m = 3.2;
  double height_m = 2.8;
  double door_pitch_m = 6;
  double light_pitch_m = 4;
  double features_per_10m = 2;
  double floor_undulation_mm = 2;

  void visit(core::OptionVisitor& v) {
    v("length_m", length_m, "between the two end walls; the corridor runs along x, its middle at 0",
      {.at_least = 20, .at_most = 1000});
    v("width_m", width_m, "between the walls", {.at_least = 2.8, .at_most = 12});
    v("height_m", height_m, "from floor to ceiling", {.at_least = 2.4, .at_most = 8});
    v("door_pitch_m", door_pitch_m, "from door to door on one side (0: no doors)", {.at_least = 0, .at_most = 200});
    v("light_pitch_m", light_pitch_m, "from lamp to lamp along the ceiling (0: no lamps)",
      {.at_least = 0, .at_most = 200});
    v("features_per_10m", features_per_10m, "boards, cabinets, radiators and pipes on both walls together",
      {.at_least = 0, .at_most = 12});
    v("floor_undulation_mm", floor_undulation_mm, "amplitude of the floor's longest wave",
      {.at_least = 0, .at_most = 5});
  }
  PavingSpec floor() const {
    PavingSpec spec;
    spec.crossfall_percent = 0;
    spec.undulation_mm = floor_undulation_mm;
    spec.stream = "scenes/corridor";
    return spec;
  }
};

}  // namespace tarmac::scenes
