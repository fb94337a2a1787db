/// The parts of the stand, each in world coordinates; `z0_m` is the ground's height where the part stands.
#pragma once

#include "scenes/bridge/bridge.h"
#include "scenes/buildings/terminal.h"
#include "scenes/paving/pavement.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Lead-in lines, stop bars, stand numbers, safety lines and service roads.
Mesh make_markings(const SlabSurface& slabs);

Terminal make_stand_terminal(double z0_m);
Mesh make_hangar(double z0_m);      ///< east end of the apron
Mesh make_cargo_shed(double z0_m);  ///< west end
Mesh make_blast_fence(const Ground& ground);

/// Rotunda and portal of the stand's jet bridge.
BridgeSite stand_bridge_site(const Ground& ground);

}  // namespace tarmac::scenes
