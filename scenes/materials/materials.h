/// The materials that scenes are made of. Values for 865-905 nm; sources and how well each is known: README.md here.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace tarmac::scenes {

/// Index into materials(), hence into Scene::materials of every scene that starts from that table.
enum class MaterialId : std::uint16_t {
  concrete_dry,
  asphalt_dry,
  joint_sealant,
  paint_white_marking,
  paint_yellow_marking,
  paint_red_marking,
  paint_black_marking,
  concrete_wall,
  facade_panel,
  facade_panel_dark,
  roller_shutter,
  interior_wall,
  glass_coated_double,
  glass_clear_float_pane,
  galvanised_steel,
  painted_steel,
  bridge_panel,
  bellows,
  aircraft_white_topcoat,
  aircraft_blue_topcoat,
  aircraft_grey,
  polished_aluminium,
  exhaust_metal,
  acrylic_cabin_window,
  tyre_rubber,
  gse_paint_white,
  gse_paint_yellow,
  gse_paint_blue,
  gse_chassis,
  cart_curtain,
  cone_orange,
  retro_sheeting_ra1,
  grass_green,
  sign_face_yellow,
  sign_face_red,
  sign_face_black,
  marker_blue,
  light_lens,
  tunnel_concrete,
  floor_vinyl,
  wood,
  cardboard,
  steel_orange,
  brick,
  plaster,
  car_paint_dark,
  soil,
  rock,
  bark,
  foliage,
  meadow,
  count
};

/// One entry a MaterialId, in its order.
std::vector<Material> materials();

}  // namespace tarmac::scenes
