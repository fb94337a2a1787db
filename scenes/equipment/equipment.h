/// Ground support equipment, each in its own frame: x forward, origin on the ground in the middle of its footprint.
#pragma once

#include <span>
#include <string>

#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// A thing that can be asked for by name.
struct EquipmentEntry {
  const char* name;  ///< kebab-case: "baggage-tractor"
  const char* summary;
  Label label;
  double length_m, width_m, height_m;  ///< of the body
  double attached_m;                   ///< by how much drawbars, mirrors, beacons, pipes and boards may stand out of it
  void (*add)(MeshBuilder& b);
};
std::span<const EquipmentEntry> equipment();
/// Throws core::InputError, with the nearest known name, for a name that there is not.
const EquipmentEntry& equipment_entry(const std::string& name);
Mesh make_equipment(const std::string& name);

/// A wheel with its axle along y, standing on z = 0 below `x_m, y_m`.
void add_road_wheel(MeshBuilder& b, double x_m, double y_m, double radius_m, double width_m);

void add_baggage_tractor(MeshBuilder& b);  ///< 3.05 x 1.70 x 2.05
void add_baggage_cart(MeshBuilder& b);     ///< deck 3.2 x 1.56, roof 1.98, drawbar forward
/// Body 7.7 x 2.05; the belt rises forward from 1.05 m to `high_end_m` at x = +3.85.
void add_belt_loader(MeshBuilder& b, double high_end_m);
void add_ground_power_unit(MeshBuilder& b);             ///< 3.2 x 1.9 x 2.0
void add_container_dolly(MeshBuilder& b, bool loaded);  ///< 3.2 x 1.9 x 0.51, with an LD3 container when loaded
void add_catering_truck(MeshBuilder& b);                ///< 8.6 x 2.5 x 4.0
/// Steps rise forward to a platform at `sill_m` whose front edge is passenger_stairs_front_m(sill_m) ahead.
/// The rails end `rails_short_m` behind it.
void add_passenger_stairs(MeshBuilder& b, double sill_m = 3.4, double rails_short_m = 0);
double passenger_stairs_front_m(double sill_m);
double passenger_stairs_back_m(double sill_m);         ///< their foot: behind the origin, so negative
void add_refueller(MeshBuilder& b);                    ///< 10.0 x 2.5 x 3.3, tank of the 38 m3 class
void add_hydrant_dispenser(MeshBuilder& b);            ///< 7.5 x 2.4 x 3.0
void add_apron_bus(MeshBuilder& b);                    ///< 13.9 x 3.0 x 3.2, axles 7.1 apart
void add_pushback_tractor(MeshBuilder& b, bool wide);  ///< conventional: 6.0 x 2.7 x 2.35, wide 9.5 x 3.3 x 2.0
void add_towbar(MeshBuilder& b, bool wide);            ///< 4.0 or 5.5 long, on its small wheels
void add_towbarless_tractor(MeshBuilder& b);           ///< 8.5 x 4.0 x 2.2, its cradle at the rear
void add_deicer(MeshBuilder& b);                       ///< 10.5 x 2.6 x 4.0, boom stowed
void add_follow_me_car(MeshBuilder& b);                ///< 4.8 x 1.9 x 1.75 and a board of 0.5
void add_fire_tender(MeshBuilder& b);                  ///< 12.0 x 3.0 x 3.75
void add_lavatory_truck(MeshBuilder& b);               ///< 7.0 x 2.2 x 2.8
void add_container_loader(MeshBuilder& b,
                          double platform_z_m);           ///< 8.5 x 3.9 x 2.9 (rails); main platform at `platform_z_m`
void add_uld(MeshBuilder& b);                             ///< AKE: 2.007 (base 1.562) x 1.534 x 1.626
void add_traffic_cone(MeshBuilder& b);                    ///< 0.75 tall, with a reflecting sleeve
void add_chock(MeshBuilder& b);                           ///< 0.2 x 0.5 x 0.15
void add_lighting_mast(MeshBuilder& b, double height_m);  ///< base block, tapered pole, ring of lamps facing -y

}  // namespace tarmac::scenes
