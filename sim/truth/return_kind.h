/// What a LiDAR's point is a return of.
#pragma once

#include <cstdint>

namespace tarmac::sim::truth {

/// Values are written to files: never renumber.
enum class ReturnKind : std::uint8_t {
  surface = 0,      ///< one surface filled the beam
  mixed = 1,        ///< echoes of several surfaces that the pulse is too long to part: the point lies between them
  edge = 2,         ///< one of several echoes that the beam's footprint made
  dirt = 3,         ///< a pane's own return: the dirt on it
  transmitted = 4,  ///< of what stands behind a pane
  ghost = 5,        ///< of what a pane mirrors, placed behind it along the beam
  glint = 6,        ///< a pane seen square on, as a mirror
  retro_halo = 7,   ///< a retro-reflector's light in a beam that does not point at it
  self = 8,         ///< the sensor's own vehicle
  saturated = 9,    ///< a surface too bright for the receiver
  noise = 10,       ///< nothing: the receiver was wrong
};

/// "retro_halo"; throws std::out_of_range for a number that is none.
const char* name_of(ReturnKind kind);

/// The point lies on the world's surface, or between two such within one pulse: metrics that place points in the world
/// count it. False for ghosts, halos, the own vehicle and noise: nothing stands where they are placed.
constexpr bool on_a_surface(ReturnKind kind) {
  return kind != ReturnKind::ghost && kind != ReturnKind::retro_halo && kind != ReturnKind::self &&
         kind != ReturnKind::noise;
}

}  // namespace tarmac::sim::truth
