/// The parts of an aircraft, each adding to the builder in the aircraft's frame.
#pragma once

#include <optional>

#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

void add_fuselage(MeshBuilder& b, const AircraftType& type, std::optional<std::size_t> open_left_door);
void add_wings(MeshBuilder& b, const AircraftType& type);
void add_tail(MeshBuilder& b, const AircraftType& type);
void add_engines(MeshBuilder& b, const AircraftType& type);
void add_gear(MeshBuilder& b, const AircraftType& type);

/// A section of the fuselage, heights above ground. Upper and lower half are half ellipses that meet at the widest line
/// z_wide: both stand upright there, so the skin is smooth.
struct FuselageSection {
  double top_m, bottom_m, half_width_m, z_wide_m;

  /// Angle of height z: -pi/2 at the bottom, 0 at the widest line, pi/2 at the top.
  double angle(double z_m) const;
  Eigen::Vector2d yz(double angle_rad) const;
  double underside_m(double y_m) const;  ///< height of the lower skin
};
FuselageSection fuselage_section(const AircraftType& type, double x_m);

/// What stations are derived from where none are measured.
struct FuselageShape {
  double length_m, width_m, height_m;
  double top_m;  ///< of the constant part, above the cabin floor
  double nose_length_m, tail_length_m;
  double nose_tip = 0.34;  ///< height of the nose tip, as a share of the height
  double forehead = 0.9;   ///< exponent of the crown: larger = the crown rises later
  double upsweep = 1.2;    ///< exponent of the belly along the tail cone: larger = it rises later
  double tail_tip = 0.75;  ///< height of the tail's end, as a share of the height
  double tail_tip_half_width_m = 0.2, tail_tip_half_height_m = 0.25;
};
std::vector<FuselageStation> fuselage_stations(const FuselageShape& shape);
/// Where the crown of the nose reaches a height above the cabin floor [m].
double station_of_crown_m(const std::vector<FuselageStation>& stations, double top_m);

/// Flight deck windows by the height of their edges above the cabin floor; where they begin and end along the nose
/// follows from the crown.
struct CockpitShape {
  double low_m, high_m, panes_length_m;
  int side_panes;
};
CockpitWindows derived_cockpit(const std::vector<FuselageStation>& stations, const CockpitShape& shape);

/// Chord and leading edge of a wing or tailplane over y (left side).
double surface_chord_m(const SurfacePlan& plan, double y_m);
double surface_le_x_m(const SurfacePlan& plan, double y_m);
double surface_le_z_m(const SurfacePlan& plan, double y_m);

/// The tables of types, by file.
std::vector<AircraftType> regional_types();     ///< ATR 72, E190
std::vector<AircraftType> narrow_body_types();  ///< A320, B737-800
std::vector<AircraftType> wide_body_types();    ///< A350-900, A380, B777-300ER

}  // namespace tarmac::scenes
