/// Where things stand: the one place for the stand's coordinates. World: x east, y north [m]; README.md has the
/// picture.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tarmac::scenes::layout {

// Pavement (the slab grid covers at least this).
inline constexpr double apron_west_m = -150, apron_east_m = 150, apron_south_m = -105, apron_north_m = 52.5;

// Terminal: the glass of the boarding level stands at facade_y_m, columns in front of the recessed apron level.
inline constexpr double terminal_west_m = -112.5, terminal_east_m = 112.5;
inline constexpr double facade_y_m = 46.5, terminal_back_y_m = 62;
inline constexpr double boarding_floor_z_m = 5.0;  ///< above the ground in front of the terminal

// The stand: the aircraft's centre line is x = 0, its nose points north.
inline constexpr double nose_y_m = 30;
inline constexpr double neighbour_west_x_m = -62, neighbour_east_x_m = 60;

// Jet bridge.
inline constexpr double rotunda_x_m = -24, rotunda_y_m = 31;

// Roads run east-west; traffic keeps left, lanes are lane_width_m wide.
inline constexpr double lane_width_m = 4.5;
inline constexpr double tail_road_centre_y_m = -32.25;  ///< lanes at y = -30 (eastbound) and -34.5 (westbound)
inline constexpr double head_road_centre_y_m = 40.25;   ///< lanes at y = 38 (westbound) and 42.5 (eastbound)

// The drive: a 4 m wide corridor that stays free of everything static from 0.15 m to 4.2 m above the ground.
inline constexpr double corridor_width_m = 4;
inline constexpr double corridor_start_x_m = -60, corridor_end_x_m = 40;
inline constexpr double corridor_south_y_m = -30, corridor_north_y_m = 38;
inline constexpr double corridor_east_x_m = 26, corridor_west_x_m = -30;
inline constexpr double corridor_turn_radius_m = 5.5;
inline constexpr double corridor_clear_height_m = 4.2;

// The tug's lane.
inline constexpr double tug_y_m = -34.5, tug_from_x_m = 100, tug_to_x_m = -100;

/// Centre line of the corridor as a polyline with points at most `step_m` apart: east along the tail-of-stand road, the
/// loop around the aircraft (counter-clockwise, corners rounded with corridor_turn_radius_m), and on to the east along
/// the same road.
std::vector<Eigen::Vector2d> corridor_centre_line(double step_m);

}  // namespace tarmac::scenes::layout
