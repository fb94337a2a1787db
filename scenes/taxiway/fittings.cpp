#include "scenes/taxiway/fittings.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

/// A lathe whose axis is the vertical; profile x is the height.
void add_upright_lathe(MeshBuilder& b, const std::vector<ProfilePoint>& profile, int segments) {
  core::SE3 upright = core::SE3::Identity();
  upright.linear() = Eigen::AngleAxisd(-std::numbers::pi / 2, Vector3d::UnitY()).toRotationMatrix();
  b.at(upright);
  add_lathe(b, profile, segments);
  b.at(core::SE3::Identity());
}

/// Rows from top to bottom, five bits each: the highest is the left column.
std::array<unsigned, 7> glyph(char c) {
  switch (c) {
    case '0':
      return {0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110};
    case '1':
      return {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110};
    case '2':
      return {0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111};
    case '3':
      return {0b01110, 0b10001, 0b00001, 0b00110, 0b00001, 0b10001, 0b01110};
    case '4':
      return {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010};
    case '5':
      return {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110};
    case '6':
      return {0b01110, 0b10000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110};
    case '7':
      return {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000};
    case '8':
      return {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110};
    case '9':
      return {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00001, 0b01110};
    case 'A':
      return {0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001};
    case 'B':
      return {0b11110, 0b10001, 0b10001, 0b11110, 0b10001, 0b10001, 0b11110};
    case 'C':
      return {0b01110, 0b10001, 0b10000, 0b10000, 0b10000, 0b10001, 0b01110};
    case 'D':
      return {0b11110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b11110};
    case 'E':
      return {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111};
    case 'F':
      return {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b10000};
    case 'G':
      return {0b01110, 0b10001, 0b10000, 0b10111, 0b10001, 0b10001, 0b01110};
    case 'H':
      return {0b10001, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001};
    case 'R':
      return {0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001};
    case 'W':
      return {0b10001, 0b10001, 0b10001, 0b10101, 0b10101, 0b10101, 0b01010};
    case '-':
      return {0, 0, 0, 0b01110, 0, 0, 0};
    case '<':
      return {0b00100, 0b01000, 0b10000, 0b11111, 0b10000, 0b01000, 0b00100};
    case '>':
      return {0b00100, 0b00010, 0b00001, 0b11111, 0b00001, 0b00010, 0b00100};
    default:
      throw std::invalid_argument(std::string("add_sign: no shape for the character '") + c + "'");
  }
}

constexpr double sign_low_m = 0.3, sign_high_m = 0.9, sign_half_depth_m = 0.1;
constexpr double pixel_m = 0.055, glyph_pitch_m = 6 * pixel_m, sheet_m = 0.004;

double panel_width_m(const SignPanel& panel) {
  return glyph_pitch_m * static_cast<double>(panel.text.size()) + 0.2;
}

/// A character on the sign's front; its left edge, as read, is at y = left_m: for who looks along -x, +y is right.
void add_glyph(MeshBuilder& b, char c, double left_m) {
  const std::array<unsigned, 7> rows = glyph(c);
  const double top = 0.5 * (sign_low_m + sign_high_m) + 3.5 * pixel_m, x = sign_half_depth_m + sheet_m;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int column = 0; column < 5;) {
      const auto lit = [&](int k) { return k < 5 && (rows[r] >> (4 - k) & 1U) != 0; };
      int end = column;
      while (lit(end)) ++end;
      if (end > column) {
        const double z = top - pixel_m * static_cast<double>(r);
        add_box(b, {x, left_m + pixel_m * column, z - pixel_m}, {x + sheet_m, left_m + pixel_m * end, z});
      }
      column = std::max(end, column + 1);
    }
  }
}

void add_panel(MeshBuilder& b, const SignPanel& panel, double left_m) {
  const double width = panel_width_m(panel);
  b.use(gse_chassis);
  add_box(b, {-sign_half_depth_m, left_m, sign_low_m}, {sign_half_depth_m, left_m + width - 0.02, sign_high_m});
  const MaterialId face = panel.style == SignStyle::mandatory   ? sign_face_red
                          : panel.style == SignStyle::direction ? sign_face_yellow
                                                                : sign_face_black;
  const MaterialId ink = panel.style == SignStyle::mandatory   ? retro_sheeting_ra1
                         : panel.style == SignStyle::direction ? sign_face_black
                                                               : sign_face_yellow;
  b.use(face);
  add_box(b, {sign_half_depth_m, left_m + 0.02, sign_low_m + 0.03},
          {sign_half_depth_m + sheet_m, left_m + width - 0.04, sign_high_m - 0.03});
  b.use(ink);
  for (std::size_t k = 0; k < panel.text.size(); ++k)
    add_glyph(b, panel.text[k], left_m + 0.1 + pixel_m / 2 + glyph_pitch_m * static_cast<double>(k));
}

}  // namespace

void add_edge_light(MeshBuilder& b, MaterialId lens) {
  b.use(concrete_wall);
  add_upright_lathe(b, {{-0.25, 0.22, concrete_wall}, {0.02, 0.22, concrete_wall}, {0.02, 0, concrete_wall}}, 14);
  add_upright_lathe(b,
                    {{0.015, 0.10, gse_paint_yellow},
                     {0.04, 0.10, gse_paint_yellow},
                     {0.05, 0.03, gse_paint_yellow},
                     {0.17, 0.03, gse_paint_yellow},
                     {0.19, 0.075, gse_paint_yellow},
                     {0.25, 0.08, lens},
                     {0.30, 0.07, lens},
                     {0.34, 0.035, lens},
                     {0.35, 0, lens}},
                    12);
}

void add_inset_light(MeshBuilder& b, MaterialId lens) {
  add_upright_lathe(
      b, {{-0.05, 0.15, galvanised_steel}, {0.001, 0.15, galvanised_steel}, {0.013, 0.10, lens}, {0.013, 0, lens}}, 14);
}

void add_edge_marker(MeshBuilder& b) {
  add_upright_lathe(b,
                    {{-0.2, 0.06, gse_chassis},
                     {0.03, 0.06, gse_chassis},
                     {0.06, 0.05, marker_blue},
                     {0.35, 0.05, marker_blue},
                     {0.36, 0, marker_blue}},
                    12);
}

void add_guard_light(MeshBuilder& b) {
  b.use(concrete_wall);
  add_box(b, {-0.35, -0.45, -0.3}, {0.35, 0.45, 0.03});
  b.use(gse_paint_yellow);
  add_box(b, {-0.05, -0.03, 0.0}, {0.05, 0.03, 0.35});
  add_box(b, {-0.14, -0.36, 0.32}, {0.10, 0.36, 0.70});
  for (const double y : {-0.18, 0.18}) {
    b.use(sign_face_black);
    add_box(b, {0.10, y - 0.15, 0.36}, {0.103, y + 0.15, 0.66});
    b.use(light_lens);
    add_frustum(b, {0.10, y, 0.51}, {0.13, y, 0.51}, 0.10, 0.09, 14);
  }
}

void add_sign(MeshBuilder& b, const std::vector<SignPanel>& panels) {
  double width = 0;
  for (const SignPanel& panel : panels) width += panel_width_m(panel);
  b.use(concrete_wall);
  add_box(b, {-0.4, -width / 2 - 0.2, -0.3}, {0.4, width / 2 + 0.2, 0.03});
  b.use(galvanised_steel);
  for (const double y : {-width / 2 + 0.15, width / 2 - 0.15})
    add_box(b, {-0.03, y - 0.03, 0}, {0.03, y + 0.03, sign_low_m + 0.05});
  double left = -width / 2;
  for (const SignPanel& panel : panels) {
    add_panel(b, panel, left);
    left += panel_width_m(panel);
  }
}

void add_papi_unit(MeshBuilder& b) {
  b.use(concrete_wall);
  add_box(b, {-0.7, -0.6, -0.3}, {0.7, 0.6, 0.04});
  b.use(galvanised_steel);
  for (const Vector3d& p : {Vector3d(0.4, -0.3, 0), Vector3d(0.4, 0.3, 0), Vector3d(-0.4, 0, 0)})
    add_box(b, p - Vector3d(0.03, 0.03, 0), p + Vector3d(0.03, 0.03, 0.4));
  b.use(cone_orange);
  add_plate(b, {{-0.55, 0.36}, {0.55, 0.40}, {0.62, 0.72}, {-0.55, 0.68}}, -0.45, 0.45);
  b.use(light_lens);
  for (const double y : {-0.22, 0.22}) add_frustum(b, {0.575, y, 0.56}, {0.60, y, 0.56}, 0.09, 0.08, 14);
}

void add_windsock(MeshBuilder& b) {
  b.use(concrete_wall);
  add_box(b, {-0.5, -0.5, -0.4}, {0.5, 0.5, 0.05});
  b.use(galvanised_steel);
  add_frustum(b, {0, 0, 0.05}, {0, 0, 6.0}, 0.09, 0.05, 14);
  constexpr int rings = 5;
  const auto at = [](double u) { return Vector3d(0.15 + 3.5 * u, 0, 5.75 - 0.75 * u * u); };
  for (int k = 0; k < rings; ++k) {  // orange and white in turn
    const double u = static_cast<double>(k) / rings, v = static_cast<double>(k + 1) / rings;
    b.use(k % 2 == 0 ? cone_orange : cart_curtain);
    add_frustum(b, at(u), at(v), 0.45 - 0.22 * u, 0.45 - 0.22 * v, 16);
  }
  b.use(galvanised_steel);
  add_beam(b, {0, 0, 5.75}, {0.2, 0, 5.75}, 0.06, 0.9);
}

void add_catch_pit(MeshBuilder& b) {
  b.use(concrete_wall);
  for (const double side : {-1.0, 1.0}) {
    add_box(b, {-0.5, std::min(side * 0.5, side * 0.4), -0.4}, {0.5, std::max(side * 0.5, side * 0.4), 0.05});
    add_box(b, {std::min(side * 0.5, side * 0.4), -0.4, -0.4}, {std::max(side * 0.5, side * 0.4), 0.4, 0.05});
  }
  b.use(galvanised_steel);
  for (int k = 0; k < 8; ++k) add_box(b, {-0.4, -0.39 + 0.1 * k, 0.0}, {0.4, -0.33 + 0.1 * k, 0.04});
}

void add_equipment_hut(MeshBuilder& b) {
  b.use(concrete_wall);
  add_box(b, {-2.3, -1.8, -0.4}, {2.3, 1.8, 0.1});
  add_box(b, {-2.0, -1.5, 0.1}, {2.0, 1.5, 2.6});
  b.use(facade_panel_dark);
  add_box(b, {-2.2, -1.7, 2.6}, {2.2, 1.7, 2.8});
  b.use(painted_steel);
  add_box(b, {2.0, -0.9, 0.15}, {2.05, 0.1, 2.2});
  add_box(b, {2.0, 0.5, 1.4}, {2.06, 1.2, 2.1});
}

void add_stop_sign(MeshBuilder& b) {
  b.use(galvanised_steel);
  add_frustum(b, {0, 0, -0.4}, {0, 0, 2.35}, 0.03, 0.03, 10);
  b.use(sign_face_red);
  add_frustum(b, {0.035, 0, 2.0}, {0.039, 0, 2.0}, 0.3, 0.3, 8);
  b.use(retro_sheeting_ra1);
  add_box(b, {0.039, -0.2, 1.95}, {0.041, 0.2, 2.05});
}

}  // namespace tarmac::scenes
