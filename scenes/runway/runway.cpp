/// A taxiway that crosses a runway. Layout: README.md.
#include <cmath>
#include <numbers>

#include "scenes/assembly.h"
#include "scenes/materials/materials.h"
#include "scenes/paving/strips.h"
#include "scenes/registry.h"
#include "scenes/runway/parts.h"
#include "scenes/taxiway/fittings.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;

namespace {

constexpr double pi = std::numbers::pi;

bool inside(const Rectangle& r, const Vector2d& p) {
  return (p.array() > r.low_m.array()).all() && (p.array() < r.high_m.array()).all();
}

/// Square that a fillet and its rest fill.
Rectangle square_of(const RunwayLayout::Corner& corner, double radius_m) {
  const Vector2d across = corner.at_m + radius_m * (corner.along_runway + corner.along_taxiway);
  return {corner.at_m.cwiseMin(across), corner.at_m.cwiseMax(across)};
}

void add_surfaces(Assembly& a, const RunwayLayout& l, const Ground& ground) {
  MeshBuilder pavement("pavement"), grass("grass");
  pavement.use(asphalt_dry);
  grass.use(grass_green);
  std::vector<Rectangle> taken = l.pavements();
  for (const Rectangle& r : taken) add_ground_region(pavement, ground, r.low_m, r.high_m);
  for (const RunwayLayout::Corner& c : l.corners()) {
    add_fillet(pavement, ground, c.at_m, c.along_runway, c.along_taxiway, l.fillet_m);
    add_fillet_rest(grass, ground, c.at_m, c.along_runway, c.along_taxiway, l.fillet_m);
    taken.push_back(square_of(c, l.fillet_m));
  }
  std::vector<double> xs, ys;
  for (const Rectangle& r : taken) {
    xs.insert(xs.end(), {r.low_m.x(), r.high_m.x()});
    ys.insert(ys.end(), {r.low_m.y(), r.high_m.y()});
  }
  const CellFilter free = [&](const Vector2d& low, const Vector2d& high) {
    for (const Rectangle& r : taken) {
      if (inside(r, 0.5 * (low + high))) return false;
    }
    return true;
  };
  add_ground_region(grass, ground, l.field.low_m, l.field.high_m, {}, free, 0, xs, ys);
  a.put(a.mesh(std::move(pavement).build()), Label::pavement);
  a.put(a.mesh(std::move(grass).build()), Label::terrain);
}

/// Calls f(u) for places at most `spacing` apart from u0 to u1, both included.
template <class F>
void spaced(double u0, double u1, double spacing, const F& f) {
  const int n = std::max(1, static_cast<int>(std::ceil((u1 - u0) / spacing - 1e-9)));
  for (int k = 0; k <= n; ++k) f(u0 + (u1 - u0) * k / n);
}

void add_lights(Assembly& a, const RunwayLayout& l, const RunwayOptions& options) {
  const std::uint32_t edge = a.mesh("edge_light", [](MeshBuilder& b) { add_edge_light(b, light_lens); });
  const std::uint32_t inset = a.mesh("inset_light", [](MeshBuilder& b) { add_inset_light(b, light_lens); });
  const double free = l.taxiway.shoulder_m + l.fillet_m;  // inset where aircraft turn off
  for (const double side : {-1.0, 1.0}) {
    spaced(l.threshold_m, l.east_m - 2, options.edge_light_spacing_m,
           [&](double x) { a.stand(std::abs(x) < free ? inset : edge, Label::light, x, side * (l.half_m + 1.5), 0); });
    for (const double end : {l.south_m + 2, l.north_m - 2}) {
      const double sign = end < 0 ? -1 : 1;
      spaced(l.shoulder_m + l.fillet_m, std::abs(end), 50, [&](double y) {
        if (!l.has_road || std::abs(sign * y - l.road_y_m) > l.road_half_m + 1)
          a.stand(edge, Label::light, side * (l.taxiway.edge_m + 1.5), sign * y, pi / 2);
      });
    }
  }
  spaced(-l.half_m + 1, l.half_m - 1, 3, [&](double y) { a.stand(edge, Label::light, l.threshold_m - 1.5, y, pi); });
  spaced(l.threshold_m + 65, l.east_m - 5, 30, [&](double x) { a.stand(inset, Label::light, x, 0.8, 0); });
  for (const double sign : {-1.0, 1.0}) {
    spaced(l.half_m + 10, (sign < 0 ? -l.south_m : l.north_m) - 5, 30,
           [&](double y) { a.stand(inset, Label::light, 0.4, sign * y, pi / 2); });
  }
}

void add_stop_bars(Assembly& a, const RunwayLayout& l) {
  const std::uint32_t inset = a.mesh("stop_bar_light", [](MeshBuilder& b) { add_inset_light(b, sign_face_red); });
  const std::uint32_t edge = a.mesh("stop_bar_edge_light", [](MeshBuilder& b) { add_edge_light(b, sign_face_red); });
  const std::uint32_t guard = a.mesh("guard_light", add_guard_light);
  for (const double sign : {-1.0, 1.0}) {
    const double y = sign * (l.hold_m + 0.6), away = sign * pi / 2;  // they face who waits
    spaced(-l.taxiway.edge_m + 0.8, l.taxiway.edge_m - 0.8, 3,
           [&](double x) { a.stand(inset, Label::light, x, y, away); });
    for (const double side : {-1.0, 1.0}) {
      a.stand(edge, Label::light, side * (l.taxiway.edge_m + 2.2), y, away);
      a.found(guard, Label::light, side * (l.taxiway.shoulder_m + 2), y, away);
    }
  }
}

void add_signs(Assembly& a, const RunwayLayout& l) {
  const auto sign = [&](std::vector<SignPanel> panels, double x, double y, double yaw) {
    a.found(a.mesh("sign", [&](MeshBuilder& b) { add_sign(b, panels); }), Label::sign, x, y, yaw);
  };
  const double off = std::max(l.taxiway.edge_m + 6, l.taxiway.shoulder_m + 4.5);
  for (const double s : {-1.0, 1.0}) {  // south and north; facing away from the runway
    for (const double side : {-1.0, 1.0}) {
      // The nearer end of the runway is named first on either side.
      sign({{side * s < 0 ? "27-09" : "09-27", SignStyle::mandatory}}, side * off, s * (l.hold_m + 0.5), s * pi / 2);
    }
    sign({{"B", SignStyle::location}}, s * (off + 3.5), s * (l.hold_m + 0.5), s * pi / 2);
    // Left of the exit for who has crossed.
    sign({{"B", SignStyle::location}, {"C2>", SignStyle::direction}}, -s * off, s * (l.shoulder_m + l.fillet_m + 8),
         -s * pi / 2);
    // Seen from the runway, left before the exit.
    sign({{"B", SignStyle::direction}}, -s * (l.taxiway.shoulder_m + l.fillet_m + 12), s * (l.shoulder_m + 8),
         s < 0 ? 0 : pi);
  }
  if (!l.has_road) return;
  const std::uint32_t stop = a.mesh("stop_sign", add_stop_sign);
  for (const double side : {-1.0, 1.0})  // left of the road, facing who comes
    a.found(stop, Label::sign, side * (l.taxiway.shoulder_m + 3.5), l.road_y_m - side * (l.road_half_m + 0.8),
            side < 0 ? pi : 0);
}

void add_landing_aids(Assembly& a, const RunwayLayout& l, const RunwayOptions& options) {
  if (options.with_papi) {
    const std::uint32_t unit = a.mesh("papi_unit", add_papi_unit);
    const double x = l.taxiway.shoulder_m + l.fillet_m + 18;
    for (int k = 0; k < 4; ++k) a.found(unit, Label::light, x, l.half_m + 15 + 9.0 * k, pi);
  }
  if (options.with_windsock)
    a.found(a.mesh("windsock", add_windsock), Label::mast, l.taxiway.shoulder_m + l.fillet_m + 28, -l.shoulder_m - 38,
            -0.4);
}

Scene make_runway_crossing(const RunwayOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "runway-crossing";
  scene.materials = materials();
  const RunwayLayout layout(options);
  const std::shared_ptr<const SectionGround> ground = runway_ground(options, seed);
  scene.ground = ground;
  PavingSpec texture;
  texture.relief_rms_mm = options.relief_rms_mm;
  texture.joint_depth_mm = 0;
  texture.stream = "scenes/runway/texture";
  scene.relief = std::make_shared<SlabRelief>(texture, seed);
  scene.interest_min = {-85, layout.has_road ? layout.road_y_m - 15 : -layout.hold_m - 30};
  scene.interest_max = {110, 75};

  Assembly a(scene, *ground);
  add_surfaces(a, layout, *ground);
  a.put(a.mesh(make_runway_markings(layout, *ground)), Label::marking);
  if (options.with_lights) add_lights(a, layout, options);
  if (options.with_stop_bars) add_stop_bars(a, layout);
  if (options.with_signs) add_signs(a, layout);
  add_landing_aids(a, layout, options);
  return scene;
}

RunwayOptions read(const core::ConfigNode& node) {
  const auto options = read_scene_options<RunwayOptions>(node);
  const RunwayLayout layout(options);
  if (layout.shoulder_m + layout.fillet_m + 10 > layout.hold_m)
    node.fail_at("holding_distance_m",
                 "leaves no straight between the fillets and the holding position; "
                 "move it out or choose a smaller fillet_radius_m");
  if (layout.has_road && layout.road_y_m - 20 < layout.south_m)
    node.fail_at("road_behind_hold_m",
                 "puts the road within 20 m of the taxiway's southern end; "
                 "bring it nearer or lengthen taxiway_south_m");
  return options;
}

}  // namespace

extern const SceneEntry runway_crossing;
const SceneEntry runway_crossing{
    .name = "runway-crossing",
    .summary = "a taxiway that crosses a runway: holding positions, stop bars, PAPI, windsock, a service road",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_runway_crossing(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return runway_ground(read(node), seed);
    },
    .describe = [] { return core::describe_options<RunwayOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: runway-crossing\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
