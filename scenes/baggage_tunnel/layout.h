/// Where things are in the baggage tunnel. The hall's doorway is the origin: the hall lies to the west, the tunnel
/// begins eastwards, turns north, and east again.
#pragma once

#include <memory>

#include "scenes/assembly.h"
#include "scenes/baggage_tunnel/options.h"
#include "scenes/paving/section_ground.h"

namespace tarmac::scenes {

struct BaggageTunnelLayout {
  explicit BaggageTunnelLayout(const BaggageTunnelOptions& options);

  double half_m, height_m;                     ///< tunnel
  double wall_m = 0.3;                         ///< thickness of walls and slabs
  CentreLine line;                             ///< of the tunnel, from the doorway to the roller door at its end
  static constexpr double turn_blend_m = 4;    ///< of both turns
  double first_leg_m, turn_m;                  ///< lengths along the line
  double junction_m;                           ///< along the line: middle of the side corridor's mouth
  double side_half_m = 2, side_length_m = 12;  ///< side corridor
  CentreLine side;                             ///< its centre line, from the tunnel's axis to its roller door
  double hall_length_m, hall_half_m;
  static constexpr double ramp_begin_m = 10;  ///< x where the ramp down begins
};

std::shared_ptr<const SectionGround> baggage_ground(const BaggageTunnelOptions& options, std::uint64_t seed);
/// Walls, columns, carousels, carts and doors of the hall.
void add_baggage_hall(Assembly& a, const BaggageTunnelLayout& layout, const BaggageTunnelOptions& options,
                      const Ground& ground, std::uint64_t seed);
/// A closed roller door with its frame, in its own frame: the door in the plane x = 0, facing +x.
void add_roller_door(MeshBuilder& b, double width_m, double height_m);

}  // namespace tarmac::scenes
