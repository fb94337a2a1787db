// Streets around a block of town houses. Layout: README.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/outdoors/outdoors.h"
#include "scenes/primitives/ground_patch.h"
#include "scenes/registry.h"
#include "scenes/urban_block/houses.h"
#include "scenes/urban_block/layout.h"

namespace tarmac::scenes {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;
namespace l = urban_layout;

constexpr double pi = std::numbers::pi;
constexpr double kCorner_m = 2.0;  ///< radius of the kerb at a junction

/// A side of a block: from `start` along `ahead` for `length_m`, the houses to the left, the street to the right.
struct Side {
  Vector2d start, ahead;
  double length_m;
  bool on_street;
  Vector2d out() const { return {ahead.y(), -ahead.x()}; }
  double heading_rad() const { return std::atan2(ahead.y(), ahead.x()); }
};

std::array<Side, 4> sides(const l::Block& b, int i, int j) {
  const Vector2d size = b.high_m - b.low_m;
  return {Side{b.low_m, {1, 0}, size.x(), j > -1}, Side{{b.high_m.x(), b.low_m.y()}, {0, 1}, size.y(), i < 1},
          Side{b.high_m, {-1, 0}, size.x(), j < 1}, Side{{b.low_m.x(), b.high_m.y()}, {0, -1}, size.y(), i > -1}};
}

template <class F>
void for_each_block(const UrbanBlockOptions& o, const F& f) {
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) f(l::block(o, i, j), i, j);
  }
}

/// Rows along x take the corners of a block; those along y begin and end a house's depth further in.
void add_houses(Assembly& a, const UrbanBlockOptions& o, const Ground& ground, std::uint64_t seed) {
  int row = 0;
  for_each_block(o, [&](const l::Block& block, int i, int j) {
    const std::array<Side, 4> all = sides(block, i, j);
    for (std::size_t k = 0; k < 4; ++k) {
      const Side& side = all[k];
      ++row;
      if (!side.on_street) continue;
      const bool inset = k % 2 == 1;
      const double first = inset && all[k - 1].on_street ? house_depth_m : 0;
      const double last = inset && all[(k + 1) % 4].on_street ? house_depth_m : 0;
      const Vector2d start = side.start + first * side.ahead;
      const Vector2d middle = start + 0.5 * (side.length_m - first - last) * side.ahead;
      MeshBuilder walls("houses"), glass("house_glass");
      add_house_row(walls, glass, side.length_m - first - last, o.storeys, row, seed);
      const double z = ground.height_m(middle.x(), middle.y()) + 1e-3 * o.kerb_mm;
      const core::SE3 T = place(start.x(), start.y(), z, side.heading_rad());
      a.put(a.mesh(std::move(walls).build()), Label::building, T);
      a.put(a.mesh(std::move(glass).build()), Label::glass, T);
    }
  });
}

/// Outline of a block widened by `out_m`, its corners rounded, counter-clockwise, points at most 2 m apart; every
/// outline of a block has the same number of points, so that strips between two of them can be stitched.
std::vector<Vector2d> outline(const l::Block& b, double out_m, double radius_m) {
  const Vector2d low = b.low_m - Vector2d::Constant(out_m), high = b.high_m + Vector2d::Constant(out_m);
  const std::array<Vector2d, 4> corner{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  const std::array<Vector2d, 4> ahead{Vector2d(1, 0), {0, 1}, {-1, 0}, {0, -1}};
  const Vector2d size = b.high_m - b.low_m;
  std::vector<Vector2d> points;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d from = corner[k] + radius_m * ahead[k], to = corner[(k + 1) % 4] - radius_m * ahead[k];
    const int n = static_cast<int>(std::ceil(size[k % 2] / 2));
    for (int i = 0; i <= n; ++i) points.push_back(from + (to - from) * i / n);
    const Vector2d centre = to + radius_m * ahead[(k + 1) % 4];
    constexpr int arc = 6;
    for (int i = 1; i < arc; ++i) {
      const double angle = 0.5 * pi * i / arc;
      points.push_back(centre + radius_m * (std::sin(angle) * ahead[k] - std::cos(angle) * ahead[(k + 1) % 4]));
    }
  }
  return points;
}

/// Kerb and sidewalk around each block.
void add_sidewalks(Assembly& a, const UrbanBlockOptions& o, const Ground& ground) {
  MeshBuilder b("sidewalks");
  const double rise = 1e-3 * o.kerb_mm;
  for_each_block(o, [&](const l::Block& block, int, int) {
    struct Line {
      double out_m, radius_m, lift_m;
    };
    // From the street inwards: foot and head of the kerb, its back, the middle of the sidewalk, under the houses.
    const std::array<Line, 5> lines{Line{o.sidewalk_m + 0.01, kCorner_m, -0.05},
                                    {o.sidewalk_m, kCorner_m, rise},
                                    {o.sidewalk_m - 0.15, kCorner_m - 0.1, rise},
                                    {0.5 * o.sidewalk_m, 0.5, rise},
                                    {-0.1, 0.01, rise}};
    std::vector<std::uint32_t> outer;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      std::vector<std::uint32_t> inner;
      for (const Vector2d& p : outline(block, lines[n].out_m, lines[n].radius_m)) {
        inner.push_back(b.vertex({p.x(), p.y(), ground.height_m(p.x(), p.y()) + lines[n].lift_m}));
      }
      b.use(n <= 2 ? concrete_wall : concrete_dry);
      for (std::size_t k = 0; n > 0 && k < inner.size(); ++k) {
        const std::size_t next = (k + 1) % inner.size();
        b.quad(outer[k], outer[next], inner[next], inner[k]);
      }
      outer = std::move(inner);
    }
  });
  a.put(a.mesh(std::move(b).build()), Label::pavement);
}

/// Asphalt under everything, in cells that keep within 0.1 mm of the ground.
void add_streets(Assembly& a, const UrbanBlockOptions& o, const Ground& ground) {
  MeshBuilder asphalt("asphalt"), paint("paint");
  asphalt.use(asphalt_dry);
  const Vector2d far = l::half_world(o);
  constexpr double cell_m = 1.5;
  add_ground_patch(asphalt, ground, -far, far, cell_m);
  a.put(a.mesh(std::move(asphalt).build()), Label::pavement);

  paint.use(paint_white_marking);
  const Vector2d centre = l::street_centre(o);
  const auto mark = [&](int axis, double across, double from, double to, double width) {
    Vector2d low, high;
    low[axis] = from;
    high[axis] = to;
    low[1 - axis] = across - width / 2;
    high[1 - axis] = across + width / 2;
    add_ground_patch(paint, ground, low, high, 0.75, 0.0015);
  };
  for (int axis = 0; axis < 2; ++axis) {
    const double junction = l::street_m(o) / 2;
    for (const double across : {-centre[1 - axis], centre[1 - axis]}) {
      for (double s = -far[axis] + 3; s + 3 < far[axis]; s += 9) {  // dashes, but not on the junctions
        if (std::abs(std::abs(s + 1.5) - centre[axis]) < junction + 1.5) continue;
        mark(axis, across, s, s + 3, 0.12);
      }
      for (const double side : {-1.0, 1.0}) {  // the edge of the parking lane along the middle block
        const double half = l::half_block(o)[axis] - 8;
        mark(axis, across + side * o.carriageway_m / 2, -half, half, 0.1);
      }
    }
  }
  a.put(a.mesh(std::move(paint).build()), Label::marking);
}

/// Everything along the kerbs: cars in their places, trees, lamps, and at the ends of a side signs, bollards, bins.
class KerbSide {
 public:
  KerbSide(Assembly& a, const UrbanBlockOptions& o, const Ground& ground, std::uint64_t seed)
      : assembly_(&a), options_(&o), ground_(&ground), random_(seed, "scenes/urban_block/kerbside") {
    constexpr MaterialId paints[] = {gse_paint_white, car_paint_dark, gse_paint_blue, aircraft_grey};
    for (const CarShape shape : {CarShape::hatchback, CarShape::saloon, CarShape::van}) {
      for (const MaterialId paint : paints) {
        cars_.push_back(a.mesh("car", [&](MeshBuilder& b) { add_car(b, shape, paint); }));
      }
    }
    for (int k = 0; k < 4; ++k) {
      trees_.push_back(a.mesh("tree", [&](MeshBuilder& b) {
        add_tree(b, {.height_m = 6.5 + 0.9 * k, .crown_radius_m = 1.5 + 0.15 * k, .leaves = 420, .leaf_m = 0.3}, seed,
                 k);
      }));
    }
    lamp_ = a.mesh("street_lamp", [](MeshBuilder& b) { add_street_lamp(b, 7, 1.6); });
    sign_ = a.mesh("round_sign", add_round_sign);
    bollard_ = a.mesh("bollard", add_bollard);
    bin_ = a.mesh("litter_bin", add_litter_bin);
    bench_ = a.mesh("bench", add_bench);
  }

  void furnish(const Side& side) {
    for (double s = 9; s + 9 < side.length_m; s += 6.4) park_car(side, s + 3.2);
    const double kerb = options_->sidewalk_m - 0.6;
    if (options_->tree_pitch_m > 0) {
      for (double s = 6; s + 5 < side.length_m; s += options_->tree_pitch_m) {
        const double kind = draw(), along = draw(), turn = draw();  // one after the other: arguments have no order
        put(trees_[static_cast<std::size_t>(4 * kind)], Label::tree, side, s + 1.5 * along, kerb, 2 * pi * turn);
      }
    }
    if (options_->lamp_pitch_m > 0) {
      for (double s = 3; s + 2 < side.length_m; s += options_->lamp_pitch_m) {
        put(lamp_, Label::mast, side, s, kerb + 0.1, -0.5 * pi);
      }
    }
    put(sign_, Label::sign, side, 1.2, kerb, 0);
    const double bin_along = draw(), bin_turn = draw();
    put(bin_, Label::other, side, 4.4 + 0.4 * bin_along, kerb, 0.2 * bin_turn);
    put(bench_, Label::other, side, 0.5 * side.length_m + 3 * draw(), kerb - 0.4, -0.5 * pi);
    for (int k = 0; k < 3; ++k) put(bollard_, Label::other, side, side.length_m - 0.8 - 1.2 * k, kerb + 0.3, 0);
  }

 private:
  double draw() { return random_.uniform(drawn_++); }
  /// `out_m` from the houses' faces; upon the sidewalk. Headings count from that of the side.
  void put(std::uint32_t mesh, Label label, const Side& side, double along_m, double out_m, double yaw_rad) {
    const Vector2d p = side.start + along_m * side.ahead + out_m * side.out();
    const double z = ground_->height_m(p.x(), p.y()) + 1e-3 * options_->kerb_mm;
    assembly_->put(mesh, label, place(p.x(), p.y(), z, side.heading_rad() + yaw_rad));
  }
  void park_car(const Side& side, double along_m) {
    const bool taken = draw() < options_->parked_share;
    const std::uint32_t car = cars_[static_cast<std::size_t>(draw() * static_cast<double>(cars_.size()))];
    const double off = 0.5 * (draw() - 0.5), yaw = 0.04 * (draw() - 0.5);
    if (!taken) return;
    const Vector2d p =
        side.start + (along_m + off) * side.ahead + (options_->sidewalk_m + 0.5 * l::parking_m + 0.01) * side.out();
    // Cars stand the way traffic goes on their side of the street: it keeps right, and the houses are to the left.
    assembly_->stand(car, Label::vehicle, p.x(), p.y(), side.heading_rad() + pi + yaw);
  }

  Assembly* assembly_;
  const UrbanBlockOptions* options_;
  const Ground* ground_;
  core::RandomStream random_;
  std::uint64_t drawn_ = 0;
  std::vector<std::uint32_t> cars_, trees_;
  std::uint32_t lamp_ = 0, sign_ = 0, bollard_ = 0, bin_ = 0, bench_ = 0;
};

Scene make_urban_block(const UrbanBlockOptions& o, std::uint64_t seed) {
  Scene scene;
  scene.name = "urban-block";
  scene.materials = materials();
  const Vector2d shown = l::street_centre(o) + Vector2d::Constant(12);
  scene.interest_min = -shown;
  scene.interest_max = shown;
  const auto ground = std::make_shared<WavyGround>(o.paving(), seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(o.paving(), seed);
  Assembly a(scene, *ground);
  add_streets(a, o, *ground);
  add_sidewalks(a, o, *ground);
  add_houses(a, o, *ground, seed);
  KerbSide kerbside(a, o, *ground, seed);
  for_each_block(o, [&](const l::Block& block, int i, int j) {
    for (const Side& side : sides(block, i, j)) {
      if (side.on_street) kerbside.furnish(side);
    }
  });
  return scene;
}

UrbanBlockOptions read(const core::ConfigNode& node) {
  return read_scene_options<UrbanBlockOptions>(node);
}

}  // namespace

extern const SceneEntry urban_block;
const SceneEntry urban_block{
    .name = "urban-block",
    .summary = "streets around a block of town houses: windows, doors, kerbs, parked cars, trees, lamps",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_urban_block(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(read(node).paving(), seed);
    },
    .describe = [] { return core::describe_options<UrbanBlockOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: urban-block\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
