/// The parts of a passenger bridge.
#pragma once

#include "scenes/bridge/bridge.h"

namespace tarmac::scenes::bridge {

inline constexpr double pivot_to_door_m = 2.4, rotunda_radius_m = 2.2, floor_slab_m = 0.32;
/// The cab's floor lies this much under the sill, so that the door swings over it.
inline constexpr double floor_below_sill_m = 0.03;
inline constexpr double lip_gap_m = 0.06, canopy_gap_m = 0.02;

/// A straight stretch of bridge; x along, z above its floor. `height_m` and `width_m` are outside.
struct Tunnel {
  core::SE3 T_world_tunnel;
  double length_m, width_m, height_m;
};
/// Floor, roof and walls with a window band of 0.9-2.2 m above the floor, a post every two metres.
void add_tunnel(MeshBuilder& b, const Tunnel& tunnel);

/// Two legs beside the tunnel on a bogie with two wheels; T: origin on the tunnel's floor, x along it.
void add_drive_column(MeshBuilder& b, const core::SE3& T_world_tunnel, double along_m, const Ground& ground);
/// Steps from a landing beside the tunnel down to the apron, along the tunnel.
void add_service_stair(MeshBuilder& b, const core::SE3& T_world_tunnel, double along_m, const Ground& ground);

/// Drum on the pivot, floor with a lip along the skin, walls, roof and canopy at the door.
/// `tunnel_direction_world` leads from the rotunda to the cab.
void add_cab(MeshBuilder& b, const AircraftType& type, std::size_t door, const core::SE3& T_world_aircraft,
             const Eigen::Vector3d& tunnel_direction_world);

}  // namespace tarmac::scenes::bridge
