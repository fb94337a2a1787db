/// What a scenario may say of an open apron: `scene: {kind: open-apron, ...}`.
#pragma once

#include "scenes/apron/paving_options.h"

namespace tarmac::scenes {

struct OpenApronOptions {
  double clutter_per_ha = 4;
  double facade_distance_m = 60;
  bool with_markings = true;
  PavingOptions paving;

  void visit(core::OptionVisitor& v) {
    v("clutter_per_ha", clutter_per_ha, "equipment that stands about, objects per hectare; 0: nothing",
      {.at_least = 0, .at_most = 40});
    v("facade_distance_m", facade_distance_m,
      "from the lane's centre line to the nearest façade, a terminal along its northern side; 0: there is none, else "
      "at "
      "least 12",
      {.at_least = 0, .at_most = 300});
    v("with_markings", with_markings, "taxilane, lead-in lines and stand numbers; without them, bare concrete");
    paving.visit(v);
  }
};

}  // namespace tarmac::scenes
