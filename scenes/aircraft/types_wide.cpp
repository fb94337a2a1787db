#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

namespace {

// Airbus A350-900. Sources: Airbus airport-planning document (July 2025) for lengths, span, height, gear, doors, sills;
// wing and tail plans approximate. The tip curves up over the outer 3 m of the half span.
AircraftType a350_900() {
  AircraftType t{};
  t.name = "a350-900";
  t.summary = "Airbus A350-900: curved wing tips";
  t.icao_code = 'E';
  t.length_m = 66.8;
  t.span_m = 64.75;
  t.height_min_m = 17.14;
  t.height_max_m = 17.47;
  t.floor_z_m = 5.2;
  t.belly_clearance_m = 2.0;
  t.stations = fuselage_stations({.length_m = 66.8,
                                  .width_m = 5.96,
                                  .height_m = 6.09,
                                  .top_m = 3.37,
                                  .nose_length_m = 8.8,
                                  .tail_length_m = 17.5,
                                  .nose_tip = 0.33,
                                  .forehead = 0.85,
                                  .tail_tip = 0.76,
                                  .tail_tip_half_width_m = 0.3,
                                  .tail_tip_half_height_m = 0.4});
  t.nose_gear = {.x_m = 4.63, .half_track_m = 0, .wheel_radius_m = 0.55, .wheel_width_m = 0.4, .wheel_spacing_m = 0.8};
  t.main_gear = {{.x_m = 33.29,
                  .half_track_m = 5.3,
                  .wheels = 4,
                  .wheel_radius_m = 0.7,
                  .wheel_width_m = 0.53,
                  .wheel_spacing_m = 1.73,
                  .row_spacing_m = 2.04}};
  t.doors = {{.x_m = 6.82, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 18.86, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 37.93, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 52.55, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 12.6, .width_m = 2.7, .height_m = 1.55, .sill_m = -2.05, .side = -1},
             {.x_m = 44.5, .width_m = 2.7, .height_m = 1.55, .sill_m = -2.05, .side = -1}};
  t.windows = {.from_x_m = 8.6, .to_x_m = 51.0, .pitch_m = 0.635, .width_m = 0.28, .low_m = 0.95, .high_m = 1.33};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 1.0, .high_m = 1.85, .panes_length_m = 1.9, .side_panes = 3});
  t.wing = {.root_le_x_m = 24.8,
            .root_y_m = 2.98,
            .root_chord_m = 13.6,
            .kink_y_m = 10.0,
            .kink_chord_m = 7.6,
            .tip_y_m = 29.4,
            .tip_chord_m = 2.6,
            .le_sweep_deg = 34,
            .dihedral_deg = 6,
            .root_z_m = 3.6,
            .thickness_root = 0.13,
            .thickness_tip = 0.095};
  t.device = {.kind = WingTip::sharklet, .rise_m = 2.6, .sweep_deg = 58, .bend = 0.8, .tip_chord_share = 0.2};
  t.engines = {{.y_m = 10.5, .lip_x_m = 22.5, .length_m = 7.2, .radius_m = 1.95, .ground_gap_m = 0.7}};
  t.tailplane = {.root_le_x_m = 57.5,
                 .root_y_m = 0,
                 .root_chord_m = 6.3,
                 .kink_y_m = 9.4,
                 .kink_chord_m = 2.1,
                 .tip_y_m = 9.4,
                 .tip_chord_m = 2.1,
                 .le_sweep_deg = 34,
                 .dihedral_deg = 6,
                 .root_z_m = 7.0,
                 .thickness_root = 0.11,
                 .thickness_tip = 0.1};
  t.fin = {.height_m = 9.4,
           .root_chord_m = 10.5,
           .tip_chord_m = 3.8,
           .le_x_m = 52.8,
           .le_sweep_deg = 40,
           .root_z_m = 7.9,
           .thickness = 0.1};
  return t;
}

// Airbus A380-800. Sources: Airbus airport-planning document (December 2025) for lengths, span, height, gear, doors,
// sills, wing and tail plans; engine places are estimates.
AircraftType a380() {
  AircraftType t{};
  t.name = "a380";
  t.summary = "Airbus A380-800: two decks, four engines, wing-tip fences";
  t.icao_code = 'F';
  t.length_m = 72.73;
  t.span_m = 79.75;
  t.height_min_m = 24.12;
  t.height_max_m = 24.27;
  t.floor_z_m = 5.23;
  t.belly_clearance_m = 2.38;
  t.stations = fuselage_stations({.length_m = 72.73,
                                  .width_m = 7.14,
                                  .height_m = 8.41,
                                  .top_m = 5.63,
                                  .nose_length_m = 9.5,
                                  .tail_length_m = 19.0,
                                  .nose_tip = 0.28,
                                  .forehead = 0.95,
                                  .tail_tip = 0.68,
                                  .tail_tip_half_width_m = 0.35,
                                  .tail_tip_half_height_m = 0.5});
  t.nose_gear = {.x_m = 4.97, .half_track_m = 0, .wheel_radius_m = 0.62, .wheel_width_m = 0.45, .wheel_spacing_m = 1.0};
  t.main_gear = {{.x_m = 33.58,
                  .half_track_m = 6.23,
                  .wheels = 4,
                  .wheel_radius_m = 0.7,
                  .wheel_width_m = 0.53,
                  .wheel_spacing_m = 1.35,
                  .row_spacing_m = 1.7},
                 {.x_m = 36.85,
                  .half_track_m = 2.63,
                  .wheels = 6,
                  .wheel_radius_m = 0.7,
                  .wheel_width_m = 0.53,
                  .wheel_spacing_m = 1.53,
                  .row_spacing_m = 1.7}};
  t.doors = {{.x_m = 6.32, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 16.5, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 32.5, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 46.8, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 61.4, .width_m = 1.07, .height_m = 1.93, .sill_m = 0, .side = 0},
             {.x_m = 20.94, .width_m = 1.07, .height_m = 1.93, .sill_m = 2.745, .side = 0},
             {.x_m = 35.5, .width_m = 1.07, .height_m = 1.93, .sill_m = 2.745, .side = 0},
             {.x_m = 50.0, .width_m = 1.07, .height_m = 1.93, .sill_m = 2.745, .side = 0},
             {.x_m = 12.0, .width_m = 2.9, .height_m = 1.7, .sill_m = -2.2, .side = -1},
             {.x_m = 54.5, .width_m = 2.9, .height_m = 1.7, .sill_m = -2.2, .side = -1}};
  t.windows = {.from_x_m = 8.4, .to_x_m = 60.0, .pitch_m = 0.635, .width_m = 0.28, .low_m = 0.95, .high_m = 1.33};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 1.75, .high_m = 2.55, .panes_length_m = 2.0, .side_panes = 2});
  t.upper = {.floor_m = 2.745,
             .door_height_m = 1.93,
             .window_low_m = 3.65,
             .window_high_m = 4.02,
             .windows_from_x_m = 13.0,
             .windows_to_x_m = 58.0};
  t.wing = {.root_le_x_m = 27.3,
            .root_y_m = 3.57,
            .root_chord_m = 17.67,
            .kink_y_m = 14.3,
            .kink_chord_m = 11.74,
            .tip_y_m = 39.8,
            .tip_chord_m = 3.98,
            .le_sweep_deg = 36.4,
            .dihedral_deg = 2.3,
            .root_z_m = 3.9,
            .thickness_root = 0.13,
            .thickness_tip = 0.1};
  t.device = {.kind = WingTip::fence, .rise_m = 1.3};
  t.engines = {{.y_m = 14.9, .lip_x_m = 29.8, .length_m = 6.4, .radius_m = 1.72, .ground_gap_m = 1.1},
               {.y_m = 25.65, .lip_x_m = 37.6, .length_m = 6.4, .radius_m = 1.72, .ground_gap_m = 1.9}};
  t.tailplane = {.root_le_x_m = 57.28,
                 .root_y_m = 0,
                 .root_chord_m = 9.0,
                 .kink_y_m = 15.185,
                 .kink_chord_m = 3.72,
                 .tip_y_m = 15.185,
                 .tip_chord_m = 3.72,
                 .le_sweep_deg = 37,
                 .dihedral_deg = 5,
                 .root_z_m = 8.0,
                 .thickness_root = 0.11,
                 .thickness_tip = 0.1};
  t.fin = {.height_m = 14.59,
           .root_chord_m = 14.08,
           .tip_chord_m = 4.4,
           .le_x_m = 53.94,
           .le_sweep_deg = 40,
           .root_z_m = 9.6,
           .thickness = 0.1};
  return t;
}

// Boeing 777-300ER. Sources: Boeing D6-58329-2 for lengths, span, height, gear, doors, sills; wing and tail plans
// approximate. Fin and tailplane stand far enough aft that the tailplane's tips end the aircraft, 0.8 m behind the
// fuselage.
AircraftType b777_300er() {
  AircraftType t{};
  t.name = "b777-300er";
  t.summary = "Boeing 777-300ER: raked wing tips, six-wheel bogies";
  t.icao_code = 'E';
  t.length_m = 73.86;
  t.span_m = 64.8;
  t.height_min_m = 18.24;
  t.height_max_m = 18.85;
  t.floor_z_m = 4.965;
  t.belly_clearance_m = 2.2;
  t.stations = fuselage_stations({.length_m = 73.08,
                                  .width_m = 6.2,
                                  .height_m = 6.2,
                                  .top_m = 3.655,
                                  .nose_length_m = 9.5,
                                  .tail_length_m = 20,
                                  .nose_tip = 0.34,
                                  .forehead = 1.0,
                                  .tail_tip = 0.72,
                                  .tail_tip_half_width_m = 0.12,
                                  .tail_tip_half_height_m = 0.75});
  t.nose_gear = {.x_m = 5.89, .half_track_m = 0, .wheel_radius_m = 0.6, .wheel_width_m = 0.43, .wheel_spacing_m = 0.95};
  t.main_gear = {{.x_m = 37.11,
                  .half_track_m = 5.485,
                  .wheels = 6,
                  .wheel_radius_m = 0.67,
                  .wheel_width_m = 0.53,
                  .wheel_spacing_m = 1.4,
                  .row_spacing_m = 1.45}};
  t.doors = {{.x_m = 6.74, .width_m = 1.07, .height_m = 1.88, .sill_m = 0, .side = 0},
             {.x_m = 17.07, .width_m = 1.07, .height_m = 1.88, .sill_m = 0, .side = 0},
             {.x_m = 32.92, .width_m = 1.07, .height_m = 1.88, .sill_m = 0, .side = 0},
             {.x_m = 46.46, .width_m = 1.07, .height_m = 1.88, .sill_m = 0, .side = 0},
             {.x_m = 59.67, .width_m = 1.07, .height_m = 1.88, .sill_m = 0, .side = 0},
             {.x_m = 12.2, .width_m = 2.7, .height_m = 1.6, .sill_m = -2.0, .side = -1},
             {.x_m = 52.5, .width_m = 2.7, .height_m = 1.6, .sill_m = -2.0, .side = -1}};
  t.windows = {.from_x_m = 8.5, .to_x_m = 58.0, .pitch_m = 0.533, .width_m = 0.27, .low_m = 0.95, .high_m = 1.33};
  t.cockpit = derived_cockpit(t.stations, {.low_m = 1.0, .high_m = 1.8, .panes_length_m = 1.7, .side_panes = 2});
  t.wing = {.root_le_x_m = 26.0,
            .root_y_m = 3.1,
            .root_chord_m = 14.0,
            .kink_y_m = 10.8,
            .kink_chord_m = 8.2,
            .tip_y_m = 29.9,
            .tip_chord_m = 2.9,
            .le_sweep_deg = 33,
            .dihedral_deg = 6,
            .root_z_m = 3.6,
            .thickness_root = 0.13,
            .thickness_tip = 0.1};
  t.device = {.kind = WingTip::raked, .sweep_deg = 56, .tip_chord_share = 0.25};
  t.engines = {{.y_m = 9.65, .lip_x_m = 23.5, .length_m = 7.3, .radius_m = 2.05, .ground_gap_m = 0.9}};
  t.tailplane = {.root_le_x_m = 63.83,
                 .root_y_m = 0,
                 .root_chord_m = 7.4,
                 .kink_y_m = 10.75,
                 .kink_chord_m = 2.5,
                 .tip_y_m = 10.75,
                 .tip_chord_m = 2.5,
                 .le_sweep_deg = 35,
                 .dihedral_deg = 7,
                 .root_z_m = 7.2,
                 .thickness_root = 0.11,
                 .thickness_tip = 0.1};
  t.fin = {.height_m = 9.95,
           .root_chord_m = 11.5,
           .tip_chord_m = 4.0,
           .le_x_m = 57.4,
           .le_sweep_deg = 41,
           .root_z_m = 8.6,
           .thickness = 0.1};
  return t;
}

}  // namespace

std::vector<AircraftType> wide_body_types() {
  return {a350_900(), a380(), b777_300er()};
}

}  // namespace tarmac::scenes
