/// The parts of the stand, each in world coordinates; `z0_m` is the ground's height where the part stands.
#pragma once

#include "scenes/aircraft/aircraft.h"
#include "scenes/paving/pavement.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Lead-in lines, stop bars, stand numbers, safety lines and service roads.
Mesh make_markings(const SlabSurface& slabs);

/// Walls, columns, slabs and roofs, and apart from them the panes (label glass).
struct Terminal {
  Mesh building, glass;
};
Terminal make_terminal(double z0_m);
Mesh make_hangar(double z0_m);      ///< east end of the apron
Mesh make_cargo_shed(double z0_m);  ///< west end
Mesh make_blast_fence(const Ground& ground);

/// Where the aircraft stands: on three legs, each on the ground.
core::SE3 park(const AircraftType& type, const Ground& ground, double nose_x_m, double nose_y_m);
/// Centre of the sill of the first left door, in world coordinates.
Eigen::Vector3d door_sill_world(const AircraftType& type, const core::SE3& T_world_aircraft);
/// Fixed walkway, rotunda, tunnels, drive column, cab with canopy at the first left door, service stair.
Mesh make_jet_bridge(const AircraftType& type, const core::SE3& T_world_aircraft, const Ground& ground);
/// Lowest point of the walkway over the head-of-stand road, above the ground [m].
double bridge_clearance_m(const Ground& ground);

}  // namespace tarmac::scenes
