/// Ground support equipment, each in its own frame: x forward, origin on the ground in the middle of its footprint.
#pragma once

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// A wheel with its axle along y, standing on z = 0 below `x_m, y_m`.
void add_road_wheel(MeshBuilder& b, double x_m, double y_m, double radius_m, double width_m);

void add_baggage_tractor(MeshBuilder& b);  ///< 3.05 x 1.70 x 2.05
void add_baggage_cart(MeshBuilder& b);     ///< deck 3.2 x 1.56, roof 1.98, drawbar forward
/// Body 7.7 x 2.05; the belt rises forward from 1.05 m to `high_end_m` at x = +3.85.
void add_belt_loader(MeshBuilder& b, double high_end_m);
void add_ground_power_unit(MeshBuilder& b);               ///< 3.2 x 1.9 x 2.0
void add_container_dolly(MeshBuilder& b, bool loaded);    ///< 3.2 x 1.9 x 0.51, with an LD3 container when loaded
void add_catering_truck(MeshBuilder& b);                  ///< 8.6 x 2.5 x 4.0
void add_passenger_stairs(MeshBuilder& b);                ///< 8.2 x 2.5, sill 3.4
void add_traffic_cone(MeshBuilder& b);                    ///< 0.75 tall, with a reflecting sleeve
void add_chock(MeshBuilder& b);                           ///< 0.2 x 0.5 x 0.15
void add_lighting_mast(MeshBuilder& b, double height_m);  ///< base block, tapered pole, ring of lamps facing -y

}  // namespace tarmac::scenes
