/// A transport aircraft from its published dimensions. Adding a type: one more table row (types.cpp); no shape code
/// knows any type's numbers. Frame: origin on the ground below the nose tip, x forward, y left, z up; stations x in the
/// tables count aft from the nose tip. Heights are above the plane on which the wheels stand.
#pragma once

#include <string>
#include <vector>

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// One fuselage cross-section; top and bottom relative to the cabin floor.
struct FuselageStation {
  double x_m, top_m, bottom_m, half_width_m;
};

struct LandingGear {
  double x_m, half_track_m;  ///< of the leg
  int wheels = 2;            ///< side by side or in rows of two
  double wheel_radius_m, wheel_width_m, wheel_spacing_m;
};

/// A trapezoidal surface with straight leading edge.
struct SurfacePlan {
  double root_le_x_m, root_y_m, root_chord_m;
  double kink_y_m, kink_chord_m;  ///< kink_y_m = tip_y_m: none
  double tip_y_m, tip_chord_m;
  double le_sweep_deg, dihedral_deg;
  double root_z_m;                       ///< of the leading edge, above ground
  double thickness_root, thickness_tip;  ///< share of chord
};

struct WingDevice {
  std::string kind;  ///< "sharklet" or "none"
  double rise_m = 0, sweep_deg = 0;
};

struct Engine {
  double y_m, lip_x_m, length_m, radius_m, ground_gap_m;
};

struct Fin {
  double height_m, root_chord_m, tip_chord_m, le_x_m, le_sweep_deg, root_z_m, thickness;
};

struct Door {
  double x_m, width_m, height_m;
  double sill_m;  ///< above the cabin floor
  int side;       ///< 1 left, -1 right, 0 both
};

/// Cabin windows: centres every `pitch_m` between two stations, heights above the cabin floor.
struct CabinWindows {
  double from_x_m, to_x_m, pitch_m, width_m, low_m, high_m;
};

/// Flight deck windows; heights above the cabin floor. Panes: windshield (to the centre post), then side panes.
struct CockpitWindows {
  double windshield_from_x_m, windshield_to_x_m, side_to_x_m;
  int side_panes;
  double low_front_m, low_aft_m, high_front_m, high_aft_m;
};

struct AircraftType {
  std::string name;
  double length_m, span_m;
  double height_min_m, height_max_m;  ///< light to heavy
  double floor_z_m;                   ///< cabin floor = door sill, above ground
  std::vector<FuselageStation> stations;
  LandingGear nose_gear;
  std::vector<LandingGear> main_gear;
  std::vector<Door> doors;
  CabinWindows windows;
  CockpitWindows cockpit;
  SurfacePlan wing;
  WingDevice device;
  std::vector<Engine> engines;  ///< one a side each
  SurfacePlan tailplane;
  Fin fin;
};

const AircraftType& airbus_a320();

Mesh make_aircraft(const AircraftType& type);

/// Half width of the fuselage at station x and height z above ground; 0 above the top and below the bottom.
double fuselage_half_width_m(const AircraftType& type, double x_m, double z_m);

// The parts, each adding to the builder in the aircraft's frame.
void add_fuselage(MeshBuilder& b, const AircraftType& type);
void add_wings(MeshBuilder& b, const AircraftType& type);
void add_tail(MeshBuilder& b, const AircraftType& type);
void add_engines(MeshBuilder& b, const AircraftType& type);
void add_gear(MeshBuilder& b, const AircraftType& type);

}  // namespace tarmac::scenes
