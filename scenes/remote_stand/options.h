/// What a scenario may say of remote stands: `scene: {kind: remote-stand, ...}`.
#pragma once

#include <string>
#include <vector>

#include "scenes/apron/paving_options.h"

namespace tarmac::scenes {

struct RemoteStandOptions {
  std::vector<std::string> types{"atr-72", "e190", "b737-800", "a350-900"};
  double occupied_share = 1;
  double equipment_density = 1;
  PavingOptions paving;

  void visit(core::OptionVisitor& v) {
    v("types", types,
      "aircraft from west to east, one a stand (tarmac list aircraft); each stand is as wide as the code of its type "
      "asks for");
    v("occupied_share", occupied_share, "probability that the aircraft is there", {.at_least = 0, .at_most = 1});
    v("equipment_density", equipment_density,
      "how much stands around the aircraft: 0 chocks alone, 1 a usual turnaround, 2 all there is room for",
      {.at_least = 0, .at_most = 2});
    paving.visit(v);
  }
};

}  // namespace tarmac::scenes
