/// Pallet racking and what lies in it. Frames: x along the rack, y = 0 its front, the rack at y > 0, z = 0 the floor.
#pragma once

#include "scenes/primitives/mesh_builder.h"
#include "scenes/warehouse/options.h"

namespace tarmac::scenes {

/// Upright frames with bracing, and beams at every level but the floor.
void add_racking(MeshBuilder& b, const WarehouseOptions& options);
/// Pallets with loads in the row's places. `row` names the draws.
void add_goods(MeshBuilder& b, const WarehouseOptions& options, int row, std::uint64_t seed);
/// A pallet (1.2 deep along y, 0.8 along x) with its middle at x, y, its foot at z, and a load of `height_m` on it
/// (0: none). `look` in 0..1 chooses the kind of load, `size` in 0..1 how much smaller than the pallet it is.
void add_pallet(MeshBuilder& b, double x_m, double y_m, double z_m, double height_m, double look, double size);
void add_fork_lift(MeshBuilder& b);  ///< 3.4 x 1.15 x 2.2, forks forward; its own frame, origin on the ground

}  // namespace tarmac::scenes
