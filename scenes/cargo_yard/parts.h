/// What belongs to a cargo yard alone.
#pragma once

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Two axles with a cab and a trailer of 13.6 x 2.55 x 4.0; x forward, the trailer's rear door at -kTruckTail_m.
void add_articulated_truck(MeshBuilder& b);
inline constexpr double kTruckTail_m = 8;
/// A rack's cell: rollers on a frame 2.1 x 1.7 x 0.5 on which one container stands.
void add_roller_bed(MeshBuilder& b);
inline constexpr double kRollerBedHeight_m = 0.5;
/// 2.7 m high, from `from_m` to `to_m` along y = const on each side's ground: posts every 3 m, three rails and three
/// wires on slanted arms. The chain-link itself is left out: of a beam it returns a few percent.
void add_fence(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m);
/// Concrete barrier 3.0 x 0.6 x 0.85.
void add_barrier(MeshBuilder& b);

}  // namespace tarmac::scenes
