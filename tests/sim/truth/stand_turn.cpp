#include "tests/sim/truth/stand_turn.h"

namespace tarmac::tests {

core::ConfigNode shipped_motion(const std::string& scenario) {
  return core::ConfigNode::load(TARMAC_SCENARIOS "/" + scenario + ".yaml").child("motion");
}

}  // namespace tarmac::tests
