/// What a scenario may say of the warehouse: `scene: {kind: warehouse, ...}`.
#pragma once

#include "core/options.h"
#include "scenes/paving/paving.h"

namespace tarmac::scenes {

struct WarehouseOptions {
  int aisles = 5;
  double aisle_width_m = 3.4;
  int bays = 24;
  int levels = 4;
  double level_height_m = 1.9;
  double fill = 0.85;
  double load_variation = 1;
  int staged_pallets = 24;
  int docks = 6;
  double column_pitch_m = 11.2;
  double floor_undulation_mm = 3;

  void visit(core::OptionVisitor& v) {
    v("aisles", aisles, "aisles along x, racks on both sides of each", {.at_least = 1, .at_most = 12});
    v("aisle_width_m", aisle_width_m, "between the racks of an aisle", {.at_least = 2.8, .at_most = 8});
    v("bays", bays, "bays of 2.8 m in a row of racking", {.at_least = 2, .at_most = 60});
    v("levels", levels, "of pallets, one upon the other", {.at_least = 1, .at_most = 6});
    v("level_height_m", level_height_m, "from level to level", {.at_least = 1.4, .at_most = 3});
    v("fill", fill, "share of the pallet places that are taken", {.at_least = 0, .at_most = 1});
    v("load_variation", load_variation, "0: all loads alike and exactly in place; 1: sizes and places differ",
      {.at_least = 0, .at_most = 1});
    v("staged_pallets", staged_pallets, "pallets on the floor before the docks", {.at_least = 0, .at_most = 60});
    v("docks", docks, "loading doors in the eastern wall", {.at_least = 0, .at_most = 20});
    v("column_pitch_m", column_pitch_m, "from column to column along x (0: no columns)",
      {.at_least = 0, .at_most = 60});
    v("floor_undulation_mm", floor_undulation_mm, "amplitude of the floor's longest wave",
      {.at_least = 0, .at_most = 5});
  }
  PavingSpec floor() const {
    PavingSpec spec;
    spec.crossfall_percent = 0;
    spec.undulation_mm = floor_undulation_mm;
    spec.stream = "scenes/warehouse";
    return spec;
  }
};

}  // namespace tarmac::scenes
