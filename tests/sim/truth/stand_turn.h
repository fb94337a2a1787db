/// The motion of scenarios/stand-turn.yaml: acceleration, hard braking, a tight turn, and a way around the stand.
#pragma once

#include <memory>

#include "core/config.h"
#include "sim/truth/motion.h"

namespace tarmac::tests {

/// The motion block of the shipped scenario.
core::ConfigNode stand_turn_motion();

/// Long drives take a second to build: tests that need no more ask for their first seconds only.
inline std::shared_ptr<const core::SmoothTrajectory> stand_turn(
    double duration_s, std::uint64_t seed = 1, std::shared_ptr<const scenes::Ground> ground = nullptr) {
  return sim::truth::make_motion(stand_turn_motion(),
                                 core::duration_from_s(duration_s), std::move(ground), seed);
}

}  // namespace tarmac::tests
