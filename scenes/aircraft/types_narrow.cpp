#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

namespace {

// Airbus A320 with sharklets. Sources: Airbus airport-planning document (June 2024) for lengths, span, height, gear,
// doors and sill; fuselage stations measured from a public model; thickness ratios, window and hold-door sizes and the
// fin's sweep are estimates.
AircraftType a320() {
  AircraftType t{};
  t.name = "a320";
  t.summary = "Airbus A320 with sharklets";
  t.icao_code = 'C';
  t.length_m = 37.57;
  t.span_m = 35.80;
  t.height_min_m = 11.83;
  t.height_max_m = 12.08;
  t.floor_z_m = 3.43;
  t.belly_clearance_m = 1.64;
  t.stations = {{0.1, 0.08, -0.62, 0.30}, {1.0, 0.69, -1.14, 0.94}, {2.0, 1.48, -1.38, 1.40}, {3.0, 2.02, -1.50, 1.68},
                {4.0, 2.28, -1.54, 1.86}, {6.0, 2.49, -1.69, 1.98}, {24., 2.49, -1.69, 1.98}, {28., 2.49, -1.14, 1.79},
                {32., 2.48, -0.48, 1.35}, {35., 2.19, 0.30, 0.82},  {37.57, 1.66, 1.20, 0.22}};
  t.nose_gear = {
      .x_m = 5.07, .half_track_m = 0, .wheel_radius_m = 0.381, .wheel_width_m = 0.22, .wheel_spacing_m = 0.50};
  t.main_gear = {
      {.x_m = 17.71, .half_track_m = 3.795, .wheel_radius_m = 0.584, .wheel_width_m = 0.43, .wheel_spacing_m = 0.927}};
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
  t.device = {.kind = WingTip::sharklet, .rise_m = 2.3, .sweep_deg = 45};
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
}

// Boeing 737-800 with blended winglets. Sources: Boeing D6-58325-7 for lengths, span, height, gear, doors and sills;
// wing and tail plans are approximations good to a few percent, sections follow the laws of fuselage_stations().
AircraftType b737_800() {
  AircraftType t{};
  t.name = "b737-800";
  t.summary = "Boeing 737-800 with blended winglets: flat-bottomed nacelles, dorsal fin";
  t.icao_code = 'C';
  t.length_m = 39.47;
  t.span_m = 35.79;
  t.height_min_m = 12.37;
  t.height_max_m = 12.62;
  t.floor_z_m = 2.665;
  t.belly_clearance_m = 1.4;
  t.stations = fuselage_stations({.length_m = 39.47,
                                  .width_m = 3.76,
                                  .height_m = 4.01,
                                  .top_m = 2.82,
                                  .nose_length_m = 5.6,
                                  .tail_length_m = 11.0,
                                  .nose_tip = 0.36,
                                  .forehead = 1.1,
                                  .tail_tip = 0.78});
  t.nose_gear = {
      .x_m = 4.09, .half_track_m = 0, .wheel_radius_m = 0.34, .wheel_width_m = 0.20, .wheel_spacing_m = 0.43};
  t.main_gear = {
      {.x_m = 19.69, .half_track_m = 2.86, .wheel_radius_m = 0.56, .wheel_width_m = 0.42, .wheel_spacing_m = 0.86}};
  t.doors = {{.x_m = 5.03, .width_m = 0.86, .height_m = 1.83, .sill_m = 0, .side = 0},
             {.x_m = 31.88, .width_m = 0.76, .height_m = 1.83, .sill_m = 0, .side = 0},
             {.x_m = 9.2, .width_m = 1.22, .height_m = 0.72, .sill_m = -0.95, .side = -1},
             {.x_m = 26.6, .width_m = 1.22, .height_m = 0.72, .sill_m = -0.95, .side = -1}};
  t.windows = {.from_x_m = 6.3, .to_x_m = 30.6, .pitch_m = 0.508, .width_m = 0.25, .low_m = 0.90, .high_m = 1.25};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 0.95, .high_m = 1.62, .panes_length_m = 1.0, .side_panes = 2});
  t.wing = {.root_le_x_m = 14.2,
            .root_y_m = 1.88,
            .root_chord_m = 7.4,
            .kink_y_m = 5.4,
            .kink_chord_m = 4.3,
            .tip_y_m = 17.16,
            .tip_chord_m = 1.25,
            .le_sweep_deg = 27,
            .dihedral_deg = 6,
            .root_z_m = 2.1,
            .thickness_root = 0.135,
            .thickness_tip = 0.11};
  t.device = {.kind = WingTip::sharklet, .rise_m = 2.5, .sweep_deg = 52, .bend = 0.85, .tip_chord_share = 0.5};
  t.engines = {
      {.y_m = 4.83, .lip_x_m = 12.0, .length_m = 4.1, .radius_m = 0.99, .ground_gap_m = 0.48, .flat_bottom = 0.86}};
  t.tailplane = {.root_le_x_m = 33.1,
                 .root_y_m = 0,
                 .root_chord_m = 3.9,
                 .kink_y_m = 7.175,
                 .kink_chord_m = 1.3,
                 .tip_y_m = 7.175,
                 .tip_chord_m = 1.3,
                 .le_sweep_deg = 32,
                 .dihedral_deg = 7,
                 .root_z_m = 4.7,
                 .thickness_root = 0.11,
                 .thickness_tip = 0.10};
  t.fin = {.height_m = 6.9,
           .root_chord_m = 6.4,
           .tip_chord_m = 2.2,
           .le_x_m = 29.9,
           .le_sweep_deg = 37,
           .root_z_m = 5.6,
           .thickness = 0.10,
           .dorsal_length_m = 4.6,
           .dorsal_height_m = 1.35};
  return t;
}

}  // namespace

std::vector<AircraftType> narrow_body_types() {
  return {a320(), b737_800()};
}

}  // namespace tarmac::scenes
