/// A tunnel for baggage tugs, and the hall it comes from. Layout: README.md.
#include <cmath>
#include <numbers>

#include "scenes/baggage_tunnel/layout.h"
#include "scenes/materials/materials.h"
#include "scenes/paving/ground_painter.h"
#include "scenes/paving/strips.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double sweep_step_m = 0.6;  ///< along bends of 8 m and more: 6 mm in plan

struct Site {
  const BaggageTunnelOptions& options;
  const BaggageTunnelLayout& l;
  const SectionGround& ground;
  /// Along the line: the side corridor's mouth, or an empty range at the end.
  double mouth_begin_m() const { return options.with_junction ? l.junction_m - l.side_half_m : l.line.length_m(); }
  double mouth_end_m() const { return options.with_junction ? l.junction_m + l.side_half_m : l.line.length_m(); }
};

/// A bar along the left wall that leaves the side corridor's mouth free.
void sweep_left(MeshBuilder& b, const Site& s, const std::vector<Vector2d>& outline) {
  add_swept(b, s.ground, s.l.line, 0, s.mouth_begin_m(), outline, sweep_step_m);
  if (s.options.with_junction)
    add_swept(b, s.ground, s.l.line, s.mouth_end_m(), s.l.line.length_m(), outline, sweep_step_m);
}

void sweep(MeshBuilder& b, const Site& s, const std::vector<Vector2d>& outline) {
  add_swept(b, s.ground, s.l.line, 0, s.l.line.length_m(), outline, sweep_step_m);
}

void add_floor(Assembly& a, const Site& s) {
  const BaggageTunnelLayout& l = s.l;
  // Floors that meet lap over each other by 20 cm.
  MeshBuilder floor("tunnel_floor");
  floor.use(concrete_dry);
  StripMesher(s.ground, l.line, -0.2, l.line.length_m(), -l.half_m, l.half_m).band(floor, -l.half_m, l.half_m);
  if (s.options.with_junction)
    StripMesher(s.ground, l.side, l.half_m - 0.2, l.side.length_m(), -l.side_half_m, l.side_half_m)
        .band(floor, -l.side_half_m, l.side_half_m);
  GroundPainter p(s.ground, "markings");
  p.use(paint_yellow_marking);
  for (const double side : {-1.0, 1.0})
    p.line(l.line.offset_line(0, l.line.length_m(), side * (l.half_m - 0.45), 0.6), 0.1);
  a.put(a.mesh(std::move(floor).build()), Label::pavement);
  a.put(a.mesh(std::move(p).build()), Label::marking);
}

void add_structure(Assembly& a, const Site& s) {
  const BaggageTunnelLayout& l = s.l;
  const double w = l.wall_m, low = -0.2, high = l.height_m + 0.1;
  MeshBuilder walls("tunnel_walls"), roof("tunnel_ceiling");
  walls.use(tunnel_concrete);
  roof.use(tunnel_concrete);
  sweep_left(walls, s, rectangle_outline(l.half_m, low, l.half_m + w, high));
  sweep(walls, s, rectangle_outline(-l.half_m - w, low, -l.half_m, high));
  sweep(roof, s, rectangle_outline(-l.half_m - w, l.height_m, l.half_m + w, l.height_m + 0.3));
  walls.use(concrete_wall);  // kerbs that keep carts off the walls
  sweep_left(walls, s, rectangle_outline(l.half_m - 0.12, -0.05, l.half_m + 0.02, 0.2));
  sweep(walls, s, rectangle_outline(-l.half_m - 0.02, -0.05, -l.half_m + 0.12, 0.2));
  if (s.options.with_junction) {
    walls.use(tunnel_concrete);
    for (const double side : {-1.0, 1.0}) {
      const double d0 = side * l.side_half_m, d1 = side * (l.side_half_m + w);
      add_swept(walls, s.ground, l.side, l.half_m + 0.02, l.side.length_m() + w, rectangle_outline(d0, low, d1, high),
                2);
    }
    add_swept(roof, s.ground, l.side, l.half_m, l.side.length_m() + w,
              rectangle_outline(-l.side_half_m - w, l.height_m, l.side_half_m + w, l.height_m + 0.3), 2);
  }
  a.put(a.mesh(std::move(walls).build()), Label::building);
  a.put(a.mesh(std::move(roof).build()), Label::building);
}

/// Closed doors at the ends, and doors along the walls that are never open: flat frames.
void add_doors(Assembly& a, const Site& s) {
  const BaggageTunnelLayout& l = s.l;
  const std::uint32_t end = a.mesh("end_door", [&](MeshBuilder& b) { add_roller_door(b, 2 * l.half_m, l.height_m); });
  const CentreLine::Point last = l.line.at(l.line.length_m());
  a.found(end, Label::building, last.p_m.x(), last.p_m.y(), last.heading_rad + pi);
  if (!s.options.with_hall) a.found(end, Label::building, 0, 0, 0);
  if (s.options.with_junction) {
    const std::uint32_t side =
        a.mesh("side_door", [&](MeshBuilder& b) { add_roller_door(b, 2 * l.side_half_m, l.height_m); });
    const Vector2d p = l.side.at(l.side.length_m()).p_m;
    a.found(side, Label::building, p.x(), p.y(), 0);
  }
  const std::uint32_t door =
      a.mesh("wall_door", [](MeshBuilder& b) { add_roller_door(b, 3, 2.2); });  // below the trays
  const double length = l.line.length_m();
  for (const auto& [at, side] : {std::pair{l.first_leg_m - 8, 1.0},
                                 {l.first_leg_m - 4, -1.0},
                                 {l.junction_m + 8, -1.0},
                                 {length - 0.45 * s.options.last_leg_m, -1.0},
                                 {length - 4, 1.0}}) {
    const CentreLine::Point point = l.line.at(at);
    const Vector2d p = point.p_m + side * l.half_m * point.left;
    a.found(door, Label::building, p.x(), p.y(), point.heading_rad - side * pi / 2);
  }
}

void add_trays(Assembly& a, const Site& s) {
  const double h = s.options.height_m, half = s.l.half_m;
  a.put(a.mesh("trays_and_pipes",
               [&](MeshBuilder& b) {
                 b.use(galvanised_steel);
                 const double tray = std::max(2.5, h - 0.6);
                 sweep(b, s, rectangle_outline(half - 0.5, tray, half - 0.1, tray + 0.06));
                 b.use(tyre_rubber);  // cables
                 for (const double d : {0.42, 0.34, 0.22}) sweep(b, s, circle_outline(half - d, tray + 0.08, 0.025, 6));
                 b.use(painted_steel);
                 sweep(b, s, circle_outline(-half + 0.22, h - 0.3, 0.09, 12));
                 sweep(b, s, circle_outline(-half + 0.45, h - 0.25, 0.06, 10));
                 b.use(galvanised_steel);  // hangers
                 const double length = s.l.line.length_m();
                 for (double at = 1.5; at < length; at += 2.5) {
                   add_swept(b, s.ground, s.l.line, at, at + 0.05,
                             rectangle_outline(half - 0.52, tray - 0.05, half - 0.08, tray), 0.05);
                   add_swept(b, s.ground, s.l.line, at, at + 0.03,
                             rectangle_outline(half - 0.31, tray, half - 0.28, h + 0.05), 0.03);
                   add_swept(b, s.ground, s.l.line, at, at + 0.03,
                             rectangle_outline(-half + 0.1, h - 0.15, -half + 0.55, h - 0.11), 0.03);
                 }
               }),
        Label::other);
}

void add_lamps(Assembly& a, const Site& s) {
  a.put(a.mesh("lamps_on_ceiling",
               [&](MeshBuilder& b) {
                 const double h = s.options.height_m, length = s.l.line.length_m();
                 for (double at = 3; at + 1.2 < length; at += 6) {
                   b.use(light_lens);
                   add_swept(b, s.ground, s.l.line, at, at + 1.2, rectangle_outline(-0.1, h - 0.08, 0.1, h + 0.02),
                             0.6);
                 }
               }),
        Label::light);
}

Scene make_baggage_tunnel(const BaggageTunnelOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "baggage-tunnel";
  scene.materials = materials();
  const BaggageTunnelLayout layout(options);
  const std::shared_ptr<const SectionGround> ground = baggage_ground(options, seed);
  scene.ground = ground;
  PavingSpec texture;
  texture.relief_rms_mm = options.relief_rms_mm;
  texture.joint_depth_mm = 0;
  texture.stream = "scenes/baggage_tunnel/texture";
  scene.relief = std::make_shared<SlabRelief>(texture, seed);
  scene.interest_min = {options.with_hall ? -layout.hall_length_m - 5 : -10, -layout.hall_half_m - 5};
  scene.interest_max = {layout.line.at(layout.line.length_m()).p_m.x() + 5,
                        layout.line.at(layout.line.length_m()).p_m.y() + 10};
  Assembly a(scene, *ground);
  const Site site{options, layout, *ground};
  add_floor(a, site);
  add_structure(a, site);
  add_doors(a, site);
  if (options.with_trays) add_trays(a, site);
  if (options.with_lamps) add_lamps(a, site);
  if (options.with_hall) add_baggage_hall(a, layout, options, *ground, seed);
  return scene;
}

BaggageTunnelOptions read(const core::ConfigNode& node) {
  const auto options = read_scene_options<BaggageTunnelOptions>(node);
  const double needed = 8 + options.rise_m / (options.ramp_percent / 100) + 5;
  if (options.last_leg_m < needed)
    node.fail_at("last_leg_m", "does not hold the ramp up: it needs " +
                                   std::to_string(static_cast<int>(std::ceil(needed))) +
                                   " m; lengthen it, or lower rise_m");
  return options;
}

}  // namespace

extern const SceneEntry baggage_tunnel;
const SceneEntry baggage_tunnel{
    .name = "baggage-tunnel",
    .summary = "a narrow tunnel with ramps and two turns, and the baggage hall it comes from",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_baggage_tunnel(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return baggage_ground(read(node), seed);
    },
    .describe = [] { return core::describe_options<BaggageTunnelOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: baggage-tunnel\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
