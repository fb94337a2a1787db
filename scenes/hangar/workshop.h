/// What stands in a hangar besides the aircraft; each in its own frame, x forward (its front), origin on the floor.
#pragma once

#include "scenes/aircraft/aircraft.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

void add_tool_cabinet(MeshBuilder& b);  ///< 0.5 deep, 1.0 wide, 1.95 high, doors to the front
void add_work_bench(MeshBuilder& b);    ///< 0.8 deep, 2.0 wide, with a vice and a rack behind
void add_tool_cart(MeshBuilder& b);     ///< 0.9 x 0.5 x 1.0, drawers
void add_step_ladder(MeshBuilder& b);   ///< 2.6 high, platform on top
void add_oil_drum(MeshBuilder& b);      ///< 0.58 across, 0.88 high
void add_wheel_rack(MeshBuilder& b);    ///< 2.4 x 1.0 x 1.7 with four aircraft wheels
void add_engine_stand(MeshBuilder& b);  ///< 4.4 x 2.4 x 2.6 with an engine on it

/// Working platforms along the rear fuselage, at the nose and behind the tail, on legs. In the aircraft's plan frame
/// (origin on the floor below the nose tip, x forward); all parts stay at least 0.2 m off the skin.
void add_docking(MeshBuilder& b, const AircraftType& type);

}  // namespace tarmac::scenes
