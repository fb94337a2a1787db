/// What a scenario may say of a terminal pier: `scene: {kind: pier, ...}`.
#pragma once

#include <string>

#include "scenes/apron/paving_options.h"

namespace tarmac::scenes {

struct PierOptions {
  int stands_per_side = 4;
  bool both_sides = true;
  std::string codes = "CCEC";
  double pitch_c_m = 42;
  double pitch_e_m = 74;
  double pier_width_m = 30;
  double pier_length_m = 0;
  double occupied_share = 0.8;
  double equipment_density = 1;
  bool with_hall = true;
  PavingOptions paving;

  void visit(core::OptionVisitor& v) {
    v("stands_per_side", stands_per_side, "stands along a side of the pier", {.at_least = 1, .at_most = 8});
    v("both_sides", both_sides, "stands along the northern side too");
    v("codes", codes, "ICAO code letters of the stands from west to east, C or E, repeated as often as needed");
    v("pitch_c_m", pitch_c_m, "width of a stand for code C", {.at_least = 40.5, .at_most = 60});
    v("pitch_e_m", pitch_e_m, "width of a stand for code E", {.at_least = 72.5, .at_most = 100});
    v("pier_width_m", pier_width_m, "from façade to façade", {.at_least = 25, .at_most = 45});
    v("pier_length_m", pier_length_m,
      "from the hall to the pier's head, rounded up to bays of 7.5 m; 0: as the stands "
      "need",
      {.at_least = 0, .at_most = 900});
    v("occupied_share", occupied_share, "probability that an aircraft is on a stand", {.at_least = 0, .at_most = 1});
    v("equipment_density", equipment_density,
      "how much stands around the aircraft: 0 chocks alone, 1 a usual turnaround, 2 all there is room for",
      {.at_least = 0, .at_most = 2});
    v("with_hall", with_hall, "the main hall at the pier's western end");
    paving.visit(v);
  }
};

}  // namespace tarmac::scenes
