/// What a scenario may say of the urban block: `scene: {kind: urban-block, ...}`.
#pragma once

#include "core/options.h"
#include "scenes/paving/paving.h"

namespace tarmac::scenes {

struct UrbanBlockOptions {
  double block_x_m = 80, block_y_m = 60;
  double outlook_m = 45;
  double carriageway_m = 6.5;
  double sidewalk_m = 2.8;
  double kerb_mm = 120;
  double storeys = 4;
  double parked_share = 0.7;
  double tree_pitch_m = 14;
  double lamp_pitch_m = 28;
  double crossfall_percent = 0.6;
  double undulation_mm = 15;
  double relief_rms_mm = 1.5;

  void visit(core::OptionVisitor& v) {
    v("block_x_m", block_x_m, "size of the block in the middle along x", {.at_least = 40, .at_most = 200});
    v("block_y_m", block_y_m, "and along y", {.at_least = 40, .at_most = 200});
    v("outlook_m", outlook_m, "how far the streets go on beyond the four junctions", {.at_least = 25, .at_most = 150});
    v("carriageway_m", carriageway_m, "between the parking lanes of a street", {.at_least = 5.5, .at_most = 14});
    v("sidewalk_m", sidewalk_m, "from the kerb to the houses", {.at_least = 2.2, .at_most = 8});
    v("kerb_mm", kerb_mm, "height of the kerb", {.at_least = 20, .at_most = 250});
    v("storeys", storeys, "of a house, on average", {.at_least = 2, .at_most = 8});
    v("parked_share", parked_share, "share of the parking places that are taken", {.at_least = 0, .at_most = 1});
    v("tree_pitch_m", tree_pitch_m, "from tree to tree along a kerb (0: no trees)", {.at_least = 0, .at_most = 200});
    v("lamp_pitch_m", lamp_pitch_m, "from lamp to lamp along a kerb (0: no lamps)", {.at_least = 0, .at_most = 200});
    v("crossfall_percent", crossfall_percent, "fall of the ground towards the south", {.at_least = -4, .at_most = 4});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the ground", {.at_least = 0, .at_most = 60});
    v("relief_rms_mm", relief_rms_mm, "texture of asphalt, root mean square", {.at_least = 0, .at_most = 10});
  }
  PavingSpec paving() const {
    PavingSpec spec;
    spec.crossfall_percent = crossfall_percent;
    spec.undulation_mm = undulation_mm;
    spec.relief_rms_mm = relief_rms_mm;
    spec.joint_depth_mm = 0;
    spec.stream = "scenes/urban_block";
    return spec;
  }
};

}  // namespace tarmac::scenes
