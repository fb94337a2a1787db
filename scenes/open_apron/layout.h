/// Where things are on the open apron. World: x east, y north [m].
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tarmac::scenes::open_apron {

// The lane: east along y = 0, a half turn to the right, west along y = -40, a half turn, and on.
inline constexpr double lane_half_length_m = 60, lane_turn_radius_m = 20;
/// Clutter keeps its outline this far from the lane's centre line.
inline constexpr double lane_free_m = 4;

// Slabs at least this far around the lane's loop: beyond what a sensor of 120 m sees from it.
inline constexpr double west_m = -210, east_m = 210, south_m = -172.5, north_m = 135;
inline constexpr double facade_half_length_m = 112.5, facade_depth_m = 15.5;

/// Centre line of the lane, closed, with points at most `step_m` apart.
std::vector<Eigen::Vector2d> lane_centre_line(double step_m);
/// Distance of a point from the centre line [m].
double distance_to_lane_m(const Eigen::Vector2d& p);

}  // namespace tarmac::scenes::open_apron
