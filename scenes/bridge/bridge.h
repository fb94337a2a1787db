/// An apron-drive passenger bridge from a terminal to a door of any aircraft.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "scenes/aircraft/aircraft.h"
#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// What is built in: where the bridge turns, and where its fixed walkway joins the building. World coordinates [m].
struct BridgeSite {
  Eigen::Vector2d rotunda_m;   ///< axis of the rotunda
  Eigen::Vector2d terminal_m;  ///< middle of the walkway's portal in the façade
  double floor_z_m = 0;        ///< floor of rotunda and walkway, world z
};

/// Limits of a three-tunnel apron-drive bridge (makers' sell sheet; FAA AC 150/5220-21C for slope).
struct BridgeLimits {
  double reach_min_m = 9.85, reach_max_m = 41.38;  ///< rotunda's axis to the cab's pivot, in plan
  double slope_max = 0.25;                         ///< of the tunnels; 1:12 is what is aimed at
  double swing_max_deg = 87.5;                     ///< of the tunnels from straight on from the fixed walkway
  double cab_turn_max_deg = 92.5;                  ///< of the cab from straight on from the tunnels
};

/// How a bridge stands that serves a door.
struct BridgeReach {
  Eigen::Vector3d rotunda_m, pivot_m, sill_m;  ///< world; floors
  double reach_m, slope, swing_deg, cab_turn_deg;
};
/// Throws core::InputError that says which limit the door exceeds, by how much, and what to change.
BridgeReach bridge_reach(const BridgeSite& site, const AircraftType& type, const core::SE3& T_world_aircraft,
                         std::size_t door = 0, const BridgeLimits& limits = {});

/// Fixed walkway, rotunda, tunnels, drive column, service stair, and the cab with its canopy at the left door `door`,
/// which is to be open (make_aircraft). World coordinates. Throws as bridge_reach does.
Mesh make_jet_bridge(const BridgeSite& site, const AircraftType& type, const core::SE3& T_world_aircraft,
                     const Ground& ground, std::size_t door = 0);

/// Lowest point of the walkway's underside over the ground, between `from` and `to` (shares of the walkway's way from
/// rotunda to terminal) [m].
double walkway_clearance_m(const BridgeSite& site, const Ground& ground, double from = 0, double to = 1);

}  // namespace tarmac::scenes
