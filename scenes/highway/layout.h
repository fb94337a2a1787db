/// Cross-section and line of the highway. d counts to the left of the centre line, s along it; traffic keeps right.
#pragma once

#include <vector>

#include "scenes/highway/options.h"
#include "scenes/paths/path_options.h"

namespace tarmac::scenes::highway_layout {

inline constexpr double inner_shoulder_m = 0.75, outer_shoulder_m = 2.75, blend_m = 120;
inline constexpr double verge_m = 5;    ///< from the edge of the asphalt to the foot of the embankment
inline constexpr double far_m = 45;     ///< where the meadow ends
inline constexpr double margin_m = 20;  ///< nothing stands on the first and last metres

inline double inner_edge_m(const HighwayOptions& o) {
  return o.median_m / 2;
}
inline double outer_edge_m(const HighwayOptions& o) {
  return o.median_m / 2 + inner_shoulder_m + o.lanes * o.lane_m + outer_shoulder_m;
}
/// Middle of lane `lane` of the right carriageway, 0 = the leftmost.
inline double lane_d_m(const HighwayOptions& o, int lane) {
  return -(o.median_m / 2 + inner_shoulder_m + (lane + 0.5) * o.lane_m);
}
inline StartOptions start(const HighwayOptions& o) {
  return {.x_m = -o.length_m / 2, .y_m = 0, .heading_deg = 0, .speed_m_s = 0};
}
/// A straight, a bend to the left, a straight, a bend to the right, a straight: straights of equal length.
std::vector<PathPiece> pieces(const HighwayOptions& o);
/// The same for a vehicle that keeps `d_m` to the left of the centre line.
std::vector<PathPiece> pieces_at(const HighwayOptions& o, double d_m);

}  // namespace tarmac::scenes::highway_layout
