// Two carriageways with rails, signs and gantries. Layout: README.md.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/highway/layout.h"
#include "scenes/outdoors/outdoors.h"
#include "scenes/paving/section_ground.h"
#include "scenes/paving/strips.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

namespace highway_layout {

std::vector<PathPiece> pieces(const HighwayOptions& o) {
  return pieces_at(o, 0);
}

std::vector<PathPiece> pieces_at(const HighwayOptions& o, double d_m) {
  if (o.turn_deg <= 0) return {{.straight_m = o.length_m}};
  const double bend_m = o.turn_deg * std::numbers::pi / 180 * o.radius_m + blend_m;
  const double straight_m = (o.length_m - 2 * bend_m) / 3;
  return {{.straight_m = straight_m},
          {.turn_deg = o.turn_deg, .radius_m = o.radius_m - d_m, .blend_m = blend_m},
          {.straight_m = straight_m},
          {.turn_deg = -o.turn_deg, .radius_m = o.radius_m + d_m, .blend_m = blend_m},
          {.straight_m = straight_m}};
}

}  // namespace highway_layout

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;
namespace l = highway_layout;

constexpr double pi = std::numbers::pi;

std::shared_ptr<const SectionGround> make_road(const HighwayOptions& o, std::uint64_t seed) {
  const double edge = l::outer_edge_m(o) + 0.6, foot = edge + l::verge_m, fall = o.crossfall_percent / 100;
  SectionSpec spec;
  spec.across = RoundedProfile({{-2 * l::far_m, -fall * edge - 1.4},
                                {-foot, -fall * edge - 1.4, 1.0},
                                {-edge, -fall * edge, 0.4},
                                {0, 0, 1.0},
                                {edge, -fall * edge, 0.4},
                                {foot, -fall * edge - 1.4, 1.0},
                                {2 * l::far_m, -fall * edge - 1.4}});
  const double third = o.length_m / 3, climb = o.grade_percent / 100 * third;
  spec.along = RoundedProfile({{0, 0}, {third, climb, 40}, {2 * third, climb, 40}, {o.length_m, 0}});
  spec.undulation_mm = o.undulation_mm;
  spec.stream = "scenes/highway/ground";
  return std::make_shared<SectionGround>(CentreLine(l::start(o), l::pieces(o)), spec, seed);
}

/// Everything knows the ground, the line and the options.
struct Road {
  const HighwayOptions& o;
  const SectionGround& ground;
  const CentreLine& line;

  Vector3d at(double s, double d, double up = 0) const {
    const Vector2d p = line.place(s, d);
    return {p.x(), p.y(), ground.height_m(p.x(), p.y()) + up};
  }
  double heading_rad(double s) const { return line.at(s).heading_rad; }
  void found(Assembly& a, std::uint32_t mesh, Label label, double s, double d, double yaw_rad) const {
    const Vector2d p = line.place(s, d);
    a.found(mesh, label, p.x(), p.y(), heading_rad(s) + yaw_rad);
  }
};

/// The same ground a little lower: grass beside asphalt.
class Lowered final : public Ground {
 public:
  Lowered(const Ground& ground, double by_m) : ground_(&ground), by_m_(by_m) {}
  double height_m(double x_m, double y_m, Vector2d* gradient, Vector3d* hessian) const override {
    return ground_->height_m(x_m, y_m, gradient, hessian) - by_m_;
  }

 private:
  const Ground* ground_;
  double by_m_;
};

/// Grass reaches a hand's breadth under the asphalt, so that its coarser cells leave no gap.
void add_surface(Assembly& a, const Road& road) {
  constexpr double step_m = 0.03, overlap_m = 0.2;
  const double inner = l::inner_edge_m(road.o), outer = l::outer_edge_m(road.o), far = l::far_m;
  const double length = road.o.length_m;
  MeshBuilder asphalt("asphalt"), grass("grass");
  asphalt.use(asphalt_dry);
  const StripMesher fine(road.ground, road.line, 0, length, -outer, outer);
  fine.band(asphalt, -outer, -inner);
  fine.band(asphalt, inner, outer);
  grass.use(grass_green);
  const Lowered lower(road.ground, step_m);
  const StripMesher coarse(lower, road.line, 0, length, -far, far, {.sagitta_m = 0.005, .max_cell_m = 10});
  coarse.band(grass, -inner - overlap_m, inner + overlap_m);
  coarse.band(grass, outer - overlap_m, far);
  coarse.band(grass, -far, -outer + overlap_m);
  a.put(a.mesh(std::move(asphalt).build()), Label::pavement);
  a.put(a.mesh(std::move(grass).build()), Label::terrain);
}

/// A strip of paint along the line, 2 mm above the ground: more than its facets and those of the asphalt are off.
void add_line(MeshBuilder& b, const Road& road, double d, double s0, double s1, double width_m) {
  constexpr double step_m = 2, lift_m = 0.002;
  const int n = std::max(1, static_cast<int>(std::ceil((s1 - s0) / step_m)));
  std::uint32_t right = 0, left = 0;
  for (int k = 0; k <= n; ++k) {
    const double s = s0 + (s1 - s0) * k / n;
    const std::uint32_t r = b.vertex(road.at(s, d - width_m / 2, lift_m)),
                        f = b.vertex(road.at(s, d + width_m / 2, lift_m));
    if (k > 0) b.quad(right, r, f, left);
    right = r;
    left = f;
  }
}

void add_paint(Assembly& a, const Road& road) {
  MeshBuilder paint("paint");
  paint.use(paint_white_marking);
  const double first = l::inner_edge_m(road.o) + l::inner_shoulder_m;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= road.o.lanes; ++k) {
      const double d = side * (first + k * road.o.lane_m);
      if (k == 0 || k == road.o.lanes) {
        add_line(paint, road, d, 0, road.o.length_m, 0.2);
        continue;
      }
      for (double s = 2; s + 6 < road.o.length_m; s += 18) add_line(paint, road, d, s, s + 6, 0.15);
    }
  }
  a.put(a.mesh(std::move(paint).build()), Label::marking);
}

/// Rails at `d`, their faces to the traffic; posts behind them.
void add_rail(MeshBuilder& b, const Road& road, double d, bool face_left) {
  constexpr double middle_m = 0.6;
  std::vector<Vector3d> rail;
  const double s0 = l::margin_m, s1 = road.o.length_m - l::margin_m;
  const int n = static_cast<int>((s1 - s0) / road.o.post_pitch_m);
  for (int k = 0; k <= n; ++k) rail.push_back(road.at(s0 + k * road.o.post_pitch_m, d, middle_m));
  if (!face_left) std::reverse(rail.begin(), rail.end());
  add_w_beam(b, rail);
  b.use(galvanised_steel);
  for (int k = 0; k <= n; ++k) {
    const double s = s0 + k * road.o.post_pitch_m, behind = face_left ? -0.065 : 0.065;
    const Vector3d p = road.at(s, d + behind);
    b.at(place(p.x(), p.y(), p.z(), road.heading_rad(s)));
    add_box(b, {-0.03, -0.055, -0.3}, {0.03, 0.055, middle_m + 0.14});
  }
  b.at(core::SE3::Identity());
}

void add_rails(Assembly& a, const Road& road) {
  if (!road.o.guard_rails) return;
  const double inner = l::inner_edge_m(road.o) - 0.4, outer = l::outer_edge_m(road.o) + 0.3;
  MeshBuilder b("guard_rails");
  add_rail(b, road, -outer, true);
  add_rail(b, road, -inner, false);
  add_rail(b, road, inner, true);
  add_rail(b, road, outer, false);
  a.put(a.mesh(std::move(b).build()), Label::other);
}

/// Posts every 4 m, panels between them with a ribbed face.
void add_barrier(MeshBuilder& b, const Road& road, double d) {
  constexpr double pitch_m = 4, height_m = 4;
  const double s0 = l::margin_m, s1 = road.o.length_m - l::margin_m;
  for (double s = s0; s + pitch_m <= s1; s += pitch_m) {
    const Vector3d p = road.at(s, d), q = road.at(s + pitch_m, d), along = q - p;
    const double heading = std::atan2(along.y(), along.x()), length = along.head<2>().norm();
    b.at(place(p.x(), p.y(), p.z(), heading));
    b.use(galvanised_steel);
    add_box(b, {-0.09, -0.09, -0.5}, {0.09, 0.09, height_m + 0.1});
    b.use(concrete_wall);
    add_box(b, {0.09, -0.08, -0.5}, {length - 0.09, 0.08, 0.5});
    b.use(wood);
    const double rise = along.z();  // panels stand level; the step between them follows the grade
    add_box(b, {0.09, -0.06, 0.5}, {length - 0.09, 0.06, height_m + std::max(0.0, rise) * 0.5});
    for (double x = 0.3; x + 0.3 < length; x += 0.4) {
      for (const double y : {-0.085, 0.06}) add_box(b, {x, y, 0.55}, {x + 0.12, y + 0.025, height_m - 0.05});
    }
  }
  b.at(core::SE3::Identity());
}

void add_barriers(Assembly& a, const Road& road) {
  const std::string& where = road.o.noise_barrier;
  if (where == "none") return;
  MeshBuilder b("noise_barrier");
  const double d = l::outer_edge_m(road.o) + 2.6;
  if (where != "left") add_barrier(b, road, -d);
  if (where != "right") add_barrier(b, road, d);
  a.put(a.mesh(std::move(b).build()), Label::building);
}

/// A truss over the right carriageway on two legs, with panels above the lanes. Frame: origin in the middle of the
/// carriageway, x along the road; `width_m` between the legs; the legs' feet lie `right_drop_m` and `left_drop_m`
/// below.
void add_gantry(MeshBuilder& b, int lanes, double lane_m, double width_m, double right_drop_m, double left_drop_m) {
  constexpr double clear_m = 5.6, depth_m = 1.4;
  const double half = width_m / 2;
  b.use(galvanised_steel);
  for (const auto& [y, drop] : {std::pair{-half, right_drop_m}, {half, left_drop_m}}) {
    add_box(b, {-0.2, y - 0.2, -drop - 0.5}, {0.2, y + 0.2, clear_m + depth_m});
  }
  for (const double x : {-0.4, 0.4}) {
    for (const double z : {clear_m, clear_m + depth_m}) add_beam(b, {x, -half, z}, {x, half, z}, 0.12, 0.12);
    const int panels = std::max(4, static_cast<int>(width_m / 1.5));
    for (int k = 0; k < panels; ++k) {
      const double y = -half + width_m * k / panels, next = -half + width_m * (k + 1) / panels;
      add_beam(b, {x, y, k % 2 == 0 ? clear_m : clear_m + depth_m}, {x, next, k % 2 == 0 ? clear_m + depth_m : clear_m},
               0.06, 0.06);
    }
  }
  for (const double y : {-half, half}) {
    for (const double z : {clear_m, clear_m + depth_m}) add_beam(b, {-0.4, y, z}, {0.4, y, z}, 0.12, 0.12);
  }
  for (int k = 0; k < lanes; ++k) {
    const double y = (k - 0.5 * (lanes - 1)) * lane_m, w = 0.42 * lane_m;
    b.use(painted_steel);
    add_box(b, {-0.56, y - w, clear_m - 0.1}, {-0.48, y + w, clear_m + 2.2});
    b.use(retro_sheeting_ra1);
    add_box(b, {-0.565, y - w + 0.05, clear_m}, {-0.56, y + w - 0.05, clear_m + 2.1});
  }
}

void add_gantries(Assembly& a, const Road& road) {
  if (road.o.gantry_pitch_m <= 0) return;
  const double right = -l::outer_edge_m(road.o) - 1.0, left = 0, middle = (right + left) / 2;
  for (double s = 0.4 * road.o.gantry_pitch_m; s < road.o.length_m - l::margin_m; s += road.o.gantry_pitch_m) {
    const double z = road.at(s, middle).z();
    const std::uint32_t gantry = a.mesh("gantry", [&](MeshBuilder& b) {
      add_gantry(b, road.o.lanes, road.o.lane_m, left - right, z - road.at(s, right).z(), z - road.at(s, left).z());
    });
    road.found(a, gantry, Label::sign, s, middle, 0);
  }
}

void add_roadside(Assembly& a, const Road& road, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/highway/roadside");
  const double outer = l::outer_edge_m(road.o), length = road.o.length_m;
  if (road.o.sign_pitch_m > 0) {
    const std::uint32_t panel = a.mesh("panel_sign", [](MeshBuilder& b) { add_panel_sign(b, 3.2, 2.2, 1.7); });
    for (double s = 0.7 * road.o.sign_pitch_m; s < length - l::margin_m; s += road.o.sign_pitch_m) {
      road.found(a, panel, Label::sign, s, -outer - 4.6, 0);
      road.found(a, panel, Label::sign, s + 0.3 * road.o.sign_pitch_m, outer + 4.6, pi);
    }
  }
  if (road.o.delineator_pitch_m > 0) {
    const std::uint32_t post = a.mesh("delineator", add_delineator);
    for (double s = l::margin_m; s < length - l::margin_m; s += road.o.delineator_pitch_m) {
      for (const double d : {-outer - 0.75, outer + 0.75}) road.found(a, post, Label::sign, s, d, 0);
    }
  }
  if (road.o.parked_vehicles > 0) {
    const std::uint32_t van = a.mesh("van", [](MeshBuilder& b) { add_car(b, CarShape::van, gse_paint_white); });
    const std::uint32_t car = a.mesh("car", [](MeshBuilder& b) { add_car(b, CarShape::saloon, car_paint_dark); });
    for (int k = 0; k < road.o.parked_vehicles; ++k) {
      const auto i = static_cast<std::uint64_t>(k);
      const double s = length * (k + 0.3 + 0.4 * random.uniform(i, 0)) / road.o.parked_vehicles;
      const Vector2d p = road.line.place(s, -outer + 1.15);
      a.stand(k % 2 == 0 ? van : car, Label::vehicle, p.x(), p.y(), road.heading_rad(s) + 0.02 * random.uniform(i, 1));
    }
  }
}

void add_trees(Assembly& a, const Road& road, std::uint64_t seed) {
  if (road.o.trees == 0) return;
  const core::RandomStream random(seed, "scenes/highway/trees");
  constexpr int shapes = 5;
  std::vector<std::uint32_t> trees;
  for (int k = 0; k < shapes; ++k) {
    const TreeShape shape{.height_m = 7.0 + 1.5 * k,
                          .crown_radius_m = 2.0 + 0.4 * k,
                          .crown_from_m = 2,
                          .leaves = 420,
                          .leaf_m = 0.34,
                          .conifer = k % 2 == 1};
    trees.push_back(a.mesh("tree", [&](MeshBuilder& b) { add_tree(b, shape, seed, 200 + k); }));
  }
  const double nearest = l::outer_edge_m(road.o) + l::verge_m + 5;
  for (int k = 0; k < road.o.trees; ++k) {
    const auto draw = [&](std::uint32_t j) { return random.uniform(static_cast<std::uint64_t>(k), j); };
    const double s = l::margin_m + (road.o.length_m - 2 * l::margin_m) * draw(0);
    const double d = (k % 2 == 0 ? -1 : 1) * (nearest + (l::far_m - 3 - nearest) * draw(1));
    road.found(a, trees[static_cast<std::size_t>(draw(2) * shapes)], Label::tree, s, d, 2 * pi * draw(3));
  }
}

std::shared_ptr<const Relief> make_texture(const HighwayOptions& o, std::uint64_t seed) {
  PavingSpec spec;
  spec.relief_rms_mm = o.relief_rms_mm;
  spec.joint_depth_mm = 0;
  spec.stream = "scenes/highway";
  return std::make_shared<SlabRelief>(spec, seed);
}

Scene make_highway(const HighwayOptions& o, std::uint64_t seed) {
  Scene scene;
  scene.name = "highway";
  scene.materials = materials();
  const std::shared_ptr<const SectionGround> ground = make_road(o, seed);
  scene.ground = ground;
  if (o.relief_rms_mm > 0) scene.relief = make_texture(o, seed);
  const Road road{o, *ground, ground->line()};
  const Vector2d shown = road.line.place(0.4 * o.gantry_pitch_m + 40, 0);
  scene.interest_min = shown - Vector2d(90, 45);
  scene.interest_max = shown + Vector2d(90, 45);
  Assembly a(scene, *ground);
  add_surface(a, road);
  add_paint(a, road);
  add_rails(a, road);
  add_barriers(a, road);
  add_gantries(a, road);
  add_roadside(a, road, seed);
  add_trees(a, road, seed);
  return scene;
}

HighwayOptions read(const core::ConfigNode& node) {
  HighwayOptions o = read_scene_options<HighwayOptions>(node);
  const double straight_m = l::pieces(o).front().straight_m;
  const double arc_m = o.turn_deg * pi / 180 * o.radius_m;
  if (o.turn_deg > 0 && (straight_m < 20 || arc_m < l::blend_m)) {
    node.fail_at("turn_deg",
                 "two such bends do not fit this length, or turn too little for their easing of 120 m: "
                 "change length_m, radius_m or turn_deg");
  }
  return o;
}

}  // namespace

extern const SceneEntry highway;
const SceneEntry highway{
    .name = "highway",
    .summary = "two carriageways with guard rails, gantries, signs, trees; bends and grade are gentle",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_highway(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return make_road(read(node), seed);
    },
    .describe = [] { return core::describe_options<HighwayOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: highway\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
