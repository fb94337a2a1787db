// A passenger bridge meets the door it serves, whatever the type, and says when it cannot.
#include "scenes/bridge/bridge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"
#include "tests/scenes/mesh_checks.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

/// A plane that falls to the south.
class SlopingGround final : public Ground {
 public:
  double height_m(double, double y_m, Vector2d* gradient = nullptr, Vector3d* hessian = nullptr) const override {
    if (gradient) *gradient = {0, slope_};
    if (hessian) hessian->setZero();
    return slope_ * y_m;
  }

 private:
  double slope_ = 0.008;
};

/// An aircraft nosed in to the north, and a rotunda to the left of its nose; the terminal beyond.
struct Setting {
  explicit Setting(const std::string& name, Vector2d rotunda_from_door = {-20, 6}, double floor_m = 4.5)
      : type(aircraft_type(name)), T_world_aircraft(park(type, ground, 0, 30, std::numbers::pi / 2)) {
    const Vector3d sill = door_sill_world(type, T_world_aircraft);
    site.rotunda_m = sill.head<2>() + rotunda_from_door;
    site.terminal_m = site.rotunda_m + Vector2d(0, 16);
    site.floor_z_m = ground.height_m(site.terminal_m.x(), site.terminal_m.y()) + floor_m;
  }
  SlopingGround ground;
  const AircraftType& type;
  core::SE3 T_world_aircraft;
  BridgeSite site;
};

struct Meeting {
  double floor_below_sill_m = 1e9;  ///< of the cab's floor in front of the door
  double lip_gap_m = 1e9;           ///< horizontal, from the skin to the nearest of the floor at sill height
  double deepest_m = 1e9;           ///< smallest distance outside the skin, negative = inside
  double canopy_gap_m = 1e9;        ///< nearest of all to the skin well above the floor
};

/// Samples the triangles near the door, in the aircraft's frame.
Meeting meeting_of(const Setting& s, const Mesh& bridge, std::size_t door_index) {
  const Door& door = s.type.doors[door_index];
  const double sill_z = s.type.floor_z_m + door.sill_m;
  const core::SE3 T_aircraft_world = s.T_world_aircraft.inverse();
  std::vector<Vector3d> local;
  for (const Eigen::Vector3f& v : bridge.vertices) local.push_back(T_aircraft_world * v.cast<double>());
  Meeting m;
  double floor_top = -1e9, widest = 0;
  for (const FuselageStation& station : s.type.stations) widest = std::max(widest, station.half_width_m);
  const auto outside = [&](const Vector3d& p, const Vector3d& q, const Vector3d& r) {
    const Vector3d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    return low.x() > 3 - door.x_m || high.x() < -3 - door.x_m || low.y() > widest + 0.9 || high.y() < 0;
  };
  for (const auto& [i, j, k] : bridge.triangles) {
    const Vector3d &a = local[i], &b = local[j], &c = local[k];
    if (outside(a, b, c)) continue;
    const int n =
        std::clamp(static_cast<int>(std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()}) / 0.04), 1, 80);
    for (int u = 0; u <= n; ++u) {
      for (int v = 0; u + v <= n; ++v) {
        const Vector3d p = a + (b - a) * (double(u) / n) + (c - a) * (double(v) / n);
        if (p.y() < 0 || p.y() > widest + 0.9 || std::abs(p.x() + door.x_m) > 3) continue;
        const double skin = fuselage_half_width_m(s.type, -p.x(), p.z());
        if (skin > 0) m.deepest_m = std::min(m.deepest_m, p.y() - skin);
        const bool before_door = std::abs(p.x() + door.x_m) < door.width_m / 2;
        if (before_door && std::abs(p.z() - sill_z) < 0.3) m.lip_gap_m = std::min(m.lip_gap_m, p.y() - skin);
        const double door_skin = fuselage_half_width_m(s.type, door.x_m, sill_z);
        if (before_door && p.y() < door_skin + 0.6 && p.z() < sill_z + 0.5) floor_top = std::max(floor_top, p.z());
        if (skin > 0 && p.z() > sill_z + 0.8) m.canopy_gap_m = std::min(m.canopy_gap_m, p.y() - skin);
      }
    }
  }
  m.floor_below_sill_m = sill_z - floor_top;
  return m;
}

class BridgeToEveryType : public ::testing::TestWithParam<std::string> {};

TEST_P(BridgeToEveryType, CabMeetsTheOpenDoor) {
  const Setting s(GetParam());
  const Meeting m = meeting_of(s, make_jet_bridge(s.site, s.type, s.T_world_aircraft, s.ground), 0);
  EXPECT_LT(std::abs(m.floor_below_sill_m), 0.05);
  EXPECT_GT(m.floor_below_sill_m, 0) << "the door swings over the floor";
  EXPECT_LT(m.lip_gap_m, 0.15);
  EXPECT_GT(m.deepest_m, 0) << "part of the bridge is inside the fuselage";
  EXPECT_LT(m.canopy_gap_m, 0.05) << "the canopy leaves the skin";
}

TEST_P(BridgeToEveryType, LeavesTheOpenLeafItsPlace) {
  const Setting s(GetParam());
  const Mesh open = make_aircraft(s.type, 0), bridge = make_jet_bridge(s.site, s.type, s.T_world_aircraft, s.ground);
  const Door& door = s.type.doors.front();
  // Rays along the leaf's outer face, from below to above it, meet no bridge.
  const double station = door.x_m - door.width_m - 0.08, z0 = s.type.floor_z_m + 0.03;
  for (const double share : {0.1, 0.5, 0.9}) {
    const double z = z0 + share * (door.height_m - 0.06), y = fuselage_half_width_m(s.type, station, z);
    for (const double off : {0.10, 0.18}) {
      const Vector3d from = s.T_world_aircraft * Vector3d(-station - 0.45 * door.width_m, y + off, z);
      const Vector3d along = s.T_world_aircraft.linear() * Vector3d::UnitX();
      EXPECT_GT(tests::first_hit(bridge, from, along).distance_m, 0.9 * door.width_m) << "at " << share;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, BridgeToEveryType,
                         ::testing::Values("a320", "b737-800", "e190", "a350-900", "b777-300er", "a380"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Bridge, ServesASecondDoorOfAWideBody) {
  Setting s("a350-900");
  const Vector3d sill = door_sill_world(s.type, s.T_world_aircraft, 1);
  s.site.rotunda_m = sill.head<2>() + Vector2d(-26, 9);
  s.site.terminal_m = s.site.rotunda_m + Vector2d(0, 20);
  const Meeting m = meeting_of(s, make_jet_bridge(s.site, s.type, s.T_world_aircraft, s.ground, 1), 1);
  EXPECT_LT(std::abs(m.floor_below_sill_m), 0.05);
  EXPECT_LT(m.lip_gap_m, 0.15);
  EXPECT_GT(m.deepest_m, 0);
}

TEST(Bridge, PartsAreClosedAndFaceOutwardExceptPanes) {
  const Setting s("a350-900", {-30, 5});
  const Mesh bridge = make_jet_bridge(s.site, s.type, s.T_world_aircraft, s.ground);
  for (const auto& part : tests::parts_of(bridge)) {
    if (bridge.materials[part.front()] == static_cast<std::uint16_t>(MaterialId::glass_clear_float_pane)) continue;
    const tests::PartFacts facts = tests::facts_of(bridge, part);
    EXPECT_TRUE(facts.closed);
    EXPECT_GT(facts.volume_m3, 0) << facts.middle.transpose();
  }
}

std::string error_of(const Setting& s, std::size_t door = 0) {
  try {
    make_jet_bridge(s.site, s.type, s.T_world_aircraft, s.ground, door);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Bridge, SaysWhichLimitADoorIsBeyond) {
  EXPECT_THAT(error_of(Setting("a320", {-55, 6})), HasSubstr("move the rotunda or the aircraft closer together"));
  EXPECT_THAT(error_of(Setting("a320", {-8, 2})), HasSubstr("apart"));
  // An ATR's sill is 1.2 m above ground: 12 m of way from a floor at 5.5 m are too steep.
  EXPECT_THAT(error_of(Setting("atr-72", {-14, 2}, 5.5)), HasSubstr("slope"));
  EXPECT_THAT(error_of(Setting("a320", {-16, -22})), HasSubstr("swing"));
  EXPECT_THAT(error_of(Setting("a320", {16, 10})), HasSubstr("deg from the"));
  EXPECT_THAT(error_of(Setting("a320"), 2), HasSubstr("no passenger door on the left side"));
  EXPECT_EQ(error_of(Setting("a320")), "no error");
}

TEST(Bridge, ReachIsMeasuredFromRotundaToPivot) {
  const Setting s("b777-300er");
  const BridgeReach r = bridge_reach(s.site, s.type, s.T_world_aircraft);
  EXPECT_NEAR((r.pivot_m - r.sill_m).norm(), 2.4, 0.01);
  EXPECT_NEAR(r.reach_m, std::hypot(20 - 2.4, 6), 0.05);  // the door looks west
  EXPECT_NEAR(r.slope * r.reach_m, r.pivot_m.z() - s.site.floor_z_m, 1e-9);
}

TEST(StandBridge, ServesTheStandsAircraftAndLeavesTheRoadItsClearHeight) {
  const Scene& scene = tests::default_stand();
  const AircraftType& type = aircraft_type("a320");
  const BridgeSite site = stand_bridge_site(*scene.ground);
  const core::SE3 T = park(type, *scene.ground, 0, layout::nose_y_m, std::numbers::pi / 2);
  EXPECT_LT(std::abs(bridge_reach(site, type, T).slope), 1.0 / 11) << "1:12 is aimed at";
  const double way = site.terminal_m.y() - site.rotunda_m.y();
  const auto share = [&](double y) { return (y - site.rotunda_m.y()) / way; };
  EXPECT_GE(walkway_clearance_m(site, *scene.ground, share(layout::head_road_centre_y_m - layout::lane_width_m),
                                share(layout::head_road_centre_y_m + layout::lane_width_m)),
            layout::corridor_clear_height_m);
}

TEST(StandBridge, NothingOfTheStandsAircraftAndBridgeTouches) {
  // The door is open in the stand: a ray through it at mid-height ends in the dark entry area.
  const Scene& scene = tests::default_stand();
  const AircraftType& type = aircraft_type("a320");
  for (const Instance& instance : scene.instances) {
    if (instance.label != Label::aircraft) continue;
    const Door& door = type.doors.front();
    const tests::Hit hit = tests::first_hit(
        scene.meshes[instance.mesh], Vector3d(-door.x_m, 30, type.floor_z_m + door.height_m / 2), -Vector3d::UnitY());
    EXPECT_GT(hit.distance_m, 30);
  }
}

}  // namespace
}  // namespace tarmac::scenes
