/// Transport aircraft from their published dimensions. Adding a type: one more table row (types*.cpp); no shape code
/// knows any type's numbers. Frame: origin on the ground below the nose tip, x forward, y left, z up; stations x in the
/// tables count aft from the nose tip. Heights are above the plane on which the wheels stand.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// One fuselage cross-section; top and bottom relative to the cabin floor.
struct FuselageStation {
  double x_m, top_m, bottom_m, half_width_m;
};

struct LandingGear {
  double x_m, half_track_m;  ///< of the leg
  int wheels = 2;            ///< side by side or in rows of two
  double wheel_radius_m, wheel_width_m, wheel_spacing_m;
  double row_spacing_m = 0;  ///< between the axles of a bogie; needed from four wheels on
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

/// What the wing ends in. The span grows from the plan's tip to the type's half span.
enum class WingTip { plain, sharklet, raked, fence };
struct WingDevice {
  WingTip kind = WingTip::plain;
  double rise_m = 0;              ///< sharklet: above the plan's tip; fence: up, and as much down
  double sweep_deg = 0;           ///< of the leading edge along the device
  double bend = 0.75;             ///< sharklet: share of its reach that still follows the wing; small = a sharp corner
  double tip_chord_share = 0.42;  ///< of the chord at the plan's tip
};

struct Propeller {
  double diameter_m = 0;  ///< 0 = none: a fan
  int blades = 0;
};

struct Engine {
  double y_m, lip_x_m, length_m, radius_m, ground_gap_m;
  double flat_bottom = 1;    ///< height of the cowl's lower half over its radius; below 1 it is flattened
  Propeller propeller = {};  ///< ground_gap_m is then below the propeller's disk
};

struct Fin {
  double height_m, root_chord_m, tip_chord_m, le_x_m, le_sweep_deg, root_z_m, thickness;
  double dorsal_length_m = 0, dorsal_height_m = 0;  ///< of the low fin in front of it; 0 = none
};

/// Bulges at the fuselage's sides that take the main gear of a high-wing aircraft; length 0 = none.
struct Sponson {
  double from_x_m = 0, to_x_m = 0, half_width_m = 0, low_z_m = 0, high_z_m = 0;
};

/// The second cabin of a double-decker, relative to the cabin floor; floor 0 = none.
struct UpperDeck {
  double floor_m = 0, door_height_m = 0, window_low_m = 0, window_high_m = 0;
  double windows_from_x_m = 0, windows_to_x_m = 0;
};

struct Door {
  double x_m, width_m, height_m;
  double sill_m;  ///< above the cabin floor; below 0: a hold door; the upper deck's floor: an upper door
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
  std::string name;     ///< kebab-case: "a320"
  std::string summary;  ///< for lists
  char icao_code;       ///< aerodrome reference code letter, by span and gear
  double length_m, span_m;
  double height_min_m, height_max_m;  ///< light to heavy
  double floor_z_m;                   ///< cabin floor = door sill, above ground
  double belly_clearance_m;           ///< of the lowest fairing (not of gear and engines)
  std::vector<FuselageStation> stations;
  LandingGear nose_gear;
  std::vector<LandingGear> main_gear;
  std::vector<Door> doors;  ///< the first is the one a jet bridge serves; hold doors last
  CabinWindows windows;
  CockpitWindows cockpit;
  UpperDeck upper;
  SurfacePlan wing;
  bool high_wing = false;
  WingDevice device;
  std::vector<Engine> engines;  ///< one a side each
  SurfacePlan tailplane;
  bool t_tail = false;
  Fin fin;
  Sponson sponson;
};

/// a320, a350-900, a380, atr-72, b737-800, b777-300er, e190.
std::vector<std::string> aircraft_names();
/// Throws core::InputError, with the nearest known name, for a name that there is not.
const AircraftType& aircraft_type(const std::string& name);
inline const AircraftType& airbus_a320() {
  return aircraft_type("a320");
}

/// With `open_left_door` (index into type.doors) that door is a real opening with a dark cabin behind it, its leaf
/// swung forward along the skin.
Mesh make_aircraft(const AircraftType& type, std::optional<std::size_t> open_left_door = std::nullopt);

/// Where the aircraft stands: on three legs, each on the ground, the nose tip over (nose_x_m, nose_y_m), looking along
/// `heading_rad` (from east, counter-clockwise; north = pi/2).
core::SE3 park(const AircraftType& type, const Ground& ground, double nose_x_m, double nose_y_m, double heading_rad);

/// Middle of a left door's sill on the skin, in world coordinates.
Eigen::Vector3d door_sill_world(const AircraftType& type, const core::SE3& T_world_aircraft, std::size_t door = 0);

/// Half width of the fuselage at station x and height z above ground; 0 above the top and below the bottom.
double fuselage_half_width_m(const AircraftType& type, double x_m, double z_m);

}  // namespace tarmac::scenes
