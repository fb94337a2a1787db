#include "scenes/aircraft/aircraft.h"

#include <gtest/gtest.h>

#include "scenes/stand/layout.h"
#include "scenes/stand/options.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;

struct Extent {
  Vector3d low = Vector3d::Constant(1e9), high = Vector3d::Constant(-1e9);
  void add(const Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

const Mesh& a320_mesh() {
  static const Mesh mesh = make_aircraft(airbus_a320());
  return mesh;
}

Extent extent_of(const Mesh& mesh) {
  Extent extent;
  for (const Eigen::Vector3f& p : mesh.vertices) extent.add(p.cast<double>());
  return extent;
}

TEST(AirbusA320, HasTheManufacturersLengthSpanAndHeight) {
  const Extent extent = extent_of(a320_mesh());
  EXPECT_NEAR(extent.high.x() - extent.low.x(), 37.57, 0.05);
  EXPECT_NEAR(extent.high.x(), 0, 0.01) << "the nose tip is the origin";
  const double span = extent.high.y() - extent.low.y();
  EXPECT_GE(span, 35.75);
  EXPECT_LE(span, 35.80);  // with sharklets
  EXPECT_GE(extent.high.z(), 11.83);
  EXPECT_LE(extent.high.z(), 12.08);
  EXPECT_NEAR(extent.low.z(), 0, 1e-4);
}

TEST(AirbusA320, StandsOnItsPublishedWheelbaseAndTrack) {
  Extent nose, left, right;
  for (const Eigen::Vector3f& p : a320_mesh().vertices) {
    if (p.z() > 0.001f) continue;
    (p.x() > -10 ? nose : p.y() > 0 ? left : right).add(p.cast<double>());
  }
  const auto middle = [](const Extent& e) { return Vector3d((e.low + e.high) / 2); };
  EXPECT_NEAR(middle(nose).x(), -5.07, 0.01);
  EXPECT_NEAR(middle(nose).y(), 0, 0.01);
  EXPECT_NEAR(middle(left).x(), -17.71, 0.01);
  EXPECT_NEAR(middle(left).y() - middle(right).y(), 7.59, 0.01);
}

TEST(AirbusA320, FuselageHasTheMeasuredSections) {
  const AircraftType& type = airbus_a320();
  EXPECT_NEAR(fuselage_half_width_m(type, 15, type.floor_z_m + 0.4), 1.98, 0.01);
  EXPECT_EQ(fuselage_half_width_m(type, 15, type.floor_z_m + 2.50), 0);
  EXPECT_EQ(fuselage_half_width_m(type, 15, type.floor_z_m - 1.70), 0);
  EXPECT_GT(fuselage_half_width_m(type, 15, type.floor_z_m - 1.65), 0);
  for (const FuselageStation& s : type.stations) {
    double widest = 0;
    for (double z = s.bottom_m; z < s.top_m; z += 0.01)
      widest = std::max(widest, fuselage_half_width_m(type, s.x_m, type.floor_z_m + z));
    EXPECT_NEAR(widest, s.half_width_m, 0.01) << "x = " << s.x_m;
  }
}

TEST(AirbusA320, ShowsWindowsDoorsTyresAndBareMetal) {
  std::vector<std::size_t> triangles(static_cast<std::size_t>(MaterialId::count));
  for (const std::uint16_t m : a320_mesh().materials) ++triangles[m];
  for (const MaterialId id :
       {MaterialId::acrylic_cabin_window, MaterialId::tyre_rubber, MaterialId::polished_aluminium,
        MaterialId::exhaust_metal, MaterialId::aircraft_grey, MaterialId::aircraft_white_topcoat}) {
    EXPECT_GT(triangles[static_cast<std::size_t>(id)], 50u);
  }
}

TEST(AirbusA320, IsSymmetricExceptForItsHoldDoors) {
  const Extent extent = extent_of(a320_mesh());
  EXPECT_NEAR(extent.high.y(), -extent.low.y(), 1e-4);
}

/// Heights of the lowest vertices near p over the slab there.
double gap_over_slab_m(const Scene& scene, const SlabSurface& slabs, const Instance& instance, const Vector3d& p) {
  const SlabGrid& grid = slabs.grid();
  double gap = 1e9;
  for (const Eigen::Vector3f& v : scene.meshes[instance.mesh].vertices) {
    const Vector3d w = instance.T_parent_mesh * v.cast<double>();
    if ((w - p).head<2>().norm() > 0.25) continue;
    const int i = static_cast<int>((w.x() - grid.origin_m.x()) / grid.size_m);
    const int j = static_cast<int>((w.y() - grid.origin_m.y()) / grid.size_m);
    gap = std::min(gap, w.z() - slabs.height_m(i, j, w.x(), w.y()));
  }
  return gap;
}

TEST(StandAircraft, EveryWheelTouchesItsSlabWithinTwoCentimetres) {
  const AircraftType& type = airbus_a320();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = make_scene(tests::scene_node(), seed);
    const SlabSurface slabs(StandOptions{}.paving(), seed, *scene.ground);
    for (const Instance& instance : scene.instances) {
      if (instance.label != Label::aircraft) continue;
      std::vector<Vector3d> wheels;
      for (const double side : {-0.5, 0.5})
        wheels.emplace_back(-type.nose_gear.x_m, side * type.nose_gear.wheel_spacing_m, 0);
      const LandingGear& main = type.main_gear.front();
      for (const double leg : {-1, 1}) {
        for (const double side : {-0.5, 0.5})
          wheels.emplace_back(-main.x_m, leg * main.half_track_m + side * main.wheel_spacing_m, 0);
      }
      for (const Vector3d& wheel : wheels) {
        EXPECT_LT(std::abs(gap_over_slab_m(scene, slabs, instance, instance.T_parent_mesh * wheel)), 0.02);
      }
    }
  }
}

TEST(StandEquipment, NothingFloatsOrSinks) {
  const Scene& scene = tests::default_stand();
  const SlabSurface slabs(StandOptions{}.paving(), 1, *scene.ground);
  int tested = 0;
  for (const Instance& instance : scene.instances) {
    if (instance.label != Label::ground_equipment && instance.label != Label::vehicle && instance.label != Label::cone)
      continue;
    if (instance.actor >= 0) continue;
    double lowest = 1e9;
    const SlabGrid& grid = slabs.grid();
    for (const Eigen::Vector3f& v : scene.meshes[instance.mesh].vertices) {
      const Vector3d w = instance.T_parent_mesh * v.cast<double>();
      const int i = static_cast<int>((w.x() - grid.origin_m.x()) / grid.size_m);
      const int j = static_cast<int>((w.y() - grid.origin_m.y()) / grid.size_m);
      lowest = std::min(lowest, w.z() - slabs.height_m(i, j, w.x(), w.y()));
    }
    EXPECT_LT(std::abs(lowest), 0.02) << scene.meshes[instance.mesh].name;
    ++tested;
  }
  EXPECT_GT(tested, 30);
}

}  // namespace
}  // namespace tarmac::scenes
