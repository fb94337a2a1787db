/// A taxiway in grass, straight or with a bend. Layout: README.md.
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/materials/materials.h"
#include "scenes/paving/ground_painter.h"
#include "scenes/paving/strips.h"
#include "scenes/registry.h"
#include "scenes/taxiway/fittings.h"
#include "scenes/taxiway/section.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;

namespace {

constexpr double pi = std::numbers::pi;

/// Beyond a ditch's outer edge the rounding of its break fades by e every 0.4 m: from here on less than 0.1 mm is left
/// of it, and cells of any size follow the ground.
constexpr double level_beyond_outer_m = 2.5;
/// Inside a bend: how far strips reach beyond the ditch, and how near to the bend's centre they may.
constexpr double strip_beyond_outer_m = 8, strip_to_centre_m = 2;
/// The plane region begins so much within the strip: more than the strip's edge bulges between the places of a cell at
/// which reaches_beyond() looks, so that no gap is left.
constexpr double overlap_m = 0.3;

struct Site {
  const TaxiwayOptions& options;
  const TaxiwayLayout& layout;
  const SectionGround& ground;
  std::uint64_t seed;
  /// Outermost pavement to the right.
  double right_edge_m() const { return layout.taxiways_d_m().back() - layout.section().shoulder_m; }
  double length_m() const { return layout.line().length_m(); }
};

/// Whether a cell has a place farther to the left than d_m; `middle_d_m` is that of its middle. Looks at corners and
/// middles of edges.
bool reaches_beyond(const CentreLine& line, double d_m, double middle_d_m, const Vector2d& from, const Vector2d& to) {
  const Vector2d half = 0.5 * (to - from);
  if (middle_d_m > d_m) return true;
  if (middle_d_m + half.norm() < d_m) return false;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      if (line.project(from + half + Vector2d(x * half.x(), y * half.y())).d_m > d_m) return true;
    }
  }
  return false;
}

/// Pavement, and grass in strips beside it as far as strips reach; inside a bend the rest of the grass is a plane
/// region.
void add_surfaces(Assembly& a, const Site& site) {
  const TaxiwaySection& section = site.layout.section();
  const bool bend = site.layout.bend_end_m() > site.layout.bend_begin_m();
  const double right = site.right_edge_m() - site.options.grass_m;
  const double left =
      bend ? std::min(section.outer_m + strip_beyond_outer_m, site.options.turn_radius_m - strip_to_centre_m)
           : section.shoulder_m + site.options.grass_m;
  const CentreLine& line = site.layout.line();
  const StripMesher strips(site.ground, line, 0, site.length_m(), right, left);
  MeshBuilder pavement("pavement"), grass("grass");
  pavement.use(asphalt_dry);
  grass.use(grass_green);
  double edge = left;
  for (const double d : site.layout.taxiways_d_m()) {
    grass.use(grass_green);
    strips.band(grass, d + section.shoulder_m, edge);
    strips.band(pavement, d - section.shoulder_m, d + section.shoulder_m);
    edge = d - section.shoulder_m;
  }
  strips.band(grass, right, edge);
  if (bend) {
    const double reach = section.shoulder_m + site.options.grass_m;
    Vector2d low = line.at(0).p_m, high = low;
    for (double s = 0; s <= site.length_m(); s += 5) {
      for (const double d : {0.0, reach}) {
        low = low.cwiseMin(line.place(s, d));
        high = high.cwiseMax(line.place(s, d));
      }
    }
    // Cells that straddle the strip's edge lie on it with the rest; none of them reaches the ditch.
    const MeshTolerance tolerance{.max_cell_m = (left - overlap_m - section.outer_m - level_beyond_outer_m) /
                                                std::numbers::sqrt2};
    add_ground_region(grass, site.ground, low, high, tolerance, [&](const Vector2d& from, const Vector2d& to) {
      const CentreLine::Place place = line.project(0.5 * (from + to));
      const double half_m = 0.5 * (to - from).norm();
      return place.d_m < reach + half_m && place.s_m > -half_m && place.s_m < site.length_m() + half_m &&
             reaches_beyond(line, left - overlap_m, place.d_m, from, to);
    });
  }
  a.put(a.mesh(std::move(pavement).build()), Label::pavement);
  a.put(a.mesh(std::move(grass).build()), Label::terrain);
}

void add_markings(Assembly& a, const Site& site) {
  GroundPainter p(site.ground, "markings");
  p.use(paint_yellow_marking);
  const CentreLine& line = site.layout.line();
  constexpr double step_m = 1.25;
  const bool wide = site.layout.code().letter >= 'D';
  for (const double d : site.layout.taxiways_d_m()) {
    p.layer(1).line(line.offset_line(0, site.length_m(), d, step_m), wide ? 0.3 : 0.15);
    for (const double side : {-1.0, 1.0}) {  // two lines along each edge
      for (const double inward : {0.1, 0.4})
        p.layer(0).line(
            line.offset_line(0, site.length_m(), d + side * (site.layout.section().edge_m - inward), step_m), 0.15);
    }
  }
  a.put(a.mesh(std::move(p).build()), Label::marking);
}

/// Calls f(s) for places from s0 to s1, at most `spacing_m` apart measured at distance d, in the middle of equal parts.
template <class F>
void along(const CentreLine& line, double s0, double s1, double d, double spacing_m, const F& f) {
  if (s1 <= s0) return;
  const double turned = line.at(s1).heading_rad - line.at(s0).heading_rad;
  const int n = std::max(1, static_cast<int>(std::ceil((s1 - s0 - d * turned) / spacing_m - 1e-9)));
  for (int k = 0; k < n; ++k) f(s0 + (s1 - s0) * (k + 0.5) / n);
}

void add_lights(Assembly& a, const Site& site) {
  const std::uint32_t edge = a.mesh("edge_light", [](MeshBuilder& b) { add_edge_light(b, light_lens); });
  const std::uint32_t inset = a.mesh("inset_light", [](MeshBuilder& b) { add_inset_light(b, light_lens); });
  const CentreLine& line = site.layout.line();
  const double begin = site.layout.bend_begin_m(), end = site.layout.bend_end_m();
  const auto put = [&](std::uint32_t mesh, double s, double d) {
    const Vector2d p = line.place(s, d);
    a.stand(mesh, Label::light, p.x(), p.y(), line.at(s).heading_rad);
  };
  for (const double centre : site.layout.taxiways_d_m()) {
    for (const double side : {-1.0, 1.0}) {
      const double d = centre + side * (site.layout.section().edge_m + 1.5);
      const auto light = [&](double s) { put(edge, s, d); };
      along(line, 0, begin, d, site.options.light_spacing_m, light);
      along(line, begin, end, d, site.options.curve_light_spacing_m, light);
      along(line, end, site.length_m(), d, site.options.light_spacing_m, light);
    }
    // Beside the painted line, not on it.
    const auto light = [&](double s) { put(inset, s, centre + 0.4); };
    along(line, 0, begin, centre, 30, light);
    along(line, begin, end, centre, 15, light);
    along(line, end, site.length_m(), centre, 30, light);
  }
  if (end <= begin) return;
  const std::uint32_t marker = a.mesh("edge_marker", add_edge_marker);
  const double inside = site.layout.section().edge_m + 2.5;
  along(line, begin, end, inside, 5, [&](double s) { put(marker, s, inside); });
}

void add_signs(Assembly& a, const Site& site) {
  const core::RandomStream random(site.seed, "scenes/taxiway/signs");
  const CentreLine& line = site.layout.line();
  const TaxiwaySection& section = site.layout.section();
  const double off = std::max(section.edge_m + 5, section.shoulder_m + 2);
  std::uint64_t k = 0;
  const auto put = [&](double s, double d, bool eastbound, const char* here) {
    const std::string number(1, static_cast<char>('1' + static_cast<int>(9 * random.uniform(k))));
    const std::string other = here[0] == 'A' ? "B" : "A";
    const std::uint32_t mesh = a.mesh("sign", [&](MeshBuilder& b) {
      add_sign(b, {{here, SignStyle::location},
                   {other + number + (random.uniform(k, 1) < 0.5 ? "<" : ">"), SignStyle::direction}});
    });
    ++k;
    const CentreLine::Point at = line.at(s);
    const Vector2d p = at.p_m + d * at.left;
    a.found(mesh, Label::sign, p.x(), p.y(), at.heading_rad + (eastbound ? pi : 0));
  };
  for (std::size_t t = 0; t < site.layout.taxiways_d_m().size(); ++t) {
    const double d = site.layout.taxiways_d_m()[t];
    const char* const name = t == 0 ? "A" : "B";
    // Pilots find signs on their left.
    along(line, 0, site.length_m(), 0, site.options.sign_spacing_m, [&](double s) {
      put(s, d + off, true, name);
      put(s + 12, d - off, false, name);
    });
  }
}

void add_drains(Assembly& a, const Site& site) {
  const std::uint32_t pit = a.mesh("catch_pit", add_catch_pit);
  const CentreLine& line = site.layout.line();
  for (const double centre : site.layout.taxiways_d_m()) {
    for (const double side : {-1.0, 1.0}) {
      const double d = centre + side * site.layout.section().swale_m;
      along(line, 0, site.length_m(), d, site.options.drain_spacing_m, [&](double s) {
        const Vector2d p = line.place(s, d);
        a.stand(pit, Label::other, p.x(), p.y(), line.at(s).heading_rad);
      });
    }
  }
}

void add_huts(Assembly& a, const Site& site) {
  if (site.options.huts == 0) return;
  const core::RandomStream random(site.seed, "scenes/taxiway/huts");
  const std::uint32_t hut = a.mesh("equipment_hut", add_equipment_hut);
  const CentreLine& line = site.layout.line();
  // On the right: inside a bend strips of grass have no room. Object-free up to 51 m from a centre line (code F).
  const double nearest =
      site.right_edge_m() + site.layout.section().shoulder_m - 0.57 * site.layout.code().separation_m - 3;
  for (int k = 0; k < site.options.huts; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double s = site.length_m() * (k + 0.2 + 0.6 * random.uniform(i, 0)) / site.options.huts;
    const double d = nearest - 8 * random.uniform(i, 1);
    const Vector2d p = line.place(s, d);
    a.found(hut, Label::building, p.x(), p.y(), line.at(s).heading_rad + pi / 2);
  }
}

Scene make_taxiway(const TaxiwayOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "taxiway";
  scene.materials = materials();
  const TaxiwayLayout layout(options);
  const std::shared_ptr<const SectionGround> ground = layout.ground(options, seed);
  scene.ground = ground;
  PavingSpec texture;
  texture.relief_rms_mm = options.relief_rms_mm;
  texture.joint_depth_mm = 0;
  texture.stream = "scenes/taxiway/texture";
  scene.relief = std::make_shared<SlabRelief>(texture, seed);
  scene.interest_min = {-70, layout.taxiways_d_m().back() - 35};
  scene.interest_max = {80, options.shape == "straight" ? 45.0 : 110.0};

  Assembly a(scene, *ground);
  const Site site{options, layout, *ground, seed};
  add_surfaces(a, site);
  add_markings(a, site);
  if (options.with_lights) add_lights(a, site);
  if (options.with_signs) add_signs(a, site);
  if (options.with_drains) add_drains(a, site);
  add_huts(a, site);
  return scene;
}

TaxiwayOptions read(const core::ConfigNode& node) {
  const auto options = read_scene_options<TaxiwayOptions>(node);
  const TaxiwayCode& code = taxiway_code(options.code_letter);
  const auto at_most = [&](const char* name, double value, double limit) {
    if (std::abs(value) > limit)
      node.fail_at(name, "is steeper than the " + std::to_string(limit).substr(0, 3) + " % that code letter " +
                             options.code_letter + " allows; lower it or choose another code_letter");
  };
  at_most("longitudinal_slope_percent", options.longitudinal_slope_percent, code.longitudinal_slope_percent);
  at_most("transverse_slope_percent", options.transverse_slope_percent, code.transverse_slope_percent);
  if (options.shape == "straight") return options;
  const double needed = taxiway_section(code).outer_m + strip_beyond_outer_m;
  if (options.turn_radius_m < needed)
    node.fail_at("turn_radius_m", "the ditch inside the bend needs a radius of at least " +
                                      std::to_string(static_cast<int>(std::ceil(needed))) + " m with code letter " +
                                      options.code_letter);
  if (options.length_m < 1.5 * options.turn_radius_m * radians(options.turn_deg) + 60)
    node.fail_at("length_m", "does not hold the bend and a straight before and after it; lengthen it");
  return options;
}

}  // namespace

extern const SceneEntry taxiway;
const SceneEntry taxiway{
    .name = "taxiway",
    .summary = "a taxiway in grass, straight or with a bend: lights, signs, ditches, little else",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_taxiway(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      const TaxiwayOptions options = read(node);
      return TaxiwayLayout(options).ground(options, seed);
    },
    .describe = [] { return core::describe_options<TaxiwayOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: taxiway\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
