/// Nothing may move through something else: actors through the ego vehicle, through each other, through what stands.
#pragma once

#include <string>

#include "core/time.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/truth/body_box.h"

namespace tarmac::sim {

/// Follows everything that moves over [0, end] with steps that nothing can happen in between: from each instant as far
/// as the distance between two bodies lasts at their speeds and accelerations (conservative advancement), bodies being
/// their triangles, the ego vehicle its box; intervals in which not even what they pass meets are left out. Nearer than
/// 2 cm counts as a collision, and so does one that is inside another at the begin (later it would have to come through
/// its surface).
///
/// Actors of one group (a train) are not held against each other. Against what stands, actors are lifted by 15 cm, and
/// ground, paint and plants count as free. The ego vehicle is held against actors only.
/// Throws InputError: which actor, what it meets, when and where, with the line of the scenario that asks for it.
void check_collisions(const scenes::Scene& scene, const core::SmoothTrajectory& ego, const truth::BodyBox& box,
                      core::Time end, const std::string& scenario_name);

}  // namespace tarmac::sim
