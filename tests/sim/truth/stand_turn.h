/// The motion of the stand-turn scenario: acceleration, hard braking, a tight turn, and a way around the stand.
#pragma once

#include <memory>

#include "core/config.h"
#include "sim/truth/motion.h"

namespace tarmac::tests {

inline constexpr const char* stand_turn_motion = R"(
kind: drive
start: {x_m: -60, y_m: -30, heading_deg: 0}
rest_s: 3
path:
  - {straight_m: 78.2}
  - {turn_deg: 90, radius_m: 5.5, blend_m: 4.5}
  - {straight_m: 51.9}
  - {turn_deg: 90, radius_m: 6, blend_m: 4.5}
  - {straight_m: 39.4}
  - {turn_deg: 90, radius_m: 6, blend_m: 4.5}
  - {straight_m: 51.4}
  - {turn_deg: 90, radius_m: 6, blend_m: 4.5}
  - {straight_m: 6}
speed:
  - {to_m_s: 7, peak_m_s2: 1.8}
  - {at_m: 69, to_m_s: 2.5, peak_m_s2: 5.5}
  - {at_m: 91, to_m_s: 6.8, peak_m_s2: 1.8}
  - {by_m: 142, to_m_s: 3, peak_m_s2: 1.8}
  - {at_m: 156, to_m_s: 6.8, peak_m_s2: 1.8}
  - {by_m: 195.5, to_m_s: 3, peak_m_s2: 2.2}
  - {at_m: 209.5, to_m_s: 7, peak_m_s2: 1.8}
  - {by_m: 261, to_m_s: 3, peak_m_s2: 1.8}
stop_peak_m_s2: 2
)";

/// Long drives take a second to build: tests that need no more ask for their first seconds only.
inline std::shared_ptr<const core::SmoothTrajectory> stand_turn(
    double duration_s, std::uint64_t seed = 1, std::shared_ptr<const scenes::Ground> ground = nullptr) {
  return sim::truth::make_motion(core::ConfigNode::parse(stand_turn_motion, "stand-turn.yaml"),
                                 core::duration_from_s(duration_s), std::move(ground), seed);
}

}  // namespace tarmac::tests
