/// What a scenario may say of the baggage tunnel: `scene: {kind: baggage-tunnel, ...}`.
#pragma once

#include "core/options.h"

namespace tarmac::scenes {

struct BaggageTunnelOptions {
  double width_m = 5.2;
  double height_m = 3.2;
  double turn_radius_m = 10;
  double ramp_percent = 6;
  double drop_m = 1.6;
  double rise_m = 1;
  double north_leg_m = 34;
  double last_leg_m = 45;
  bool with_junction = true;
  bool with_trays = true;
  bool with_lamps = true;
  bool with_hall = true;
  double hall_clear_m = 4.5;
  double column_pitch_m = 8;
  double column_m = 0.6;
  int carousels = 4;
  int carts = 10;
  double undulation_mm = 2;
  double relief_rms_mm = 0.4;

  void visit(core::OptionVisitor& v) {
    v("width_m", width_m, "of the tunnel", {.at_least = 4.5, .at_most = 6});
    v("height_m", height_m, "of the tunnel", {.at_least = 2.8, .at_most = 3.5});
    v("turn_radius_m", turn_radius_m, "of the two turns' centre line", {.at_least = 8, .at_most = 12});
    v("ramp_percent", ramp_percent, "grade of the ramps", {.at_least = 3, .at_most = 8});
    v("drop_m", drop_m, "height of the ramp down from the hall", {.at_least = 0, .at_most = 4});
    v("rise_m", rise_m, "height of the ramp up in the last leg", {.at_least = 0, .at_most = 2});
    v("north_leg_m", north_leg_m, "straight between the turns", {.at_least = 20, .at_most = 120});
    v("last_leg_m", last_leg_m, "straight after the turns, up to a roller door", {.at_least = 40, .at_most = 150});
    v("with_junction", with_junction, "a side corridor to the west, in the middle of the northern leg");
    v("with_trays", with_trays, "cable trays and pipes below the ceiling");
    v("with_lamps", with_lamps, "lamps on the ceiling");
    v("with_hall", with_hall, "the baggage hall; without it a roller door closes the tunnel's western end");
    v("hall_clear_m", hall_clear_m, "from the hall's floor to its ceiling", {.at_least = 3.6, .at_most = 5.5});
    v("column_pitch_m", column_pitch_m, "of the hall's square column grid", {.at_least = 7.5, .at_most = 9});
    v("column_m", column_m, "edge of a column", {.at_least = 0.5, .at_most = 0.8});
    v("carousels", carousels, "loops of belt in the hall", {.at_least = 0, .at_most = 4});
    v("carts", carts, "baggage carts parked in the hall", {.at_least = 0, .at_most = 10});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the floor", {.at_least = 0, .at_most = 20});
    v("relief_rms_mm", relief_rms_mm, "texture of the floor, root mean square", {.at_least = 0, .at_most = 5});
  }
};

}  // namespace tarmac::scenes
