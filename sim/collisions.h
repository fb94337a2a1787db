/// Nothing may move through something else: actors through the ego vehicle, through each other, through what stands.
#pragma once

#include <stdexcept>
#include <string>

#include "core/time.h"
#include "core/trajectory.h"
#include "scenes/scene.h"

namespace tarmac::sim {

/// The ego vehicle as a box in its body frame (x forward, y left, z up; origin over the ground below the rear axle).
struct EgoBox {
  double length_m = 5, width_m = 2, height_m = 2.2;
  double rear_overhang_m = 1;  ///< from the origin to the rear end
};

/// Follows everything that moves over [0, end] with steps that nothing can happen in between: from each instant as far
/// as the distance between two bodies lasts at their speeds and accelerations (conservative advancement), bodies being
/// their triangles, the ego vehicle its box. Nearer than 2 cm counts as a collision.
///
/// Actors of one group (a train) are not held against each other. Against what stands, actors are lifted by 15 cm, and
/// ground, paint and plants count as free. The ego vehicle is held against actors only.
/// Throws InputError: which actor, what it meets, when and where, with the line of the scenario that asks for it.
void check_collisions(const scenes::Scene& scene, const core::SmoothTrajectory& ego, const EgoBox& box, core::Time end,
                      const std::string& scenario_name);

}  // namespace tarmac::sim
