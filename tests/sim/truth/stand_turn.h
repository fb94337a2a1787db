/// Motions of shipped scenarios; above all that of stand-turn: acceleration, hard braking, a tight turn, and a way
/// around the stand.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/config.h"
#include "sim/truth/motion.h"

namespace tarmac::tests {

/// The motion block of a shipped scenario.
core::ConfigNode shipped_motion(const std::string& scenario);
inline core::ConfigNode stand_turn_motion() {
  return shipped_motion("stand-turn");
}

inline std::shared_ptr<const core::SmoothTrajectory> shipped_drive(
    const std::string& scenario, double duration_s, std::uint64_t seed = 1,
    std::shared_ptr<const scenes::Ground> ground = nullptr) {
  return sim::truth::make_motion(shipped_motion(scenario), core::duration_from_s(duration_s), std::move(ground), seed);
}

/// Long drives take a second to build: tests that need no more ask for their first seconds only.
inline std::shared_ptr<const core::SmoothTrajectory> stand_turn(
    double duration_s, std::uint64_t seed = 1, std::shared_ptr<const scenes::Ground> ground = nullptr) {
  return shipped_drive("stand-turn", duration_s, seed, std::move(ground));
}

}  // namespace tarmac::tests
