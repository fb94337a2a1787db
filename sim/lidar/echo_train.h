/// From what the rays of one beam met to the echoes that its receiver can tell apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/truth/return_kind.h"

namespace tarmac::sim::lidar {

using truth::ReturnKind;

/// What one ray met, or what a pane sent back to it from elsewhere.
struct Part {
  double t_m = 0;    ///< of the way out along the ray, folds included
  float signal = 0;  ///< equivalent reflectance times cosine, times the share of the beam's energy that came and went
  float cos_incidence = 1;
  float plane_m = 0;  ///< distance of the surface's plane from the beam's origin: tells one plane from two
  float nx = 0, ny = 0, nz = 0;
  std::uint32_t instance = 0;
  std::uint16_t ray = 0;  ///< of the footprint; 0 = the centre
  ReturnKind kind = ReturnKind::surface;
};

struct Echo {
  double t_m = 0;  ///< mean over its parts by signal
  float signal = 0;
  float cos_incidence = 1;  ///< of the surface that gave the most
  float nx = 0, ny = 0, nz = 0;
  std::uint32_t instance = 0;
  ReturnKind kind = ReturnKind::surface;
};

/// Parts in the order of range are one echo as long as each comes no later than `separation_m` (half of the pulse's
/// way) after the one before, or lies on one plane with it: a slanted wall's answer is long, but one. The echo's range
/// is the mean by signal, so that it leans to the stronger surface; its kind is that of its strongest surface, but
///   mixed  where it joins surfaces more than 5 cm apart that are no plane,
///   edge   where it is a surface, and one of several such echoes.
/// Nearest first. `parts`, of which there must be one, may come back sorted.
void tell_apart(std::vector<Part>& parts, double separation_m, std::vector<Echo>& echoes);

}  // namespace tarmac::sim::lidar
