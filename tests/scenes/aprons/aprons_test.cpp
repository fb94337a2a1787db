/// Pier, remote stands, open apron, hangar and cargo yard: the laws of every scene, and what is theirs alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <unordered_map>

#include "core/error.h"
#include "scenes/cargo_yard/layout.h"
#include "scenes/cargo_yard/parts.h"
#include "scenes/hangar/layout.h"
#include "scenes/open_apron/layout.h"
#include "scenes/pier/layout.h"
#include "scenes/remote_stand/layout.h"
#include "tests/scenes/laws.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;
using namespace tests;

const std::vector<std::string> kinds{"open-apron", "pier", "remote-stand", "hangar", "cargo-yard"};

/// Each kind with its defaults and seed 1, built once.
const Scene& scene_of_kind(const std::string& kind) {
  static std::map<std::string, Scene> made;
  const auto found = made.find(kind);
  return found != made.end() ? found->second : made[kind] = make_scene(laws::node_of(kind), 1);
}

std::vector<Vector2d> with_points_between(const std::vector<Vector2d>& line) {
  constexpr double step_m = 0.5;
  std::vector<Vector2d> points;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const int n = static_cast<int>(std::ceil((line[k + 1] - line[k]).norm() / step_m));
    for (int i = 0; i < n; ++i) points.push_back(line[k] + (line[k + 1] - line[k]) * i / n);
  }
  points.push_back(line.back());
  return points;
}

std::vector<std::vector<Vector2d>> lanes_of(const std::string& kind) {
  if (kind == "open-apron") return {open_apron::lane_centre_line(0.5)};
  if (kind == "pier") return pier_lanes({});
  if (kind == "remote-stand") return remote_lanes({});
  if (kind == "hangar") return {hangar_lane({})};
  return {cargo_lane({})};
}

class Apron : public testing::TestWithParam<std::string> {};

TEST_P(Apron, GroundAloneIsTheScenesGround) {
  laws::ground_alone_is_the_scenes_ground(GetParam(), scene_of_kind(GetParam()));
}

/// What stands on wheels or feet touches the ground: what the base's curvature over its footprint allows (bounded by
/// the ground's own figure), and no more.
TEST_P(Apron, NothingFloatsOrSinks) {
  const Scene& scene = scene_of_kind(GetParam());
  const auto* ground = dynamic_cast<const WavyGround*>(scene.ground.get());
  ASSERT_NE(ground, nullptr);
  const double curvature_per_m = ground->bounds().curvature_per_m;
  std::size_t tested = 0;
  for (const Instance& instance : scene.instances) {
    const bool stands = instance.label == Label::ground_equipment || instance.label == Label::vehicle ||
                        instance.label == Label::cone || instance.label == Label::person ||
                        instance.label == Label::aircraft;
    if (!stands) continue;
    const Mesh& mesh = scene.meshes[instance.mesh];
    const bool on_a_bed = mesh.name == "container" || mesh.name == "containers_stacked";
    double lowest = 1e9, reach = 0;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      const Vector3d p = instance.T_parent_mesh * v.cast<double>();
      const double lift = on_a_bed ? kRollerBedHeight_m : 0;
      const double gap = p.z() - scene.ground->height_m(p.x(), p.y()) - lift;
      if (gap < 0.3) reach = std::max(reach, static_cast<double>(v.head<2>().norm()));
      lowest = std::min(lowest, gap);
    }
    // An aircraft stands on three legs, each on the ground, but not its origin.
    const double radius = instance.label == Label::aircraft ? 0.5 * reach : reach;
    const double allowed = 0.004 + 0.5 * curvature_per_m * radius * radius;
    EXPECT_LT(std::abs(lowest), std::max(allowed, mesh.name == "docking" ? 0.05 : 0.0))
        << mesh.name << " at " << instance.T_parent_mesh.translation().transpose();
    EXPECT_LT(std::abs(lowest), 0.06) << mesh.name;
    ++tested;
  }
  EXPECT_GT(tested, 10U);
}

/// Boxes around what stands about, each in its own axes, shrunk by what couplings and canopies may overlap.
struct Footprint {
  std::string mesh;
  Vector2d centre, axis_x, axis_y, half;
  double low_z, high_z;
};

std::vector<Footprint> footprints(const Scene& scene) {
  constexpr double coupling_m = 0.2;
  std::vector<Footprint> list;
  for (const Instance& i : scene.instances) {
    if (i.label != Label::ground_equipment && i.label != Label::vehicle && i.label != Label::cone &&
        i.label != Label::person && i.label != Label::mast)
      continue;
    const Mesh& mesh = scene.meshes[i.mesh];
    if (mesh.name == "docking") continue;  // hollow
    Eigen::Vector3f low = mesh.vertices.front(), high = low;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      if (i.label == Label::mast && v.z() > 3) continue;
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const Vector3d centre = i.T_parent_mesh * (0.5 * (low + high)).cast<double>();
    const Eigen::Matrix3d& R = i.T_parent_mesh.linear();
    const Vector2d half = (0.5 * (high - low)).cast<double>().head<2>().array() - coupling_m;
    if (half.minCoeff() <= 0) continue;
    list.push_back({mesh.name, centre.head<2>(), R.col(0).head<2>().normalized(), R.col(1).head<2>().normalized(), half,
                    centre.z() - 0.5 * static_cast<double>(high.z() - low.z()),
                    centre.z() + 0.5 * static_cast<double>(high.z() - low.z())});
  }
  return list;
}

/// Separating axes of two rectangles.
bool overlap(const Footprint& a, const Footprint& b) {
  const Vector2d d = b.centre - a.centre;
  for (const Vector2d& axis : {a.axis_x, a.axis_y, b.axis_x, b.axis_y}) {
    const double reach = a.half.x() * std::abs(axis.dot(a.axis_x)) + a.half.y() * std::abs(axis.dot(a.axis_y)) +
                         b.half.x() * std::abs(axis.dot(b.axis_x)) + b.half.y() * std::abs(axis.dot(b.axis_y));
    if (std::abs(d.dot(axis)) > reach) return false;
  }
  return true;
}

/// A container on its roller bed, a bar between tractor and nose wheel.
bool may_touch(const Footprint& a, const Footprint& b) {
  const auto is = [&](const std::string& x, const std::string& y) {
    return (a.mesh.starts_with(x) && b.mesh.starts_with(y)) || (b.mesh.starts_with(x) && a.mesh.starts_with(y));
  };
  return is("roller_bed", "container") || is("towbar", "pushback") || is("towbar", "chock");
}

TEST_P(Apron, NothingStandsInsideAnotherThing) {
  std::string options;
  if (GetParam() == "pier" || GetParam() == "remote-stand") options = "equipment_density: 2\n";
  if (GetParam() == "open-apron") options = "clutter_per_ha: 40\n";
  for (const std::uint64_t seed : {1, 2}) {
    const std::vector<Footprint> all = footprints(make_scene(laws::node_of(GetParam(), options), seed));
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        if (may_touch(all[i], all[j]) || !overlap(all[i], all[j])) continue;
        ADD_FAILURE() << "seed " << seed << ": " << all[i].mesh << " and " << all[j].mesh << " at "
                      << all[i].centre.transpose() << " and " << all[j].centre.transpose();
      }
    }
  }
}

/// Points of lanes by square cells, so that each of half a million triangles asks those near it only.
class LanePoints {
 public:
  static constexpr double reach_m = 3;
  explicit LanePoints(const std::vector<std::vector<Vector2d>>& lanes) {
    for (const auto& lane : lanes) {
      for (const Vector2d& p : with_points_between(lane)) cells_[cell(p.x(), p.y())].push_back(p);
    }
  }
  /// Distance to the outline where it is below reach_m, else reach_m.
  double distance(const std::vector<Vector2d>& outline) const {
    Vector2d low = outline.front(), high = low;
    for (const Vector2d& p : outline) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    double nearest = reach_m;
    for (double x = low.x() - reach_m; x < high.x() + 2 * reach_m; x += reach_m) {
      for (double y = low.y() - reach_m; y < high.y() + 2 * reach_m; y += reach_m) {
        const auto found = cells_.find(cell(x, y));
        if (found == cells_.end()) continue;
        for (const Vector2d& p : found->second) nearest = std::min(nearest, distance_to_outline(p, outline));
      }
    }
    return nearest;
  }

 private:
  static std::int64_t cell(double x, double y) {
    return static_cast<std::int64_t>(std::floor(x / reach_m)) * 1'000'003 +
           static_cast<std::int64_t>(std::floor(y / reach_m));
  }
  std::unordered_map<std::int64_t, std::vector<Vector2d>> cells_;
};

TEST_P(Apron, LanesAreFree) {
  const Scene& scene = scene_of_kind(GetParam());
  const LanePoints lanes(lanes_of(GetParam()));
  double clearance = LanePoints::reach_m;
  std::string what = "anything";
  for_each_static_triangle(
      scene, [](const Instance& i) { return !on_the_ground(i.label); },
      [&](const Instance& instance, const Triangle& t) {
        const std::vector<Vector2d> outline = outline_between(t, *scene.ground, 0.15, 2.6);
        if (outline.empty()) return;
        const double distance = lanes.distance(outline);
        if (distance < clearance) what = scene.meshes[instance.mesh].name;
        clearance = std::min(clearance, distance);
      });
  std::cout << GetParam() << ": " << clearance << " m to " << what << "\n";
  EXPECT_GE(clearance, 1.5) << what;
}

std::string name_of_case(const testing::TestParamInfo<std::string>& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, Apron, testing::ValuesIn(kinds), name_of_case);

std::string message_of(const std::string& yaml) {
  try {
    make_scene(core::ConfigNode::parse(yaml, "scenario.yaml"), 1);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Aprons, WhatDoesNotFitIsAnErrorThatSaysWhereAndWhatToDo) {
  const std::map<std::string, std::string> wrong{{"kind: pier\ncodes: CX\n", "letters C and E"},
                                                 {"kind: pier\ncodes: E\npier_length_m: 100\n", "too short"},
                                                 {"kind: remote-stand\ntypes: [a320, a321]\n", "a321"},
                                                 {"kind: remote-stand\ntypes: []\n", "one to"},
                                                 {"kind: open-apron\nfacade_distance_m: 5\n", "at least 12"},
                                                 {"kind: hangar\naircraft: b777-300er\n", "width_m"},
                                                 {"kind: hangar\ndoor_width_m: 54.5\n", "door_width_m"},
                                                 {"kind: hangar\ndoor_height_m: 15.8\n", "door_height_m"},
                                                 {"kind: hangar\ndepth_m: 46\n", "depth_m"},
                                                 {"kind: cargo-yard\nfreighter: b747\n", "b747"}};
  for (const auto& [yaml, expected] : wrong) {
    const std::string message = message_of(yaml);
    EXPECT_THAT(message, HasSubstr("scenario.yaml")) << yaml;
    EXPECT_THAT(message, HasSubstr(expected)) << yaml;
  }
}

std::size_t instances_of(const Scene& scene, Label label) {
  return static_cast<std::size_t>(
      std::ranges::count_if(scene.instances, [&](const Instance& i) { return i.label == label; }));
}

TEST(OpenApron, WithBothDialsAtTheirEndHasNothingButGround) {
  const Scene bare =
      make_scene(laws::node_of("open-apron", "clutter_per_ha: 0\nfacade_distance_m: 0\nwith_markings: false\n"), 1);
  for (const Instance& i : bare.instances) EXPECT_TRUE(on_the_ground(i.label)) << bare.meshes[i.mesh].name;
}

using Places = std::set<std::tuple<std::string, double, double>>;

Places clutter_of(const std::string& density, std::uint64_t seed) {
  const Scene scene =
      make_scene(laws::node_of("open-apron", "facade_distance_m: 0\nclutter_per_ha: " + density + "\n"), seed);
  Places places;
  for (const Instance& i : scene.instances) {
    if (on_the_ground(i.label)) continue;
    places.emplace(scene.meshes[i.mesh].name, i.T_parent_mesh.translation().x(), i.T_parent_mesh.translation().y());
  }
  return places;
}

/// The field is 414 x 301.5 m = 12.48 ha, of which the lane's strip of 8 m takes 365.7 m x 8 m and the circles of what
/// would stand too near to it some more: between 0.85 and 1 of the density times the field must be there.
TEST(OpenApron, ClutterHasTheDensityAskedForAndMoreOfItContainsLess) {
  const double field_ha =
      (open_apron::east_m - open_apron::west_m - 6) * (open_apron::north_m - open_apron::south_m - 6) / 1e4;
  for (const std::uint64_t seed : {1, 2}) {
    const Places few = clutter_of("3", seed), many = clutter_of("12", seed);
    for (const auto& [places, density] : {std::pair{&few, 3.0}, {&many, 12.0}}) {
      EXPECT_LE(static_cast<double>(places->size()), density * field_ha + 1);
      EXPECT_GE(static_cast<double>(places->size()), 0.8 * density * field_ha);
    }
    EXPECT_TRUE(std::ranges::includes(many, few)) << "thinning out moved something";
  }
}

TEST(OpenApron, FacadeStandsAsFarFromTheLaneAsAsked) {
  for (const double distance : {20.0, 75.0}) {
    const Scene scene = make_scene(
        laws::node_of("open-apron", "clutter_per_ha: 0\nfacade_distance_m: " + std::to_string(distance) + "\n"), 1);
    double nearest = 1e9;
    for_each_static_triangle(
        scene, [](const Instance& i) { return i.label == Label::glass; },
        [&](const Instance&, const Triangle& t) {
          for (const Vector3d& p : t) nearest = std::min(nearest, p.y());
        });
    // Panes of the stair towers stand 0.6 m in front of the façade's plane.
    EXPECT_NEAR(nearest, distance - 0.6, 1e-3);
  }
}

TEST(RemoteStand, TakesAnA380AndLeavesItRoom) {
  RemoteStandOptions options;
  options.types = {"a380", "a320"};
  const RemoteLayout l = remote_layout(options);
  EXPECT_GE(2 * l.stands[0].half_width_m, aircraft_type("a380").span_m + 7.5);  // clearance of code F
  EXPECT_GE(2 * l.stands[1].half_width_m, aircraft_type("a320").span_m + 4.5);
  EXPECT_EQ(instances_of(make_scene(laws::node_of("remote-stand", "types: [a380]\n"), 1), Label::aircraft), 1U);
}

TEST(Hangar, TakesAWideBodyWhenItIsMadeLargeEnough) {
  const std::string options =
      "aircraft: b777-300er\nwidth_m: 90\ndepth_m: 92\ndoor_width_m: 80\ndoor_height_m: 21\neaves_m: 24\n";
  EXPECT_EQ(instances_of(make_scene(laws::node_of("hangar", options), 1), Label::aircraft), 1U);
}

}  // namespace
}  // namespace tarmac::scenes
