#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

namespace {

// ATR 72-600. Sources: ATR recovery and weight manuals for length, span, gear; fuselage size and the rest approximate;
// the passenger door is aft on the left, the cargo door ahead.
AircraftType atr_72() {
  AircraftType t{};
  t.name = "atr-72";
  t.summary = "ATR 72-600: high wing, T-tail, six-blade propellers, sponsons";
  t.icao_code = 'C';
  t.length_m = 27.166;
  t.span_m = 27.05;
  t.height_min_m = 7.65;
  t.height_max_m = 7.65;
  t.floor_z_m = 1.2;
  t.belly_clearance_m = 0.85;
  t.stations = fuselage_stations({.length_m = 26.3,
                                  .width_m = 2.77,
                                  .height_m = 2.87,
                                  .top_m = 2.5,
                                  .nose_length_m = 4.4,
                                  .tail_length_m = 8.8,
                                  .nose_tip = 0.36,
                                  .forehead = 1.15,
                                  .upsweep = 2.2,
                                  .tail_tip = 0.8,
                                  .tail_tip_half_width_m = 0.12,
                                  .tail_tip_half_height_m = 0.22});
  t.nose_gear = {
      .x_m = 1.728, .half_track_m = 0, .wheel_radius_m = 0.25, .wheel_width_m = 0.15, .wheel_spacing_m = 0.36};
  t.main_gear = {
      {.x_m = 12.5, .half_track_m = 2.05, .wheel_radius_m = 0.43, .wheel_width_m = 0.24, .wheel_spacing_m = 0.42}};
  t.doors = {{.x_m = 20.5, .width_m = 0.72, .height_m = 1.75, .sill_m = 0, .side = 1},
             {.x_m = 3.75, .width_m = 1.27, .height_m = 1.53, .sill_m = 0, .side = 1},
             {.x_m = 21.6, .width_m = 0.61, .height_m = 1.22, .sill_m = 0, .side = -1}};
  t.windows = {.from_x_m = 5.6, .to_x_m = 19.6, .pitch_m = 0.76, .width_m = 0.26, .low_m = 0.88, .high_m = 1.24};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 0.78, .high_m = 1.35, .panes_length_m = 0.75, .side_panes = 2});
  t.wing = {.root_le_x_m = 10.95,
            .root_y_m = 1.4,
            .root_chord_m = 2.6,
            .kink_y_m = 5.4,
            .kink_chord_m = 2.4,
            .tip_y_m = 13.525,
            .tip_chord_m = 1.4,
            .le_sweep_deg = 3,
            .dihedral_deg = 0,
            .root_z_m = 3.86,
            .thickness_root = 0.18,
            .thickness_tip = 0.13};
  t.high_wing = true;
  t.engines = {{.y_m = 4.05,
                .lip_x_m = 8.4,
                .length_m = 4.2,
                .radius_m = 0.65,
                .ground_gap_m = 1.1,
                .propeller = {.diameter_m = 3.93, .blades = 6}}};
  t.tailplane = {.root_le_x_m = 25.0,
                 .root_y_m = 0,
                 .root_chord_m = 1.9,
                 .kink_y_m = 3.65,
                 .kink_chord_m = 1.2,
                 .tip_y_m = 3.65,
                 .tip_chord_m = 1.2,
                 .le_sweep_deg = 8,
                 .dihedral_deg = 0,
                 .root_z_m = 7.33,
                 .thickness_root = 0.12,
                 .thickness_tip = 0.1};
  t.t_tail = true;
  t.fin = {.height_m = 4.2,
           .root_chord_m = 4.0,
           .tip_chord_m = 2.4,
           .le_x_m = 22.3,
           .le_sweep_deg = 28,
           .root_z_m = 3.2,
           .thickness = 0.11,
           .dorsal_length_m = 3.2,
           .dorsal_height_m = 0.75};
  t.sponson = {.from_x_m = 9.6, .to_x_m = 15.4, .half_width_m = 1.85, .low_z_m = 0.62, .high_z_m = 1.55};
  return t;
}

// Embraer E190. Sources: Embraer APM-1901 for lengths, span, height, gear, sills; wing and tail plans approximate.
AircraftType e190() {
  AircraftType t{};
  t.name = "e190";
  t.summary = "Embraer E190: small winglets";
  t.icao_code = 'C';
  t.length_m = 36.24;
  t.span_m = 28.72;
  t.height_min_m = 10.33;
  t.height_max_m = 10.57;
  t.floor_z_m = 2.605;
  t.belly_clearance_m = 1.6;
  t.stations = fuselage_stations({.length_m = 36.24,
                                  .width_m = 3.01,
                                  .height_m = 3.35,
                                  .top_m = 2.495,
                                  .nose_length_m = 4.6,
                                  .tail_length_m = 9.2,
                                  .nose_tip = 0.36,
                                  .forehead = 0.95,
                                  .tail_tip = 0.76});
  t.nose_gear = {.x_m = 4.13, .half_track_m = 0, .wheel_radius_m = 0.3, .wheel_width_m = 0.19, .wheel_spacing_m = 0.4};
  t.main_gear = {
      {.x_m = 17.96, .half_track_m = 2.97, .wheel_radius_m = 0.5, .wheel_width_m = 0.38, .wheel_spacing_m = 0.8}};
  t.doors = {{.x_m = 5.14, .width_m = 0.75, .height_m = 1.8, .sill_m = 0, .side = 0},
             {.x_m = 31.0, .width_m = 0.7, .height_m = 1.8, .sill_m = 0, .side = 0},
             {.x_m = 9.4, .width_m = 1.1, .height_m = 0.42, .sill_m = -0.68, .side = -1},
             {.x_m = 26.0, .width_m = 1.0, .height_m = 0.42, .sill_m = -0.68, .side = -1}};
  t.windows = {.from_x_m = 6.3, .to_x_m = 29.8, .pitch_m = 0.81, .width_m = 0.29, .low_m = 0.9, .high_m = 1.28};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 0.88, .high_m = 1.52, .panes_length_m = 0.9, .side_panes = 2});
  t.wing = {.root_le_x_m = 13.5,
            .root_y_m = 1.5,
            .root_chord_m = 5.6,
            .kink_y_m = 4.6,
            .kink_chord_m = 3.4,
            .tip_y_m = 13.9,
            .tip_chord_m = 1.2,
            .le_sweep_deg = 25,
            .dihedral_deg = 5,
            .root_z_m = 2.2,
            .thickness_root = 0.14,
            .thickness_tip = 0.11};
  t.device = {.kind = WingTip::sharklet, .rise_m = 1.4, .sweep_deg = 50, .bend = 0.7, .tip_chord_share = 0.45};
  t.engines = {{.y_m = 4.9, .lip_x_m = 11.8, .length_m = 3.8, .radius_m = 0.85, .ground_gap_m = 0.55}};
  t.tailplane = {.root_le_x_m = 30.9,
                 .root_y_m = 0,
                 .root_chord_m = 3.0,
                 .kink_y_m = 6.05,
                 .kink_chord_m = 1.1,
                 .tip_y_m = 6.05,
                 .tip_chord_m = 1.1,
                 .le_sweep_deg = 32,
                 .dihedral_deg = 7,
                 .root_z_m = 4.5,
                 .thickness_root = 0.11,
                 .thickness_tip = 0.1};
  t.fin = {.height_m = 5.1,
           .root_chord_m = 5.2,
           .tip_chord_m = 2.0,
           .le_x_m = 28.6,
           .le_sweep_deg = 38,
           .root_z_m = 5.35,
           .thickness = 0.1,
           .dorsal_length_m = 2.6,
           .dorsal_height_m = 0.6};
  return t;
}

}  // namespace

std::vector<AircraftType> regional_types() {
  return {atr_72(), e190()};
}

}  // namespace tarmac::scenes
