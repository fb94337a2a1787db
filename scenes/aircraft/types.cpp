#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

// Airbus A320 with sharklets. Sources: Airbus airport-planning document (June 2024) for lengths, span, height, gear,
// doors and sill; fuselage stations measured from a public model; thickness ratios, window and hold-door sizes and the
// fin's sweep are estimates.
const AircraftType& airbus_a320() {
  static const AircraftType type = [] {
    AircraftType t{};
    t.name = "a320";
    t.length_m = 37.57;
    t.span_m = 35.80;
    t.height_min_m = 11.83;
    t.height_max_m = 12.08;
    t.floor_z_m = 3.43;
    t.stations = {{0.1, 0.08, -0.62, 0.30}, {1.0, 0.69, -1.14, 0.94}, {2.0, 1.48, -1.38, 1.40},
                  {3.0, 2.02, -1.50, 1.68}, {4.0, 2.28, -1.54, 1.86}, {6.0, 2.49, -1.69, 1.98},
                  {24., 2.49, -1.69, 1.98}, {28., 2.49, -1.14, 1.79}, {32., 2.48, -0.48, 1.35},
                  {35., 2.19, 0.30, 0.82},  {37.57, 1.66, 1.20, 0.22}};
    t.nose_gear = {
        .x_m = 5.07, .half_track_m = 0, .wheel_radius_m = 0.381, .wheel_width_m = 0.22, .wheel_spacing_m = 0.50};
    t.main_gear = {{.x_m = 17.71,
                    .half_track_m = 3.795,
                    .wheel_radius_m = 0.584,
                    .wheel_width_m = 0.43,
                    .wheel_spacing_m = 0.927}};
    t.doors = {{.x_m = 5.04, .width_m = 0.81, .height_m = 1.85, .sill_m = 0, .side = 0},
               {.x_m = 29.53, .width_m = 0.81, .height_m = 1.85, .sill_m = 0, .side = 0},
               {.x_m = 8.16, .width_m = 1.82, .height_m = 1.24, .sill_m = -1.40, .side = -1},
               {.x_m = 22.69, .width_m = 1.82, .height_m = 1.23, .sill_m = -1.40, .side = -1}};
    t.windows = {.from_x_m = 6.6, .to_x_m = 28.4, .pitch_m = 0.533, .width_m = 0.25, .low_m = 0.88, .high_m = 1.22};
    t.cockpit = {.windshield_from_x_m = 1.62,
                 .windshield_to_x_m = 2.62,
                 .side_to_x_m = 3.72,
                 .side_panes = 2,
                 .low_front_m = 0.80,
                 .low_aft_m = 1.02,
                 .high_front_m = 1.62,
                 .high_aft_m = 1.44};
    t.wing = {.root_le_x_m = 12.9,
              .root_y_m = 1.975,
              .root_chord_m = 6.07,
              .kink_y_m = 6.45,
              .kink_chord_m = 3.566,
              .tip_y_m = 17.05,
              .tip_chord_m = 1.5,
              .le_sweep_deg = 27.1,
              .dihedral_deg = 5.1,
              .root_z_m = 2.6,
              .thickness_root = 0.135,
              .thickness_tip = 0.10};
    t.device = {.kind = "sharklet", .rise_m = 2.3, .sweep_deg = 45};
    t.engines = {{.y_m = 5.755, .lip_x_m = 11.4, .length_m = 4.9, .radius_m = 1.15, .ground_gap_m = 0.58}};
    t.tailplane = {.root_le_x_m = 32.8,
                   .root_y_m = 0,
                   .root_chord_m = 3.74,
                   .kink_y_m = 6.225,
                   .kink_chord_m = 1.24,
                   .tip_y_m = 6.225,
                   .tip_chord_m = 1.24,
                   .le_sweep_deg = 28,
                   .dihedral_deg = 6,
                   .root_z_m = 5.0,
                   .thickness_root = 0.11,
                   .thickness_tip = 0.10};
    t.fin = {.height_m = 5.87,
             .root_chord_m = 5.44,
             .tip_chord_m = 1.88,
             .le_x_m = 29.6,
             .le_sweep_deg = 40,
             .root_z_m = 6.05,
             .thickness = 0.10};
    return t;
  }();
  return type;
}

Mesh make_aircraft(const AircraftType& type) {
  MeshBuilder b("aircraft_" + type.name);
  add_fuselage(b, type);
  add_wings(b, type);
  add_tail(b, type);
  add_engines(b, type);
  add_gear(b, type);
  return std::move(b).build();
}

}  // namespace tarmac::scenes
