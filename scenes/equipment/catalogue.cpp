#include <algorithm>

#include "core/config.h"
#include "core/error.h"
#include "scenes/equipment/equipment.h"
#include "scenes/equipment/person.h"
#include "scenes/outdoors/outdoors.h"

namespace tarmac::scenes {

namespace {

// Sizes of the bodies: makers' and operators' figures; containers by their standard.
const std::vector<EquipmentEntry>& entries() {
  using enum Label;
  static const std::vector<EquipmentEntry> all{
      {"apron-bus", "bus between terminal and remote stands, doors on both sides", vehicle, 13.9, 3.0, 3.2, 0,
       add_apron_bus},
      {"baggage-cart", "two-axle cart with roof, pulled in trains", ground_equipment, 3.2, 1.56, 1.98, 1.1,
       add_baggage_cart},
      {"baggage-tractor", "pulls cart trains", vehicle, 3.05, 1.7, 2.05, 0.15, add_baggage_tractor},
      {"belt-loader", "conveyor up to a hold door", ground_equipment, 7.7, 2.05, 3.1, 0.9,
       [](MeshBuilder& b) { add_belt_loader(b, 3.05); }},
      {"catering-truck", "high-lift truck, stowed", vehicle, 8.6, 2.5, 4.0, 0.05, add_catering_truck},
      {"chock", "wheel chock", ground_equipment, 0.2, 0.5, 0.15, 0, add_chock},
      {"cone", "traffic cone with reflecting sleeve", cone, 0.4, 0.4, 0.75, 0, add_traffic_cone},
      {"container-dolly", "dolly with a container", ground_equipment, 3.2, 1.9, 2.15, 1.2,
       [](MeshBuilder& b) { add_container_dolly(b, true); }},
      {"container-loader", "two platforms on scissors, half raised", ground_equipment, 8.5, 3.9, 2.9, 0.02,
       [](MeshBuilder& b) { add_container_loader(b, 1.75); }},
      {"deicer", "de-icing truck, boom folded over the cab", vehicle, 10.5, 2.6, 4.0, 0.40, add_deicer},
      {"fire-tender", "airport fire engine, four axles", vehicle, 12.0, 3.0, 3.75, 0.45, add_fire_tender},
      {"follow-me-car", "car with a chequered board", vehicle, 4.8, 1.9, 1.75, 0.5, add_follow_me_car},
      {"ground-power-unit", "towed generator", ground_equipment, 3.2, 1.9, 2.0, 0.85, add_ground_power_unit},
      {"hatchback", "small car", vehicle, 4.1, 1.76, 1.48, 0.3,
       [](MeshBuilder& b) { add_car(b, CarShape::hatchback, MaterialId::gse_paint_white); }},
      {"hydrant-dispenser", "pumps fuel from a pit", vehicle, 7.5, 2.4, 3.0, 0.40, add_hydrant_dispenser},
      {"lavatory-truck", "waste truck with a servicing platform", vehicle, 7.0, 2.2, 2.8, 0.42, add_lavatory_truck},
      {"marshaller", "person of 1.75 m in high-visibility clothing with two wands", person, 0.27, 0.5, 1.75, 0.5,
       [](MeshBuilder& b) { add_person(b, {}); }},
      {"marshaller-walking", "the same in mid-stride", person, 0.9, 0.5, 1.70, 0.5,
       [](MeshBuilder& b) { add_person(b, {.gait_phase_rad = 1.2, .gait = 1}); }},
      {"passenger-stairs", "truck stairs, sill at 3.4 m", ground_equipment, 5.82, 2.16, 4.4, 0.05,
       [](MeshBuilder& b) { add_passenger_stairs(b); }},
      {"pushback-tractor", "conventional tractor for narrow bodies", vehicle, 6.0, 2.7, 2.35, 0.25,
       [](MeshBuilder& b) { add_pushback_tractor(b, false); }},
      {"pushback-tractor-wide", "conventional tractor for wide bodies", vehicle, 9.5, 3.3, 2.0, 0.25,
       [](MeshBuilder& b) { add_pushback_tractor(b, true); }},
      {"refueller", "fuel truck with its own tank", vehicle, 10.0, 2.5, 3.3, 0.40, add_refueller},
      {"saloon", "car", vehicle, 4.6, 1.82, 1.46, 0.3,
       [](MeshBuilder& b) { add_car(b, CarShape::saloon, MaterialId::car_paint_dark); }},
      {"towbar", "towbar for narrow bodies", ground_equipment, 4.0, 1.02, 0.51, 0.02,
       [](MeshBuilder& b) { add_towbar(b, false); }},
      {"towbar-wide", "towbar for wide bodies", ground_equipment, 5.5, 1.02, 0.51, 0.02,
       [](MeshBuilder& b) { add_towbar(b, true); }},
      {"towbarless-tractor", "lifts the nose wheels on a cradle", vehicle, 8.5, 4.0, 2.2, 0.12, add_towbarless_tractor},
      {"uld", "lower-deck container, AKE", ground_equipment, 2.007, 1.534, 1.626, 0, add_uld},
      {"van", "delivery van", vehicle, 5.3, 2.0, 2.25, 0.3,
       [](MeshBuilder& b) { add_car(b, CarShape::van, MaterialId::gse_paint_white); }},
  };
  return all;
}

}  // namespace

std::span<const EquipmentEntry> equipment() {
  return entries();
}

const EquipmentEntry& equipment_entry(const std::string& name) {
  std::vector<std::string> names;
  for (const EquipmentEntry& entry : entries()) {
    if (name == entry.name) return entry;
    names.emplace_back(entry.name);
  }
  std::string message = "there is no equipment '" + name + "'; known:";
  for (const std::string& known : names) message += " " + known;
  if (const std::string meant = core::did_you_mean(name, names); !meant.empty())
    message += "; did you mean " + meant + "?";
  throw core::InputError(message);
}

Mesh make_equipment(const std::string& name) {
  const EquipmentEntry& entry = equipment_entry(name);
  MeshBuilder b(name);
  entry.add(b);
  return std::move(b).build();
}

}  // namespace tarmac::scenes
