#include "scenes/apron/turnaround.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"
#include "scenes/equipment/person.h"

namespace tarmac::scenes {

namespace {

constexpr double pi = std::numbers::pi, quarter = pi / 2;
using enum Label;

constexpr double belt_loader_half_m = 3.85, container_loader_half_m = 4.25;

/// One turnaround being put up. Stand frame: x right of the aircraft, y forward from its nose.
class Crew {
 public:
  Crew(Props& props, const Turnaround& t, const core::RandomStream& random) : props_(props), t_(t), random_(random) {}

  void put(const std::string& name, Label label, const Props::Build& build, double x, double y, double yaw) {
    props_.stand(name, label, build, t_.frame, x, y, yaw);
  }
  /// Whether an item that is there with probability `usual` at density 1 is there now.
  bool comes(double usual) { return draw() < usual * t_.density; }
  /// Uniform in (-1, 1).
  double jitter() { return 2 * draw() - 1; }

  void chocks_and_cones(const AircraftType& type);
  void hold(const AircraftType& type);
  void train(double x, double y, int carts);
  void containers(double x, double y, int dollies);
  void fuel(const AircraftType& type);
  void nose(const AircraftType& type);
  void passengers(const AircraftType& type);
  void staging();

 private:
  double draw() { return random_.uniform(t_.stand, next_++); }
  void chock(const LandingGear& gear, double x);
  void cone(double x, double y) {
    const double dx = jitter(), dy = jitter(), turn = draw();  // one after the other: arguments have no order
    put("cone", Label::cone, add_traffic_cone, x + 0.15 * dx, y + 0.15 * dy, pi * turn);
  }
  /// Where the equipment that serves the holds ends, right of the aircraft.
  double loader_tail_m_ = 10;

  Props& props_;
  const Turnaround& t_;
  const core::RandomStream& random_;
  std::uint32_t next_ = 0;
};

double widest_half_m(const AircraftType& type) {
  double half = 0;
  for (const FuselageStation& station : type.stations) half = std::max(half, station.half_width_m);
  return half;
}

/// Of the fuselage beside `reach_m` either side of station `x_m`, between two heights.
double widest_half_m(const AircraftType& type, double x_m, double reach_m, double low_z_m, double high_z_m) {
  constexpr int steps = 8;
  double half = 0;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      half = std::max(half, fuselage_half_width_m(type, x_m + reach_m * (2.0 * i / steps - 1),
                                                  low_z_m + (high_z_m - low_z_m) * j / steps));
    }
  }
  return half;
}

double leading_edge_m(const AircraftType& type, double y_m) {
  return type.wing.root_le_x_m + (y_m - type.wing.root_y_m) * std::tan(type.wing.le_sweep_deg * pi / 180);
}

/// Whether a loader at a hold door on the right side stands across `y_m`.
bool loader_comes_near(const AircraftType& type, double y_m) {
  constexpr double half_width_m = 2.4;
  return std::ranges::any_of(type.doors, [&](const Door& door) {
    return door.sill_m < 0 && door.side == -1 && std::abs(-door.x_m - y_m) < half_width_m;
  });
}

bool is_wide(const AircraftType& type) {
  return type.length_m > 55;
}

void Crew::chock(const LandingGear& gear, double x) {
  const int rows = std::max(1, gear.wheels / 2);
  const double reach = 0.5 * (rows - 1) * gear.row_spacing_m + 0.8 * gear.wheel_radius_m + 0.1;
  for (const double side : {-1.0, 1.0}) put("chock", ground_equipment, add_chock, x, -gear.x_m + side * reach, quarter);
}

void Crew::chocks_and_cones(const AircraftType& type) {
  chock(type.nose_gear, 0);
  for (const LandingGear& gear : type.main_gear) {
    chock(gear, gear.half_track_m);
    chock(gear, -gear.half_track_m);
  }
  if (t_.density <= 0) return;
  const double tip = type.span_m / 2 + 0.6, tip_y = -leading_edge_m(type, type.wing.tip_y_m) - type.wing.tip_chord_m;
  for (const double side : {-1.0, 1.0}) {
    cone(side * tip, tip_y);
    cone(side * (t_.remote ? 2.4 : 1.6), 2);  // beside the tractor
    for (const Engine& engine : type.engines) {
      const double y = -engine.lip_x_m + 1.5;
      if (side < 0 || !loader_comes_near(type, y)) cone(side * engine.y_m, y);
    }
  }
  cone(0, -type.length_m - 2);
}

/// Loaders at the hold doors on the right side, the tops of their belts or platforms just below the sills.
void Crew::hold(const AircraftType& type) {
  for (const Door& door : type.doors) {
    if (door.sill_m >= 0 || door.side != -1) continue;
    const double top = type.floor_z_m + door.sill_m - 0.05, skin = fuselage_half_width_m(type, door.x_m, top);
    const bool wide = is_wide(type), aft = door.x_m > type.length_m / 2;
    const double half = wide ? container_loader_half_m : belt_loader_half_m;
    // Rails end behind the tip; up there, and along the loader's width, the fuselage may be wider.
    const double beside_rail = wide ? widest_half_m(type, door.x_m, 2, top, top + 1.15) - 0.75
                                    : widest_half_m(type, door.x_m, 0.6, top, top + 0.95) - 0.45;
    const double x = std::max(skin + 0.35, beside_rail + 0.1) + half;
    loader_tail_m_ = std::max(loader_tail_m_, x + half);
    if (!comes(0.8)) continue;
    const int top_cm = static_cast<int>(std::lround(100 * top));
    if (wide) {
      put(
          "container_loader_" + std::to_string(top_cm), ground_equipment,
          [&](MeshBuilder& b) { add_container_loader(b, top); }, x, -door.x_m, pi);
      if (aft) containers(loader_tail_m_ + 4, -door.x_m - 2, 4);
    } else {
      put(
          "belt_loader_" + std::to_string(top_cm), ground_equipment,
          [&](MeshBuilder& b) { add_belt_loader(b, std::max(1.3, top)); }, x, -door.x_m, pi);
      if (aft) train(loader_tail_m_ + 3.2, -door.x_m - 1, 3);
    }
  }
}

/// A tractor with carts behind it, one after the other towards -y.
void Crew::train(double x, double y, int carts) {
  if (!comes(0.8)) return;
  put("baggage_tractor", vehicle, add_baggage_tractor, x, y, quarter);
  for (int k = 0; k < carts; ++k) {
    const double aside = jitter(), turn = jitter();
    put("baggage_cart", ground_equipment, add_baggage_cart, x + 0.12 * aside, y - 4.2 - 4.1 * k, quarter + 0.04 * turn);
  }
}

void Crew::containers(double x, double y, int dollies) {
  for (int k = 0; k < dollies; ++k) {
    if (!comes(0.7)) continue;
    const bool loaded = draw() < 0.6;
    const double aside = jitter(), turn = jitter();
    put(
        loaded ? "dolly_with_container" : "dolly", ground_equipment,
        [&](MeshBuilder& b) { add_container_dolly(b, loaded); }, x + 0.12 * aside, y - 4.3 * k, quarter + 0.04 * turn);
  }
}

/// A dispenser ahead of the right wing's leading edge, outboard of the engine.
void Crew::fuel(const AircraftType& type) {
  const Engine& engine = type.engines.back();
  if (engine.propeller.diameter_m > 0 || !comes(0.6)) return;
  const double x = std::max(type.engines.front().y_m + type.engines.front().radius_m + 3.0, loader_tail_m_ + 1.8);
  put("hydrant_dispenser", vehicle, add_hydrant_dispenser, x, -leading_edge_m(type, x) + 4.6, quarter);
}

/// Ground power beside the nose, a catering truck at the first right door.
void Crew::nose(const AircraftType& type) {
  const double half = widest_half_m(type);
  if (comes(0.9)) put("ground_power_unit", ground_equipment, add_ground_power_unit, half + 2.6, 0.4, quarter);
  const Door& door = type.doors.front();
  const bool clear_of_propeller = type.engines.front().propeller.diameter_m <= 0;
  if (clear_of_propeller && comes(0.4)) {
    constexpr double front_m = 4.35;
    const double skin = fuselage_half_width_m(type, door.x_m, type.floor_z_m);
    put("catering_truck", vehicle, add_catering_truck, skin + 0.6 + front_m, -door.x_m, pi);
  }
}

/// Stairs, a bus, people on the way between them, the pushback tractor with its bar.
void Crew::passengers(const AircraftType& type) {
  const Door& door = type.doors.front();
  const double half = widest_half_m(type);
  constexpr double lowest_sill_m = 1.8;  // lower doors have steps of their own
  const double sill_m = type.floor_z_m + door.sill_m, stairs_sill_m = std::max(sill_m - 0.07, lowest_sill_m);
  // The platform's edge is straight and the nose tapers: it ends at the skin where that is widest. Above it the skin
  // bulges out further and the door's leaf hangs ahead of it: the rails end before both, the leaf swings over the
  // floor.
  constexpr double clear_m = 0.06, half_width_m = 0.95, rail_m = 1.05, leaf_m = 0.3;
  const double skin = widest_half_m(type, door.x_m, half_width_m, sill_m - 0.1, sill_m + 0.03);
  const double beside_rail = widest_half_m(type, door.x_m, half_width_m, sill_m, sill_m + rail_m);
  const double stairs_x = -(skin + clear_m + passenger_stairs_front_m(stairs_sill_m));
  if (sill_m > lowest_sill_m) {
    put(
        "passenger_stairs_" + std::to_string(std::lround(100 * sill_m)), ground_equipment,
        [&](MeshBuilder& b) { add_passenger_stairs(b, stairs_sill_m, beside_rail + leaf_m - skin); }, stairs_x,
        -door.x_m, 0);
  }
  const double bus_x = -(half + 13.5);
  const bool bus = comes(0.8);
  if (bus) put("apron_bus", vehicle, add_apron_bus, bus_x, std::min(-4.0, -door.x_m), quarter);
  const int people = static_cast<int>(std::lround(4 * std::min(t_.density, 2.0)));
  const double foot_x = stairs_x + passenger_stairs_back_m(stairs_sill_m),
               way = foot_x - (bus ? bus_x + 2.2 : foot_x - 5);
  for (int k = 0; k < people; ++k) {
    const double share = (k + 0.5 + 0.3 * jitter()) / people;
    const bool walks = k % 2 == 1;
    const PersonPosture posture{.gait_phase_rad = walks ? 0.6 : 0, .gait = walks ? 0.8 : 0};
    const double aside = jitter(), turn = jitter();
    props_.stand_mesh(
        walks ? "person_walking" : "person_standing", person, [&] { return make_person(posture); }, t_.frame,
        foot_x - 0.6 - share * (way - 0.6), -door.x_m + (walks ? -1 : 1) * (0.6 + 0.3 * aside), pi * (1 + 0.2 * turn));
  }
  if (!comes(0.6)) return;
  const bool wide = is_wide(type);
  const double bar = wide ? 5.5 : 4.0, tractor = wide ? 9.5 : 6.0, gear = -type.nose_gear.x_m;
  put(
      wide ? "towbar_wide" : "towbar", ground_equipment, [&](MeshBuilder& b) { add_towbar(b, wide); }, 0,
      gear + 0.5 + bar / 2, quarter);
  put(
      wide ? "pushback_tractor_wide" : "pushback_tractor", vehicle,
      [&](MeshBuilder& b) { add_pushback_tractor(b, wide); }, 0, gear + 0.7 + bar + tractor / 2, -quarter);
}

/// Equipment in the boxes at the stand's right edge, from the nose backwards.
void Crew::staging() {
  const double x = t_.half_width_m - 3.2;
  int place = 0;
  const auto box = [&](const std::string& name, Label label, const Props::Build& build) {
    const double aside = jitter(), turn = jitter();
    put(name, label, build, x + 0.2 * aside, 0.5 - 4.4 * place++, quarter + 0.05 * turn);
  };
  if (comes(0.5)) box("baggage_tractor", vehicle, add_baggage_tractor);
  for (int k = 0; k < 3; ++k) {
    if (comes(0.5)) box("baggage_cart", ground_equipment, add_baggage_cart);
  }
}

}  // namespace

void add_turnaround(Props& props, const AircraftType& type, const Turnaround& turnaround,
                    const core::RandomStream& random) {
  Crew crew(props, turnaround, random);
  crew.chocks_and_cones(type);
  crew.hold(type);
  crew.fuel(type);
  crew.nose(type);
  if (turnaround.remote) crew.passengers(type);
  crew.staging();
}

void add_empty_stand(Props& props, const Turnaround& turnaround, const core::RandomStream& random) {
  Crew crew(props, turnaround, random);
  crew.staging();
  crew.containers(turnaround.half_width_m - 6.5, -3, 4);
  crew.train(-turnaround.half_width_m + 7, -12, 3);
}

}  // namespace tarmac::scenes
