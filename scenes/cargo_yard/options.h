/// What a scenario may say of a cargo yard: `scene: {kind: cargo-yard, ...}`.
#pragma once

#include <string>

#include "scenes/apron/paving_options.h"

namespace tarmac::scenes {

struct CargoYardOptions {
  double shed_length_m = 120;
  double shed_height_m = 14;
  double fill_share = 0.7;
  double stacked_share = 0.35;
  int dolly_trains = 6;
  double truck_share = 0.6;
  bool with_fence = true;
  std::string freighter = "b777-300er";
  PavingOptions paving;

  void visit(core::OptionVisitor& v) {
    v("shed_length_m", shed_length_m, "of the shed and its row of docks", {.at_least = 75, .at_most = 200});
    v("shed_height_m", shed_height_m, "of the shed", {.at_least = 8, .at_most = 20});
    v("fill_share", fill_share, "probability that a place in the racks holds a container",
      {.at_least = 0, .at_most = 1});
    v("stacked_share", stacked_share, "of those, the share with another one on top", {.at_least = 0, .at_most = 1});
    v("dolly_trains", dolly_trains, "trains of dollies with containers, each with a tractor",
      {.at_least = 0, .at_most = 12});
    v("truck_share", truck_share, "probability that a truck stands at a dock behind the fence",
      {.at_least = 0, .at_most = 1});
    v("with_fence", with_fence, "fence between the trucks' yard and the airside");
    v("freighter", freighter, "aircraft on the stand before the yard (tarmac list aircraft); none: an empty stand");
    paving.visit(v);
  }
};

}  // namespace tarmac::scenes
