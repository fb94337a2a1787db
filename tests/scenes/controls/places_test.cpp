// What each control is for: lanes are free, things stand on their ground, and the geometry is what the layout says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "scenes/highway/layout.h"
#include "scenes/hills/ground.h"
#include "scenes/paving/section_ground.h"
#include "scenes/urban_block/layout.h"
#include "scenes/warehouse/layout.h"
#include "tests/scenes/laws.h"
#include "tests/support/numeric.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
namespace laws = tests::laws;

std::vector<Vector2d> line(const Vector2d& from, const Vector2d& to) {
  std::vector<Vector2d> points;
  const int n = static_cast<int>((to - from).norm() / 0.5) + 1;
  for (int k = 0; k <= n; ++k) points.push_back(from + (to - from) * k / n);
  return points;
}

bool is(const Scene& scene, const Instance& i, const char* mesh) {
  return scene.meshes[i.mesh].name == mesh;
}

TEST(Corridor, BareItHasNothingThatTellsThePlaceAlongItsAxis) {
  const Scene scene = make_scene(
      laws::node_of("corridor", "door_pitch_m: 0\nlight_pitch_m: 0\nfeatures_per_10m: 0\nfloor_undulation_mm: 0\n"), 1);
  int along = 0;
  tests::for_each_static_triangle(
      scene, [](const Instance&) { return true; },
      [&](const Instance&, const tests::Triangle& t) {
        const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        if (std::abs(normal.x()) < 1e-9) return;
        ++along;
        EXPECT_GE((t[0] + t[1] + t[2]).x() / 3 * (t[0].x() > 0 ? 1 : -1), 59.9) << "only the ends face along the axis";
      });
  EXPECT_GT(along, 0) << "the ends do";
}

TEST(Corridor, WhatHangsOnTheWallsLeavesTheMiddleFree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = make_scene(laws::node_of("corridor", "features_per_10m: 12\n"), seed);
    EXPECT_GT(laws::clearance_m(scene, line({-58, 0}, {58, 0}), 4), 1.3) << seed;
  }
}

TEST(Corridor, DoorsLieInRecessesAndFeaturesDoNotCoverThem) {
  const Scene scene = make_scene(laws::node_of("corridor"), 1);
  std::size_t features = 0;
  for (const Instance& i : scene.instances) features += is(scene, i, "wall_features");
  EXPECT_EQ(features, 2u) << "both walls have some";
  const Scene plain = make_scene(laws::node_of("corridor", "door_pitch_m: 0\n"), 1);
  EXPECT_GT(scene.triangle_count(), plain.triangle_count());
}

TEST(Warehouse, AislesAreFreeFromEndToEnd) {
  const WarehouseOptions o;
  const Scene scene = make_scene(laws::node_of("warehouse"), 1);
  const double end = warehouse_layout::rack_length_m(o) / 2;
  for (int k = 0; k < o.aisles; ++k) {
    const double y = warehouse_layout::aisle_y_m(o, k);
    std::string what;
    EXPECT_GT(laws::clearance_m(scene, line({-end, y}, {end, y}), 4, &what), o.aisle_width_m / 2 - 0.15) << what;
  }
}

TEST(Warehouse, RacksRepeatExactlyWhenLoadsDoNotVary) {
  const Scene scene = make_scene(laws::node_of("warehouse", "fill: 1\nload_variation: 0\nbays: 6\naisles: 1\n"), 1);
  for (const Instance& i : scene.instances) {
    if (!is(scene, i, "goods")) continue;
    std::map<std::array<int, 3>, int> seen;  // corners of the goods, a bay folded onto the first [mm]
    for (const Eigen::Vector3f& v : scene.meshes[i.mesh].vertices) {
      const double x = std::fmod(v.x() + 10 * warehouse_layout::bay_m + 0.01, warehouse_layout::bay_m);
      ++seen[{static_cast<int>(std::lround(1e3 * x)), static_cast<int>(std::lround(1e3 * v.y())),
              static_cast<int>(std::lround(1e3 * v.z()))}];
    }
    for (const auto& [place, count] : seen) ASSERT_EQ(count % 6, 0) << place[0] << " " << place[1] << " " << place[2];
  }
}

TEST(Warehouse, RacksPalletsAndTheForkLiftStandOnTheFloor) {
  const Scene scene = make_scene(laws::node_of("warehouse"), 1);
  const auto stands = [&](const Instance& i) {
    return is(scene, i, "goods") || is(scene, i, "staged_pallet") || is(scene, i, "fork_lift");
  };
  EXPECT_GT(laws::stands_on_the_ground(scene, stands, -0.012, 0.012), 30u);
}

TEST(UrbanBlock, TheRightLaneIsFreeAllAroundTheBlock) {
  const UrbanBlockOptions o;
  const Scene scene = make_scene(laws::node_of("urban-block", "parked_share: 1\n"), 1);
  const Vector2d c = urban_layout::street_centre(o) + Vector2d::Constant(1.6);
  for (const auto& [from, to] : {std::pair{Vector2d(-c.x(), -c.y()), Vector2d(c.x(), -c.y())},
                                 {Vector2d(c.x(), -c.y()), Vector2d(c.x(), c.y())},
                                 {Vector2d(c.x(), c.y()), Vector2d(-c.x(), c.y())}}) {
    std::string what;
    EXPECT_GT(laws::clearance_m(scene, line(from, to), 4, &what), 1.5) << what;
  }
}

TEST(UrbanBlock, CarsStandOnTheStreetAndFurnitureOnTheSidewalk) {
  const Scene scene = make_scene(laws::node_of("urban-block"), 1);
  EXPECT_GT(laws::stands_on_the_ground(
                scene, [](const Instance& i) { return i.label == Label::vehicle; }, -0.02, 0.02),
            30u);
  const auto furniture = [&](const Instance& i) { return is(scene, i, "litter_bin") || is(scene, i, "bench"); };
  EXPECT_GT(laws::stands_on_the_ground(scene, furniture, -0.015, 0.015, 0.12), 20u);
  const auto planted = [&](const Instance& i) {
    return i.label == Label::tree || i.label == Label::mast || i.label == Label::sign;
  };
  EXPECT_GT(laws::stands_on_the_ground(scene, planted, -0.4, -0.1, 0.12), 40u);
}

TEST(UrbanBlock, KerbsStepUpByTheirHeightAtTheEdgeOfTheStreet) {
  const UrbanBlockOptions o;
  const Scene scene = make_scene(laws::node_of("urban-block"), 1);
  const double edge = -urban_layout::half_block(o).y() - o.sidewalk_m;  // of the middle block, in the south
  double highest = -1e9, lowest = 1e9;
  for (const Instance& i : scene.instances) {
    if (!is(scene, i, "sidewalks")) continue;
    for (const Eigen::Vector3f& v : scene.meshes[i.mesh].vertices) {
      if (std::abs(v.y() - edge) > 0.02 || std::abs(v.x()) > 30) continue;
      const double above = v.z() - scene.ground->height_m(v.x(), v.y());
      highest = std::max(highest, above);
      lowest = std::min(lowest, above);
    }
  }
  EXPECT_NEAR(highest, 0.12, 1e-3);
  EXPECT_LT(lowest, -0.02) << "the kerb's foot is in the ground";
}

TEST(Highway, LanesOfTheRightCarriagewayAreFree) {
  const HighwayOptions o;
  const Scene scene = make_scene(laws::node_of("highway"), 1);
  const CentreLine centre(highway_layout::start(o), highway_layout::pieces(o));
  for (int lane = 0; lane < o.lanes; ++lane) {
    std::string what;
    const auto points = centre.offset_line(30, o.length_m - 30, highway_layout::lane_d_m(o, lane), 2);
    EXPECT_GT(laws::clearance_m(scene, points, 4, &what), 1.9) << what << " beside lane " << lane;
  }
}

TEST(Highway, ADriveOfTheSamePiecesStaysInItsLane) {
  const HighwayOptions o;
  const double d = highway_layout::lane_d_m(o, 1);
  const CentreLine centre(highway_layout::start(o), highway_layout::pieces(o));
  StartOptions start = highway_layout::start(o);
  start.y_m += d;
  const CentreLine lane(start, highway_layout::pieces_at(o, d));
  double worst = 0;
  for (double s = 0; s < o.length_m; s += 5)
    worst = std::max(worst, std::abs(centre.project(lane.place(s, 0)).d_m - d));
  EXPECT_LT(worst, 0.05);
}

TEST(Highway, AsphaltLiesOnTheGroundToHalfAMillimetreAndPaintUponIt) {
  const Scene scene = make_scene(laws::node_of("highway", "length_m: 500\nturn_deg: 0\n"), 1);
  double deepest = 0, lowest_paint = 1, highest_paint = 0;
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return i.label == Label::pavement || i.label == Label::marking; },
      [&](const Instance& i, const tests::Triangle& t) {
        const Vector3d c = (t[0] + t[1] + t[2]) / 3;
        const double above = c.z() - scene.ground->height_m(c.x(), c.y());
        if (i.label == Label::pavement) {
          deepest = std::max(deepest, std::abs(above));
        } else {
          lowest_paint = std::min(lowest_paint, above);
          highest_paint = std::max(highest_paint, above);
        }
      });
  EXPECT_LT(deepest, 0.5e-3);
  EXPECT_GT(lowest_paint, 1e-3);
  EXPECT_LT(highest_paint, 3e-3);
}

TEST(Highway, RailsSignsAndVehiclesStandOnTheRoad) {
  const Scene scene = make_scene(laws::node_of("highway"), 1);
  const auto planted = [&](const Instance& i) {
    return i.label == Label::sign || i.label == Label::tree || is(scene, i, "guard_rails");
  };
  EXPECT_GT(laws::stands_on_the_ground(scene, planted, -1.2, -0.1), 100u) << "their feet are in the ground";
  EXPECT_EQ(laws::stands_on_the_ground(
                scene, [](const Instance& i) { return i.label == Label::vehicle; }, -0.02, 0.02),
            3u);
}

TEST(Highway, BendsThatDoNotFitAreRefusedWithTheirLine) {
  try {
    make_scene(laws::node_of("highway", "length_m: 600\nturn_deg: 30\n"), 1);
    ADD_FAILURE() << "two bends of 470 m in 600 m";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("scenario.yaml:3: turn_deg"));
  }
}

TEST(Hills, GradientAndHessianMatchCentralDifferences) {
  const HillyGround ground(HillsOptions{}, 5);
  const core::RandomStream random(7, "test/hills");
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Vector2d p(300 * random.uniform(k, 0) - 150, 300 * random.uniform(k, 1) - 150);
    Vector2d gradient;
    Vector3d hessian;
    ground.height_m(p.x(), p.y(), &gradient, &hessian);
    const auto height = [&](const Vector2d& q) { return Eigen::Matrix<double, 1, 1>(ground.height_m(q.x(), q.y())); };
    EXPECT_LT((tests::numeric_jacobian<1, 2>(height, p, 1e-3).transpose() - gradient).norm(), 1e-7);
    const auto slope = [&](const Vector2d& q) {
      Vector2d g;
      ground.height_m(q.x(), q.y(), &g);
      return g;
    };
    Eigen::Matrix2d expected;
    expected << hessian[0], hessian[1], hessian[1], hessian[2];
    EXPECT_LT((tests::numeric_jacobian<2, 2>(slope, p, 1e-3) - expected).norm(), 1e-7);
  }
}

TEST(Hills, AreSteepButDrivableAndNowhereAPlane) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const HillyGround ground(HillsOptions{}, seed);
    double sum2 = 0, steepest = 0;
    int n = 0, bent = 0;
    for (const Vector2d& p : hills_track()) {
      Vector2d g;
      Vector3d h;
      ground.height_m(p.x(), p.y(), &g, &h);
      sum2 += g.squaredNorm();
      steepest = std::max(steepest, g.norm());
      // Over 10 m of such a curvature the ground leaves its tangent plane by more than a centimetre.
      bent += std::sqrt(h[0] * h[0] + 2 * h[1] * h[1] + h[2] * h[2]) * 10 * 10 / 2 > 0.01;
      ++n;
    }
    EXPECT_GT(std::sqrt(sum2 / n), 0.06) << seed;
    EXPECT_LT(steepest, 0.6) << seed << ": 30 degrees";
    EXPECT_GT(bent, 0.95 * n) << seed;
  }
}

TEST(Hills, MeshFollowsTheGroundAndItsTwoGridsMeet) {
  const Scene scene = make_scene(laws::node_of("rough-hills"), 1);
  double fine = 0, coarse = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Instance& i : scene.instances) {
    if (i.label != Label::terrain) continue;
    const Mesh& mesh = scene.meshes[i.mesh];
    for (const auto& t : mesh.triangles) {
      Vector3d c = Vector3d::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        c += mesh.vertices[t[k]].cast<double>() / 3;
        const auto key = std::minmax(t[k], t[(k + 1) % 3]);
        ++edges[{key.first, key.second}];
      }
      const double off = std::abs(c.z() - scene.ground->height_m(c.x(), c.y()));
      double& worst = c.head<2>().cwiseAbs().maxCoeff() < 64 ? fine : coarse;
      worst = std::max(worst, off);
    }
  }
  std::cout << "off the ground: " << 1e3 * fine << " mm near the track, " << 1e3 * coarse << " mm beyond\n";
  EXPECT_LT(fine, 3e-3);
  EXPECT_LT(coarse, 0.05);
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    ASSERT_LE(count, 2);
    open += count == 1;
  }
  EXPECT_EQ(open, 4u * 200) << "only the outer border: 400 m in cells of 2 m on four sides";
}

TEST(Hills, RocksLieInTheGroundAndTheTrackIsFree) {
  const HillsOptions o;
  const Scene scene = make_scene(laws::node_of("rough-hills"), 1);
  const auto rock = [&](const Instance& i) { return is(scene, i, "rock"); };
  EXPECT_EQ(laws::stands_on_the_ground(scene, rock, -2.0, -0.02), static_cast<std::size_t>(o.rocks));
  const auto tree = [&](const Instance& i) { return i.label == Label::tree; };
  EXPECT_EQ(laws::stands_on_the_ground(scene, tree, -0.5, -0.1), static_cast<std::size_t>(o.trees));
  std::string what;
  EXPECT_GT(laws::clearance_m(scene, hills_track(), 6, &what), 2.5) << what;
}

TEST(OwnMeshes, WithoutReadersTheProgramSaysSo) {
  // This program installs none.
  const auto node = core::ConfigNode::parse("kind: bare\nmeshes: [{file: /proc/self/exe}]\n", "s.yaml");
  try {
    make_scene(node, 1);
    ADD_FAILURE() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("s.yaml:2"));
    EXPECT_THAT(error.what(), testing::HasSubstr("install_mesh_readers"));
  }
}

}  // namespace
}  // namespace tarmac::scenes
