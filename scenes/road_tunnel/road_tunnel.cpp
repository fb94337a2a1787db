/// A service road that passes under a taxiway. Layout: README.md.
#include <cmath>
#include <numbers>

#include "scenes/assembly.h"
#include "scenes/materials/materials.h"
#include "scenes/paving/ground_painter.h"
#include "scenes/paving/strips.h"
#include "scenes/registry.h"
#include "scenes/road_tunnel/layout.h"
#include "scenes/taxiway/fittings.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double niche_length_m = 3, niche_depth_m = 1.2, niche_height_m = 2.4, walkway_height_m = 0.12;

struct Site {
  const RoadTunnelOptions& options;
  const RoadTunnelLayout& l;
  const RoadTunnelGround& ground;
  CentreLine line = CentreLine::straight(0, 0, 0, 1);  ///< s = x, d = y
  /// West of it the roof and the land on it are left out of pictures.
  double cut_away_m() const { return -l.taxiway_shoulder_m - 2; }
  /// Middles of the niches along x.
  std::vector<double> niches() const {
    std::vector<double> list;
    if (!options.niches) return list;
    const int n = static_cast<int>(std::floor((2 * l.portal_m - 10) / options.niche_spacing_m)) + 1;
    for (int k = 0; k < n; ++k) list.push_back(options.niche_spacing_m * (k - 0.5 * (n - 1)));
    return list;
  }
};

void add_road(Assembly& a, const Site& s) {
  MeshBuilder road("road"), walkways("walkways");
  road.use(asphalt_dry);
  const StripMesher strips(s.ground, s.line, -s.l.road_end_m, s.l.road_end_m, -s.l.half_m, s.l.half_m);
  strips.band(road, -s.l.half_m, s.l.half_m);
  walkways.use(tunnel_concrete);
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * (s.l.half_m - s.options.walkway_m), outer = side * (s.l.half_m + 0.02);
    add_swept(walkways, s.ground, s.line, -s.l.wall_end_m, s.l.wall_end_m,
              rectangle_outline(inner, -0.08, outer, walkway_height_m), 2);
  }
  GroundPainter p(s.ground, "markings");
  p.use(paint_white_marking);
  const double edge = s.l.half_m - s.options.walkway_m - 0.2;
  for (const double side : {-1.0, 1.0}) p.line({{-s.l.road_end_m, side * edge}, {s.l.road_end_m, side * edge}}, 0.12);
  p.dashes({-s.l.road_end_m, 0}, {s.l.road_end_m, 0}, 0.12, 2, 4);
  a.put(a.mesh(std::move(road).build()), Label::pavement);
  a.put(a.mesh(std::move(walkways).build()), Label::building);
  a.put(a.mesh(std::move(p).build()), Label::marking);
}

/// Solid retaining walls beside the ramps, from below the road to a parapet above the land.
void add_retaining_walls(MeshBuilder& b, const Site& s) {
  for (const double end : {-1.0, 1.0}) {
    for (const double side : {-1.0, 1.0}) {
      std::vector<Ring> rings;
      const double y0 = side * s.l.half_m, y1 = side * (s.l.half_m + s.l.wall_m);
      const int n = static_cast<int>(std::ceil((s.l.wall_end_m - s.l.portal_m) / 3));
      for (int k = 0; k <= n; ++k) {
        const double x = end * (s.l.portal_m + (s.l.wall_end_m - s.l.portal_m) * k / n);
        const double low = s.ground.height_m(x, y0) - 0.6, high = s.ground.land().height_m(x, y0) + s.l.parapet_m;
        rings.push_back({{x, y0, low}, {x, y0, high}, {x, y1, high}, {x, y1, low}});
      }
      add_loft(b, rings);
    }
  }
}

/// A recess behind a gap in the wall: back, two sides, floor and lid, all solid.
void add_niche(MeshBuilder& b, const Site& s, double x_m, double side) {
  const double x0 = x_m - niche_length_m / 2, x1 = x_m + niche_length_m / 2, skin = 0.2;
  const double y0 = s.l.half_m, y1 = s.l.half_m + niche_depth_m;
  // Behind the wall the ground is the land: heights are the road's, seen from the wall's foot.
  const double z = s.ground.height_m(x_m, side * y0);
  const auto box = [&](double xa, double ya, double za, double xb, double yb, double zb) {
    add_box(b, {xa, std::min(side * ya, side * yb), z + za}, {xb, std::max(side * ya, side * yb), z + zb});
  };
  box(x0 - skin, y1, -0.2, x1 + skin, y1 + skin, niche_height_m + skin);
  for (const double x : {x0 - skin, x1}) box(x, y0 + 0.05, -0.2, x + skin, y1 + 0.05, niche_height_m + skin);
  box(x0, y0, -0.2, x1, y1 + 0.05, walkway_height_m);
  box(x0 - skin, y0 + 0.05, niche_height_m, x1 + skin, y1 + 0.05, niche_height_m + skin);
  b.use(sign_face_red);  // extinguishers
  box(x_m - 0.35, y1 - 0.22, 0.9, x_m + 0.35, y1 + 0.02, 1.8);
  b.use(tunnel_concrete);
}

/// The walls of the box, cut open in front of the niches.
void add_box_walls(MeshBuilder& b, const Site& s) {
  const double top = s.l.height_m + 0.1;
  for (const double side : {-1.0, 1.0}) {
    // The ground is the road's up to the inner face only: both faces hang on the inner one.
    const auto wall = [&](double x0, double x1, double low, double high) {
      const int n = std::max(1, static_cast<int>(std::ceil((x1 - x0) / 4)));
      std::vector<Ring> rings;
      for (int k = 0; k <= n; ++k) {
        const double x = x0 + (x1 - x0) * k / n, y = side * s.l.half_m, z = s.ground.height_m(x, y);
        const double y1 = side * (s.l.half_m + s.l.wall_m);
        rings.push_back({{x, y, z + low}, {x, y, z + high}, {x, y1, z + high}, {x, y1, z + low}});
      }
      add_loft(b, rings);
    };
    double from = -s.l.portal_m;
    for (const double x : s.niches()) {
      wall(from, x - niche_length_m / 2, -0.2, top);
      wall(x - niche_length_m / 2, x + niche_length_m / 2, niche_height_m, top);
      add_niche(b, s, x, side);
      from = x + niche_length_m / 2;
    }
    wall(from, s.l.portal_m, -0.2, top);
  }
}

void add_structure(Assembly& a, const Site& s) {
  MeshBuilder b("tunnel_walls");
  b.use(tunnel_concrete);
  add_retaining_walls(b, s);
  add_box_walls(b, s);
  for (const double end : {-1.0, 1.0}) {  // headwalls, from the roof's underside to a parapet
    const double x0 = end * s.l.portal_m, x1 = end * (s.l.portal_m - 0.4), y = s.l.half_m + s.l.wall_m;
    const double low = s.ground.height_m(x0, 0) + s.l.height_m + 0.03;
    const double high = s.ground.land().height_m(x0, 0) + s.l.parapet_m;
    b.use(tunnel_concrete);
    // In three pieces, as the ground below it has three: land, road, land.
    for (const auto& [from, to] : {std::pair{-y, -s.l.half_m}, {-s.l.half_m, s.l.half_m}, {s.l.half_m, y}})
      add_box(b, {std::min(x0, x1), from, low}, {std::max(x0, x1), to, high});
    b.use(sign_face_yellow);  // clear height
    const double face = x0 + end * 0.03;
    add_box(b, {std::min(x0, face), -1.1, low + 0.4}, {std::max(x0, face), 1.1, low + 0.9});
  }
  a.put(a.mesh(std::move(b).build()), Label::building);
  const auto roof = [&](const char* name, double x0, double x1) {
    MeshBuilder r(name);
    r.use(tunnel_concrete);
    // Hangs on the road's middle: beyond the walls the ground is the land.
    std::vector<Ring> rings;
    const int n = static_cast<int>(std::ceil((x1 - x0) / 2));
    for (int k = 0; k <= n; ++k) {
      const double x = x0 + (x1 - x0) * k / n, y = s.l.half_m + s.l.wall_m;
      const double low = s.ground.height_m(x, 0) + s.l.height_m, high = low + s.l.roof_m;
      rings.push_back({{x, -y, low}, {x, y, low}, {x, y, high}, {x, -y, high}});
    }
    add_loft(r, rings);
    a.put(a.mesh(std::move(r).build()), Label::building);
  };
  roof("tunnel_ceiling", -s.l.portal_m, s.cut_away_m());
  roof("tunnel_roof", s.cut_away_m(), s.l.portal_m);
}

void add_land(Assembly& a, const Site& s) {
  const RoadTunnelLayout& l = s.l;
  const double trench = l.half_m + l.wall_m, taxiway = s.options.with_taxiway ? l.taxiway_shoulder_m : 0;
  const auto is_cut_away = [&](const Vector2d& p) {
    return std::abs(p.y()) < trench && p.x() > -l.portal_m && p.x() < s.cut_away_m();
  };
  const auto is_grass = [&](const Vector2d& p) {
    if (std::abs(p.x()) < taxiway) return false;
    if (std::abs(p.x()) < l.portal_m) return true;
    return std::abs(p.y()) > (std::abs(p.x()) < l.wall_end_m ? trench : l.half_m);
  };
  const std::vector<double> xs{-l.wall_end_m, -l.portal_m, s.cut_away_m(), -taxiway, taxiway, l.portal_m, l.wall_end_m};
  const std::vector<double> ys{-trench, -l.half_m, l.half_m, trench};
  const Vector2d low(-l.road_end_m, -l.land_half_m), high(l.road_end_m, l.land_half_m);
  const auto grass = [&](const char* name, bool cut_away) {
    MeshBuilder b(name);
    b.use(grass_green);
    add_ground_region(
        b, s.ground.land(), low, high, {},
        [&](const Vector2d& from, const Vector2d& to) {
          const Vector2d middle = 0.5 * (from + to);
          return is_grass(middle) && is_cut_away(middle) == cut_away;
        },
        0, xs, ys);
    a.put(a.mesh(std::move(b).build()), Label::terrain);
  };
  grass("grass", false);
  grass("grass_on_ceiling", true);
  if (!s.options.with_taxiway) return;
  MeshBuilder pavement("taxiway");
  pavement.use(asphalt_dry);
  add_ground_region(pavement, s.ground.land(), {-taxiway, -l.land_half_m}, {taxiway, l.land_half_m});
  GroundPainter p(s.ground.land(), "taxiway_markings");
  p.use(paint_yellow_marking).line({{0, -l.land_half_m}, {0, l.land_half_m}}, 0.3);
  for (const double x : {-0.4, -0.1, 0.1, 0.4}) {
    const double at = (x < 0 ? -1 : 1) * l.taxiway_half_m - x;
    p.line({{at, -l.land_half_m}, {at, l.land_half_m}}, 0.15);
  }
  a.put(a.mesh(std::move(pavement).build()), Label::pavement);
  a.put(a.mesh(std::move(p).build()), Label::marking);
  const std::uint32_t light = a.mesh("edge_light", [](MeshBuilder& b) { add_edge_light(b, light_lens); });
  for (const double x : {-l.taxiway_half_m - 1.5, l.taxiway_half_m + 1.5}) {
    for (double y = -90; y <= 90; y += 45) a.put(light, Label::light, place(x, y, s.ground.land().height_m(x, y)));
  }
}

void add_lamps(Assembly& a, const Site& s) {
  const std::uint32_t lamp = a.mesh("wall_lamp", [](MeshBuilder& b) {
    b.use(galvanised_steel);
    add_box(b, {-0.6, -0.10, -0.1}, {0.6, 0.05, 0.1});  // its back is inside the wall
    b.use(light_lens);
    add_box(b, {-0.55, -0.11, -0.07}, {0.55, -0.10, 0.07});
  });
  const int n = static_cast<int>(std::floor((2 * s.l.portal_m - 4) / s.options.light_spacing_m)) + 1;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k < n; ++k) {
      const double x = s.options.light_spacing_m * (k - 0.5 * (n - 1)), y = side * s.l.half_m;
      const double z = s.ground.height_m(x, y) + s.l.height_m - 0.9;
      a.put(lamp, Label::light, place(x, y, z, side > 0 ? 0 : std::numbers::pi));
    }
  }
}

Scene make_road_tunnel(const RoadTunnelOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "road-tunnel";
  scene.materials = materials();
  const auto ground = std::make_shared<RoadTunnelGround>(options, seed);
  scene.ground = ground;
  PavingSpec texture;
  texture.relief_rms_mm = options.relief_rms_mm;
  texture.joint_depth_mm = 0;
  texture.stream = "scenes/road_tunnel/texture";
  scene.relief = std::make_shared<SlabRelief>(texture, seed);
  const RoadTunnelLayout& l = ground->layout();
  scene.interest_min = {std::max(-l.portal_m - 25, -115.0), -35};
  scene.interest_max = {30, 35};
  Assembly a(scene, *ground);
  const Site site{.options = options, .l = l, .ground = *ground};
  add_road(a, site);
  add_structure(a, site);
  add_land(a, site);
  if (options.with_wall_lights) add_lamps(a, site);
  return scene;
}

RoadTunnelOptions read(const core::ConfigNode& node) {
  return read_scene_options<RoadTunnelOptions>(node);
}

}  // namespace

extern const SceneEntry road_tunnel;
const SceneEntry road_tunnel{
    .name = "road-tunnel",
    .summary = "a service road under a taxiway: ramps, a concrete box, smooth or with niches",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_road_tunnel(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<RoadTunnelGround>(read(node), seed);
    },
    .describe = [] { return core::describe_options<RoadTunnelOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: road-tunnel\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
