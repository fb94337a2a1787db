#include "scenes/materials/materials.h"

#include <stdexcept>

namespace tarmac::scenes {

namespace {

struct Row {
  MaterialId id;
  Material material;
};

Material pavement(Material m) {
  m.has_relief = true;
  return m;
}

std::vector<Row> ground_rows() {
  using enum MaterialId;
  return {
      {concrete_dry, pavement({"concrete_dry", 0.35, 0.25, 0.04, 0, 0, 0, false, {0.66f, 0.65f, 0.62f}})},
      {asphalt_dry, pavement({"asphalt_dry", 0.15, 0.4, 0.04, 0, 0, 0, false, {0.30f, 0.30f, 0.31f}})},
      {joint_sealant, pavement({"joint_sealant", 0.07, 0, 0.04, 0, 0, 0, false, {0.26f, 0.25f, 0.24f}})},
      {paint_white_marking,
       pavement({"paint_white_marking", 0.65, 0.1, 0.04, 0.2, 0, 0, false, {0.95f, 0.95f, 0.93f}})},
      {paint_yellow_marking,
       pavement({"paint_yellow_marking", 0.6, 0.1, 0.04, 0.2, 0, 0, false, {0.96f, 0.77f, 0.10f}})},
      {paint_red_marking, pavement({"paint_red_marking", 0.5, 0.1, 0.04, 0.2, 0, 0, false, {0.80f, 0.14f, 0.12f}})},
      {paint_black_marking,
       pavement({"paint_black_marking", 0.05, 0.1, 0.04, 0.2, 0, 0, false, {0.13f, 0.13f, 0.13f}})},
      {grass_green, {"grass_green", 0.509, 0.5, 0.04, 0, 0, 0, false, {0.40f, 0.52f, 0.25f}}},
  };
}

std::vector<Row> building_rows() {
  using enum MaterialId;
  return {
      {concrete_wall, {"concrete_wall", 0.35, 0.25, 0.04, 0, 0, 0, false, {0.72f, 0.71f, 0.68f}}},
      {facade_panel, {"facade_panel", 0.45, 0.1, 0.1, 0.15, 0, 0, false, {0.83f, 0.84f, 0.85f}}},
      {facade_panel_dark, {"facade_panel_dark", 0.30, 0.1, 0.1, 0.15, 0, 0, false, {0.34f, 0.38f, 0.43f}}},
      {roller_shutter, {"roller_shutter", 0.25, 0.1, 0.6, 0.25, 0, 0, false, {0.55f, 0.60f, 0.64f}}},
      {interior_wall, {"interior_wall", 0.65, 0, 0.04, 0, 0, 0, false, {0.88f, 0.85f, 0.79f}}},
      {glass_coated_double, {"glass_coated_double", 0.005, 0, 0.2, 0.002, 0, 0.3, false, {0.34f, 0.50f, 0.58f}}},
      {glass_clear_float_pane,
       {"glass_clear_float_pane", 0.005, 0, 0.043, 0.002, 0, 0.918, false, {0.42f, 0.57f, 0.64f}}},
      {galvanised_steel, {"galvanised_steel", 0.25, 0.1, 0.6, 0.25, 0, 0, false, {0.62f, 0.64f, 0.66f}}},
      {painted_steel, {"painted_steel", 0.45, 0, 0.04, 0.15, 0, 0, false, {0.45f, 0.49f, 0.54f}}},
      {bridge_panel, {"bridge_panel", 0.6, 0, 0.04, 0.15, 0, 0, false, {0.90f, 0.90f, 0.88f}}},
      {bellows, {"bellows", 0.05, 0.3, 0.04, 0, 0, 0, false, {0.20f, 0.20f, 0.21f}}},
  };
}

std::vector<Row> aircraft_rows() {
  using enum MaterialId;
  return {
      {aircraft_white_topcoat, {"aircraft_white_topcoat", 0.75, 0, 0.04, 0.07, 0, 0, false, {0.97f, 0.97f, 0.97f}}},
      {aircraft_blue_topcoat, {"aircraft_blue_topcoat", 0.45, 0, 0.04, 0.07, 0, 0, false, {0.10f, 0.27f, 0.56f}}},
      {aircraft_grey, {"aircraft_grey", 0.3, 0, 0.04, 0.07, 0, 0, false, {0.67f, 0.69f, 0.71f}}},
      {polished_aluminium, {"polished_aluminium", 0.03, 0, 0.87, 0.1, 0, 0, false, {0.80f, 0.82f, 0.84f}}},
      {exhaust_metal, {"exhaust_metal", 0.1, 0, 0.55, 0.3, 0, 0, false, {0.37f, 0.35f, 0.34f}}},
      {acrylic_cabin_window, {"acrylic_cabin_window", 0.01, 0, 0.039, 0.005, 0, 0.92, false, {0.13f, 0.16f, 0.20f}}},
      {tyre_rubber, {"tyre_rubber", 0.04, 0.3, 0.04, 0, 0, 0, false, {0.14f, 0.14f, 0.15f}}},
  };
}

std::vector<Row> equipment_rows() {
  using enum MaterialId;
  return {
      {gse_paint_white, {"gse_paint_white", 0.6, 0, 0.04, 0.15, 0, 0, false, {0.93f, 0.93f, 0.91f}}},
      {gse_paint_yellow, {"gse_paint_yellow", 0.6, 0, 0.04, 0.15, 0, 0, false, {0.95f, 0.74f, 0.13f}}},
      {gse_paint_blue, {"gse_paint_blue", 0.45, 0, 0.04, 0.15, 0, 0, false, {0.16f, 0.37f, 0.65f}}},
      {gse_chassis, {"gse_chassis", 0.1, 0.1, 0.04, 0.2, 0, 0, false, {0.24f, 0.25f, 0.27f}}},
      {cart_curtain, {"cart_curtain", 0.45, 0.2, 0.04, 0, 0, 0, false, {0.30f, 0.43f, 0.55f}}},
      {cone_orange, {"cone_orange", 0.6, 0, 0.04, 0, 0, 0, false, {0.95f, 0.40f, 0.10f}}},
      {retro_sheeting_ra1, {"retro_sheeting_ra1", 0.5, 0, 0.04, 0, 190, 0, false, {0.96f, 0.96f, 0.96f}}},
  };
}

/// Along taxiways, runways and in tunnels.
std::vector<Row> airfield_rows() {
  using enum MaterialId;
  return {
      {sign_face_yellow, {"sign_face_yellow", 0.5, 0, 0.04, 0, 155, 0, false, {0.98f, 0.80f, 0.08f}}},
      {sign_face_red, {"sign_face_red", 0.45, 0, 0.04, 0, 120, 0, false, {0.78f, 0.08f, 0.10f}}},
      {sign_face_black, {"sign_face_black", 0.05, 0, 0.04, 0.2, 0, 0, false, {0.10f, 0.10f, 0.11f}}},
      {marker_blue, {"marker_blue", 0.3, 0, 0.04, 0, 60, 0, false, {0.08f, 0.20f, 0.72f}}},
      {light_lens, {"light_lens", 0.1, 0, 0.043, 0.05, 8, 0, false, {0.30f, 0.50f, 0.92f}}},
      {tunnel_concrete, {"tunnel_concrete", 0.35, 0.2, 0.04, 0, 0, 0, false, {0.70f, 0.69f, 0.66f}}},
  };
}

/// Indoors, in towns and in the open country.
std::vector<Row> control_rows() {
  using enum MaterialId;
  return {
      {floor_vinyl, {"floor_vinyl", 0.40, 0, 0.04, 0.2, 0, 0, false, {0.60f, 0.63f, 0.62f}}},
      {wood, {"wood", 0.70, 0.2, 0.04, 0, 0, 0, false, {0.72f, 0.56f, 0.37f}}},
      {cardboard, {"cardboard", 0.60, 0.1, 0.04, 0, 0, 0, false, {0.74f, 0.60f, 0.43f}}},
      {steel_orange, {"steel_orange", 0.50, 0, 0.04, 0.15, 0, 0, false, {0.90f, 0.42f, 0.12f}}},
      {brick, {"brick", 0.35, 0.3, 0.04, 0, 0, 0, false, {0.60f, 0.34f, 0.26f}}},
      {plaster, {"plaster", 0.55, 0.2, 0.04, 0, 0, 0, false, {0.86f, 0.81f, 0.71f}}},
      {car_paint_dark, {"car_paint_dark", 0.12, 0, 0.04, 0.07, 0, 0, false, {0.20f, 0.22f, 0.27f}}},
      {soil, pavement({"soil", 0.30, 0.4, 0.04, 0, 0, 0, false, {0.46f, 0.38f, 0.28f}})},
      {rock, {"rock", 0.30, 0.35, 0.04, 0, 0, 0, false, {0.55f, 0.53f, 0.50f}}},
      {bark, {"bark", 0.35, 0.4, 0.04, 0, 0, 0, false, {0.36f, 0.29f, 0.23f}}},
      {meadow, pavement({"meadow", 0.45, 0.5, 0.04, 0, 0, 0, false, {0.45f, 0.52f, 0.27f}})},
      {foliage, {"foliage", 0.55, 0, 0.04, 0.2, 0, 0, false, {0.29f, 0.43f, 0.19f}}},
  };
}

}  // namespace

std::vector<Material> materials() {
  std::vector<Material> table(static_cast<std::size_t>(MaterialId::count));
  for (const std::vector<Row>& rows : {ground_rows(), building_rows(), aircraft_rows(), equipment_rows(),
                                       airfield_rows(), control_rows()}) {
    for (const Row& row : rows) table[static_cast<std::size_t>(row.id)] = row.material;
  }
  for (const Material& material : table) {
    if (material.name.empty()) throw std::logic_error("materials(): an id has no row");
  }
  return table;
}

}  // namespace tarmac::scenes
