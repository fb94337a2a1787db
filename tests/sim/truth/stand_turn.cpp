#include "tests/sim/truth/stand_turn.h"

namespace tarmac::tests {

core::ConfigNode stand_turn_motion() {
  return core::ConfigNode::load(TARMAC_SCENARIOS "/stand-turn.yaml").child("motion");
}

}  // namespace tarmac::tests
