#include "sim/truth/vehicles.h"

namespace tarmac::sim::truth {

namespace {

struct Vehicle {
  const char* name;
  BodyBox box;
  SuspensionOptions suspension;
  VibrationOptions vibration;
};

/// Car and bus from ordinary ranges of vehicle dynamics (Gillespie; Wong). A baggage tractor has no suspension but its
/// tyres: 900 kg per wheel on 800 kN/m swing at 4.75 Hz with 7 % of critical damping. The pushback tractor's figures
/// are an estimate from its mass on large tyres.
const std::vector<Vehicle>& vehicles() {
  static const std::vector<Vehicle> all = {
      {"van", {}, {}, {}},
      {"car",
       {.length_m = 4.5, .width_m = 1.8, .rear_overhang_m = 0.9, .height_m = 1.5},
       {.wheelbase_m = 2.7,
        .track_m = 1.55,
        .centre_height_m = 0.5,
        .heave_hz = 1.25,
        .heave_damping = 0.3,
        .pitch_hz = 1.5,
        .pitch_damping = 0.3,
        .roll_hz = 1.5,
        .roll_damping = 0.25,
        .dive_deg_per_m_s2 = 0.3,
        .lean_deg_per_m_s2 = 0.45},
       {.idle_hz = 26,
        .engine_hz_per_m_s = 2.5,
        .engine_rms_m_s2 = 0.06,
        .engine_rms_deg_s = 0.05,
        .rolling_rms_m_s2 = 0.08,
        .rolling_rms_deg_s = 0.05}},
      {"bus",
       {.length_m = 12, .width_m = 2.55, .rear_overhang_m = 3.4, .height_m = 3.1},
       {.wheelbase_m = 5.9,
        .track_m = 2.05,
        .centre_height_m = 0.9,
        .heave_hz = 1.2,
        .heave_damping = 0.25,
        .pitch_hz = 1.4,
        .pitch_damping = 0.25,
        .roll_hz = 0.95,
        .roll_damping = 0.2,
        .dive_deg_per_m_s2 = 0.25,
        .lean_deg_per_m_s2 = 0.55},
       {.idle_hz = 24,
        .engine_hz_per_m_s = 2,
        .engine_rms_m_s2 = 0.15,
        .engine_rms_deg_s = 0.1,
        .rolling_rms_m_s2 = 0.07,
        .rolling_rms_deg_s = 0.05}},
      {"baggage-tractor",
       {.length_m = 3.05, .width_m = 1.7, .rear_overhang_m = 0.75, .height_m = 2.05},
       {.wheelbase_m = 1.5,
        .track_m = 1.4,
        .centre_height_m = 0.6,
        .heave_hz = 4.75,
        .heave_damping = 0.07,
        .pitch_hz = 5,
        .pitch_damping = 0.07,
        .roll_hz = 4,
        .roll_damping = 0.07,
        .dive_deg_per_m_s2 = 0.1,
        .lean_deg_per_m_s2 = 0.15},
       {.idle_hz = 25,
        .engine_hz_per_m_s = 3.5,
        .engine_rms_m_s2 = 0.2,
        .engine_rms_deg_s = 0.15,
        .rolling_rms_m_s2 = 0.2,
        .rolling_rms_deg_s = 0.15}},
      {"pushback-tractor",
       {.length_m = 6, .width_m = 2.7, .rear_overhang_m = 1.3, .height_m = 2.35},
       {.wheelbase_m = 3.3,
        .track_m = 2.2,
        .centre_height_m = 0.9,
        .heave_hz = 2.7,
        .heave_damping = 0.08,
        .pitch_hz = 3.2,
        .pitch_damping = 0.08,
        .roll_hz = 2.8,
        .roll_damping = 0.08,
        .dive_deg_per_m_s2 = 0.08,
        .lean_deg_per_m_s2 = 0.12},
       {.idle_hz = 24,
        .engine_hz_per_m_s = 4,
        .engine_rms_m_s2 = 0.2,
        .engine_rms_deg_s = 0.1,
        .rolling_rms_m_s2 = 0.12,
        .rolling_rms_deg_s = 0.08}},
  };
  return all;
}

}  // namespace

std::vector<std::string> vehicle_names() {
  std::vector<std::string> names;
  for (const Vehicle& vehicle : vehicles()) names.emplace_back(vehicle.name);
  return names;
}

BodyBox vehicle_box(const std::string& name) {
  for (const Vehicle& vehicle : vehicles())
    if (name == vehicle.name) return vehicle.box;
  return {};
}

void set_vehicle(const std::string& name, SuspensionOptions& suspension, VibrationOptions& vibration) {
  for (const Vehicle& vehicle : vehicles()) {
    if (name != vehicle.name) continue;
    suspension = vehicle.suspension;
    vibration = vehicle.vibration;
  }
}

}  // namespace tarmac::sim::truth
