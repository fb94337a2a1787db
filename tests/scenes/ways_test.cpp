// Taxiway, runway crossing, road tunnel, baggage tunnel: what holds for all four, then what each promises.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <set>

#include "scenes/baggage_tunnel/layout.h"
#include "scenes/road_tunnel/layout.h"
#include "scenes/runway/layout.h"
#include "scenes/taxiway/section.h"
#include "tests/scenes/fingerprint.h"
#include "tests/scenes/solids.h"
#include "tests/scenes/support.h"
#include "tests/support/numeric.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::fingerprint;
using tests::follows_ground;
using tests::node;

/// Built once each.
const Scene& scene_of_yaml(const std::string& yaml) {
  static std::map<std::string, Scene> built;
  const auto found = built.find(yaml);
  return found != built.end() ? found->second : built.emplace(yaml, make_scene(node(yaml), 1)).first->second;
}

struct Kind {
  const char* name;
  const char* yaml;
  /// Where vehicles go, from above.
  std::vector<Vector2d> (*lane)();
  bool has_land_above;  ///< terrain that is not the scene's ground
};

std::vector<Vector2d> straight_lane(Vector2d from, Vector2d to) {
  std::vector<Vector2d> line;
  for (int k = 0; k <= 800; ++k) line.emplace_back(from + (to - from) * k / 800);
  return line;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list{
      {"taxiway_straight", "kind: taxiway\n",
       [] {
         return straight_lane({-440, 0}, {440, 0});
       },
       false},
      {"taxiway_curve", "kind: taxiway\nshape: curve\nlength_m: 600\n",
       [] {
         TaxiwayOptions options;
         options.shape = "curve";
         options.length_m = 600;
         return TaxiwayLayout(options).line().offset_line(5, 595, 0, 0.8);
       },
       false},
      {"taxiway_code_a", "kind: taxiway\ncode_letter: A\nlength_m: 300\n",
       [] {
         return straight_lane({-140, 0}, {140, 0});
       },
       false},
      {"runway_crossing", "kind: runway-crossing\n",
       [] {
         return straight_lane({0, -240}, {0, 210});
       },
       false},
      {"road_tunnel", "kind: road-tunnel\n",
       [] {
         return straight_lane({-250, 1.8}, {250, 1.8});
       },
       true},
      {"road_tunnel_niches", "kind: road-tunnel\nniches: true\n",
       [] {
         return straight_lane({-250, 1.8}, {250, 1.8});
       },
       true},
      {"baggage_tunnel", "kind: baggage-tunnel\n",
       [] { return BaggageTunnelLayout(BaggageTunnelOptions{}).line.offset_line(-55, 150, 0, 0.5); }, false},
  };
  return list;
}

class EveryWay : public testing::TestWithParam<Kind> {
 protected:
  const Scene& scene() const { return scene_of_yaml(GetParam().yaml); }
};

TEST_P(EveryWay, HasOnlyFiniteTrianglesOfSomeSizeAndNotTooMany) {
  std::cout << GetParam().name << ": " << scene().triangle_count() << " triangles, " << scene().instances.size()
            << " instances\n";
  EXPECT_LT(scene().triangle_count(), 400000U);
  for (const Mesh& mesh : scene().meshes) {
    ASSERT_EQ(mesh.materials.size(), mesh.triangles.size()) << mesh.name;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      ASSERT_LT(mesh.materials[t], scene().materials.size());
      Vector3d p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = mesh.vertices[mesh.triangles[t][k]].cast<double>();
        ASSERT_TRUE(p[k].allFinite()) << mesh.name;
      }
      ASSERT_GT(0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm(), 2e-7) << mesh.name << " at " << p[0].transpose();
    }
  }
  std::set<std::uint32_t> used;
  for (const Instance& i : scene().instances) used.insert(i.mesh);
  EXPECT_EQ(used.size(), scene().meshes.size()) << "a mesh that nothing shows";
}

TEST_P(EveryWay, SolidsAreClosedAndFaceOutward) {
  std::set<std::uint32_t> ground;
  for (const Instance& i : scene().instances) {
    if (follows_ground(i.label)) ground.insert(i.mesh);
  }
  for (std::uint32_t m = 0; m < scene().meshes.size(); ++m) {
    if (ground.contains(m)) continue;
    for (const auto& part : tests::parts_of(scene().meshes[m])) {
      ASSERT_TRUE(tests::is_closed(scene().meshes[m], part)) << scene().meshes[m].name;
      EXPECT_GT(tests::volume_m3(scene().meshes[m], part), 0) << scene().meshes[m].name;
    }
  }
}

TEST_P(EveryWay, GroundFacesUpAndItsFacetsKeepWithinHalfAMillimetreOfTheGround) {
  double worst = 0;
  const auto* tunnel = dynamic_cast<const RoadTunnelGround*>(scene().ground.get());
  std::size_t count = 0;
  tests::for_each_static_triangle(
      scene(), [](const Instance& i) { return i.label == Label::pavement || i.label == Label::terrain; },
      [&](const Instance& i, const tests::Triangle& t) {
        ASSERT_GT((t[1] - t[0]).cross(t[2] - t[0]).z(), 0) << scene().meshes[i.mesh].name;
        if (++count % 17 != 0) return;  // enough of them to find one that is too large
        const std::string& name = scene().meshes[i.mesh].name;
        const bool land = tunnel != nullptr && name != "road";
        const Ground& ground = land ? tunnel->land() : *scene().ground;
        for (const Vector3d& p : {Vector3d((t[0] + t[1] + t[2]) / 3), Vector3d((t[0] + t[1]) / 2),
                                  Vector3d((t[1] + t[2]) / 2), Vector3d((t[2] + t[0]) / 2)})
          worst = std::max(worst, std::abs(p.z() - ground.height_m(p.x(), p.y())));
      });
  std::cout << GetParam().name << ": worst facet " << 1e3 * worst << " mm\n";
  EXPECT_LT(worst, 0.0005);
}

TEST_P(EveryWay, PropsNeitherFloatNorSink) {
  for (const Instance& i : scene().instances) {
    if (follows_ground(i.label) || i.label == Label::building || i.label == Label::other) continue;
    const Mesh& mesh = scene().meshes[i.mesh];
    if (mesh.name == "wall_lamp" || mesh.name == "lamps_on_ceiling") continue;  // they hang
    double low = 1e9, high = -1e9;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      const Vector3d p = i.T_parent_mesh * v.cast<double>();
      const auto* tunnel = dynamic_cast<const RoadTunnelGround*>(scene().ground.get());
      const Ground& ground = tunnel != nullptr ? tunnel->land() : *scene().ground;
      const double above = p.z() - ground.height_m(p.x(), p.y());
      low = std::min(low, above);
      high = std::max(high, above);
    }
    EXPECT_LT(low, 0.004) << mesh.name << " floats at " << i.T_parent_mesh.translation().transpose();
    EXPECT_GT(high, 0.010) << mesh.name << " is buried";
  }
}

TEST_P(EveryWay, LaneIsFree) {
  const std::vector<Vector2d> line = GetParam().lane();
  double nearest = 50;
  std::string what;
  tests::for_each_static_triangle(
      scene(), [](const Instance& i) { return !follows_ground(i.label); },
      [&](const Instance& i, const tests::Triangle& t) {
        tests::for_each_outline_between(t, *scene().ground, 0.15, 2.6, [&](const std::vector<Vector2d>& outline) {
          double size = 0;
          for (const Vector2d& p : outline) size = std::max(size, (p - outline[0]).norm());
          for (const Vector2d& p : line) {
            if ((p - outline[0]).norm() - size > std::min(nearest, 4.0)) continue;
            const double distance = tests::distance_to_outline(p, outline);
            if (distance < nearest) nearest = distance, what = scene().meshes[i.mesh].name;
          }
        });
      });
  std::cout << GetParam().name << ": nearest " << nearest << " m " << what << "\n";
  EXPECT_GE(nearest, 1.5) << what;
}

TEST_P(EveryWay, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const core::ConfigNode yaml = node(GetParam().yaml);
  EXPECT_EQ(fingerprint(scene()), fingerprint(make_scene(yaml, 1)));
  EXPECT_NE(fingerprint(scene()), fingerprint(make_scene(yaml, 2)));
  const auto ground = make_ground(yaml, 1);
  for (const double x : {-20.0, 0.0, 31.7}) EXPECT_EQ(ground->height_m(x, 1), scene().ground->height_m(x, 1));
}

TEST_P(EveryWay, ResolvedOptionsReadBackAsTheSameScene) {
  const std::string resolved = resolve_scene(node(GetParam().yaml));
  const core::ConfigNode again = core::ConfigNode::parse("scene:\n" + resolved, "resolved.yaml");
  EXPECT_EQ(fingerprint(scene()), fingerprint(make_scene(again.child("scene"), 1)));
}

std::string name_of_kind(const testing::TestParamInfo<Kind>& kind) {
  return kind.param.name;
}
INSTANTIATE_TEST_SUITE_P(All, EveryWay, testing::ValuesIn(kinds()), name_of_kind);

TEST(Taxiway, SlopesKeepToTheCodesLimits) {
  for (const char letter : {'A', 'C', 'E', 'F'}) {
    TaxiwayOptions options;
    options.code_letter = letter;
    options.undulation_mm = 0;
    const TaxiwayCode& code = taxiway_code(options.code_letter);
    options.longitudinal_slope_percent = code.longitudinal_slope_percent;
    options.transverse_slope_percent = code.transverse_slope_percent;
    const TaxiwayLayout layout(options);
    const auto ground = layout.ground(options, 1);
    double along = 0, across = 0;
    for (double d = -layout.section().edge_m + 1.5; d < layout.section().edge_m - 1.5; d += 0.25) {
      Vector2d gradient;
      ground->height_m(12, d, &gradient);
      along = std::max(along, std::abs(gradient.x()));
      across = std::max(across, std::abs(gradient.y()));
    }
    EXPECT_NEAR(along, code.longitudinal_slope_percent / 100, 1e-9);
    if (letter != 'A') {  // too narrow: its crown is rounded over its whole width
      EXPECT_NEAR(across, code.transverse_slope_percent / 100, 4e-4) << letter;
    }
    EXPECT_LT(across, code.transverse_slope_percent / 100 + 1e-4) << letter;
  }
}

TEST(Taxiway, ParallelTaxiwaysDitchesFitBetweenThemForEveryLetter) {
  for (const TaxiwayCode& code : taxiway_codes) {
    const TaxiwaySection s = taxiway_section(code);
    EXPECT_LE(s.edge_m, s.shoulder_m);
    EXPECT_LT(s.shoulder_m, s.graded_m);
    EXPECT_LT(s.graded_m, s.swale_m);
    EXPECT_LT(2 * s.outer_m, code.separation_m) << code.letter;
  }
}

/// Places of the instances of a mesh.
std::vector<Vector2d> places_of(const Scene& scene, const std::string& mesh) {
  std::vector<Vector2d> list;
  for (const Instance& i : scene.instances) {
    if (scene.meshes[i.mesh].name == mesh) list.emplace_back(i.T_parent_mesh.translation().head<2>());
  }
  return list;
}

TEST(Taxiway, EdgeLightsAreSpacedAsOnStraightsAndAsInBends) {
  TaxiwayOptions options;
  options.shape = "curve";
  options.length_m = 600;
  const TaxiwayLayout layout(options);
  const Scene& scene = scene_of_yaml("kind: taxiway\nshape: curve\nlength_m: 600\n");
  std::map<long, std::map<double, Vector2d>> rows;  // by lateral place, then along
  for (const Vector2d& p : places_of(scene, "edge_light")) {
    const CentreLine::Place place = layout.line().project(p);
    rows[std::lround(10 * place.d_m)][place.s_m] = p;
  }
  ASSERT_EQ(rows.size(), 4U) << "two taxiways with two edges";
  for (const auto& [d, row] : rows) {
    const Vector2d* before = nullptr;
    double s_before = 0;
    int in_bend = 0;
    for (const auto& [s, p] : row) {
      if (before != nullptr) {
        const double gap = (p - *before).norm();
        EXPECT_LE(gap, 60);
        if (s_before > layout.bend_begin_m() && s < layout.bend_end_m()) {
          ++in_bend;
          EXPECT_LE(gap, 15) << "at d = " << 0.1 * static_cast<double>(d);
          EXPECT_GE(gap, 5);
        }
      }
      before = &p;
      s_before = s;
    }
    EXPECT_GT(in_bend, 5);
  }
}

TEST(RunwayCrossing, NothingPavedIsSteeperThanATaxiwayMayBe) {
  RunwayOptions options;
  options.undulation_mm = 0;
  const RunwayLayout layout(options);
  const auto ground = runway_ground(options, 1);
  double steepest = 0;
  for (double y = layout.south_m; y < layout.north_m; y += 0.5) {
    Vector2d gradient;
    ground->height_m(0, y, &gradient);
    steepest = std::max(steepest, std::abs(gradient.y()));
    EXPECT_NEAR(gradient.x(), options.longitudinal_slope_percent / 100, 1e-12);
  }
  EXPECT_LE(steepest, 0.015 + 1e-9);
  EXPECT_GT(steepest, 0.012);
  const double fall = ground->height_m(0, 0) - ground->height_m(0, layout.half_m);
  EXPECT_NEAR(fall, options.crown_percent / 100 * layout.half_m, 0.02);
}

TEST(RunwayCrossing, AircraftFindStopBarsSignsAndTheIndicatorWhereTheyBelong) {
  const Scene& scene = scene_of_yaml("kind: runway-crossing\n");
  const RunwayLayout layout{RunwayOptions{}};
  const std::vector<Vector2d> bars = places_of(scene, "stop_bar_light"), papi = places_of(scene, "papi_unit");
  ASSERT_GE(bars.size(), 10U);
  for (const Vector2d& p : bars) {
    EXPECT_NEAR(std::abs(p.y()), layout.hold_m, 1) << "at the holding position";
    EXPECT_LT(std::abs(p.x()), layout.taxiway.edge_m);
  }
  ASSERT_EQ(papi.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(papi[k].y(), layout.half_m + 15 + 9.0 * static_cast<double>(k), 1e-9);
  EXPECT_EQ(places_of(scene, "guard_light").size(), 4U);
  EXPECT_GE(places_of(scene, "sign").size(), 8U);
}

TEST(RoadTunnelGround, GradientAndHessianMatchCentralDifferencesAlsoInsideTheWalls) {
  const RoadTunnelGround ground(RoadTunnelOptions{}, 1);
  for (double x = -260; x < 260; x += 7.3) {
    for (const double y : {0.0, 1.8, 4.79, 4.95, -5.02, 5.1, -5.3, 20.0}) {
      const Vector2d p(x, y);
      Vector2d gradient;
      Vector3d hessian;
      ground.height_m(x, y, &gradient, &hessian);
      const auto height = [&](const Vector2d& q) { return Eigen::Matrix<double, 1, 1>(ground.height_m(q.x(), q.y())); };
      EXPECT_LT((tests::numeric_jacobian<1, 2>(height, p, 1e-5).transpose() - gradient).norm(),
                1e-5 * (1 + gradient.norm()));
      const auto slope = [&](const Vector2d& q) {
        Vector2d g;
        ground.height_m(q.x(), q.y(), &g);
        return g;
      };
      Eigen::Matrix2d expected;
      expected << hessian[0], hessian[1], hessian[1], hessian[2];
      EXPECT_LT((tests::numeric_jacobian<2, 2>(slope, p, 1e-5) - expected).norm(), 1e-4 * (1 + expected.norm()));
    }
  }
}

TEST(RoadTunnelGround, ClearanceSearchSeesWhatSpansTheRoadFromLandToLandAtItsHeightOverTheRoad) {
  const RoadTunnelGround ground(RoadTunnelOptions{}, 1);
  const double y = ground.layout().half_m + ground.layout().wall_m + 0.1;
  const auto distance_to_lane = [&](double above_m) {
    const double z = ground.height_m(0, 0) + above_m;
    double nearest = 50;
    for (const tests::Triangle& t : {tests::Triangle{Vector3d(-1, -y, z), Vector3d(1, -y, z), Vector3d(1, y, z)},
                                     tests::Triangle{Vector3d(-1, -y, z), Vector3d(1, y, z), Vector3d(-1, y, z)}})
      tests::for_each_outline_between(t, ground, 0.15, 2.6, [&](const std::vector<Vector2d>& outline) {
        nearest = std::min(nearest, tests::distance_to_outline({0.3, 1.8}, outline));
      });
    return nearest;
  };
  EXPECT_EQ(distance_to_lane(2), 0) << "a beam in the way";
  EXPECT_GT(distance_to_lane(5.2), ground.layout().half_m - 1.8 - 0.25) << "the ceiling";
}

TEST(RoadTunnelGround, RampsHaveTheirGradeTheirDepthAndTheirVerticalCurve) {
  RoadTunnelOptions options;
  options.undulation_mm = 0;
  const RoadTunnelGround ground(options, 1);
  const RoadTunnelLayout& l = ground.layout();
  EXPECT_NEAR(ground.height_m(0, 0), -l.depth_m, 1e-6);
  EXPECT_NEAR(ground.height_m(l.road_end_m, 0), 0, 1e-3);
  EXPECT_EQ(ground.height_m(0, l.half_m + l.wall_m), 0) << "behind the wall it is the land";
  double steepest = 0, sharpest = 0;
  for (double x = -l.road_end_m; x < l.road_end_m; x += 0.1) {
    Vector2d gradient;
    Vector3d hessian;
    ground.height_m(x, 2, &gradient, &hessian);
    steepest = std::max(steepest, std::abs(gradient.x()));
    sharpest = std::max(sharpest, std::abs(hessian[0]));
  }
  EXPECT_NEAR(steepest, options.ramp_percent / 100, 2e-4);
  EXPECT_NEAR(1 / sharpest, options.vertical_curve_m, 1);
  const double ramp_m = l.ramp_head_m - l.ramp_foot_m;
  EXPECT_GT(ramp_m, 80);
  EXPECT_LT(ramp_m, 150);
}

TEST(BaggageTunnel, TheNorthernLegIsLevelAndTheRampsLeadDownAndUp) {
  BaggageTunnelOptions options;
  options.undulation_mm = 0;
  const BaggageTunnelLayout layout(options);
  const auto ground = baggage_ground(options, 1);
  const auto height = [&](double s) {
    const Vector2d p = layout.line.at(s).p_m;
    return ground->height_m(p.x(), p.y());
  };
  EXPECT_NEAR(height(0), 0, 1e-3);
  const double turn_end = layout.first_leg_m + layout.turn_m;
  EXPECT_NEAR(height(turn_end), -options.drop_m, 1e-3);
  EXPECT_NEAR(height(turn_end + options.north_leg_m), -options.drop_m, 1e-3);
  EXPECT_NEAR(height(layout.line.length_m()), options.rise_m - options.drop_m, 1e-3);
}

}  // namespace
}  // namespace tarmac::scenes
