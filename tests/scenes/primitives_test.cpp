#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"
#include "scenes/primitives/inside.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;

double volume_m3(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum +=
        mesh.vertices[a].cast<double>().dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) / 6;
  }
  return sum;
}

template <class Add>
Mesh build(const Add& add) {
  MeshBuilder b("test");
  add(b);
  return std::move(b).build();
}

TEST(Primitives, BoxHasItsVolume) {
  EXPECT_NEAR(volume_m3(build([](auto& b) { add_box(b, {1, 2, 3}, {2, 4, 6}); })), 1 * 2 * 3, 1e-5);
}

/// A building of one skin has an inside that is no solid, however small its door.
TEST(Primitives, OnlyAClosedSurfaceIsSolid) {
  Mesh box = build([](auto& b) { add_box(b, {0, 0, 0}, {40, 40, 10}); });
  EXPECT_TRUE(is_inside(box, {20, 20, 5}));
  EXPECT_FALSE(is_inside(box, {20, 20, 10.1}));
  box.triangles.pop_back();
  EXPECT_GT(winding_number(box, {20, 20, 5}), 0.5);
  EXPECT_FALSE(is_inside(box, {20, 20, 5}));
}

TEST(Primitives, BeamHasLengthTimesSection) {
  for (const Vector3d& end : {Vector3d(3, 0, 0), Vector3d(0, 0, -3), Vector3d(1, 2, 2), Vector3d(-2, 1, 2)}) {
    EXPECT_NEAR(volume_m3(build([&](auto& b) { add_beam(b, Vector3d::Zero(), end, 0.2, 0.3); })), 3 * 0.2 * 0.3, 1e-5);
  }
}

TEST(Primitives, FrustumApproachesTheConesVolumeFromWithin) {
  const int n = 64;
  const double r0 = 1.0, r1 = 0.4, h = 2;
  // A regular n-gon covers n/2 sin(2 pi/n) of the circle's r^2.
  const double polygon = 0.5 * n * std::sin(2 * std::numbers::pi / n);
  const double expected = polygon * h / 3 * (r0 * r0 + r0 * r1 + r1 * r1);
  EXPECT_NEAR(volume_m3(build([&](auto& b) { add_frustum(b, {0, 0, 1}, {0, 0, 3}, r0, r1, n); })), expected, 1e-4);
  EXPECT_NEAR(volume_m3(build([&](auto& b) { add_frustum(b, {0, 1, 0}, {0, 3, 0}, r0, r1, n); })), expected, 1e-4);
}

TEST(Primitives, LatheOfAHalfCircleIsASphere) {
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= 40; ++k) {
    const double a = std::numbers::pi * k / 40;
    profile.push_back({std::cos(a), k == 0 || k == 40 ? 0 : std::sin(a), MaterialId::concrete_wall});
  }
  const double volume = volume_m3(build([&](auto& b) { add_lathe(b, profile, 80); }));
  EXPECT_NEAR(volume, 4.0 / 3 * std::numbers::pi, 0.01 * volume);
  EXPECT_LT(volume, 4.0 / 3 * std::numbers::pi);
}

TEST(Primitives, LatheStandsOnItsLowestVertexWhateverTheNumberOfSegments) {
  for (const int segments : {5, 7, 20, 33}) {
    const Mesh mesh = build([&](auto& b) { add_road_wheel(b, 0, 0, 0.3, 0.2); });
    const Mesh lathe = build([&](auto& b) { add_lathe(b, {{0, 1, {}}, {1, 1, {}}}, segments); });
    const auto lowest = [](const Mesh& m) {
      float z = 1e9f;
      for (const auto& p : m.vertices) z = std::min(z, p.z());
      return z;
    };
    EXPECT_NEAR(lowest(mesh), 0, 1e-6);
    EXPECT_NEAR(lowest(lathe), -1, 1e-6);
  }
}

TEST(Primitives, LatheLoopIsATorusByPappus) {
  std::vector<ProfilePoint> profile;
  const int n = 48;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    profile.push_back({0.2 * std::cos(a), 1 + 0.2 * std::sin(a), MaterialId::tyre_rubber});
  }
  const double pappus = 2 * std::numbers::pi * 1 * std::numbers::pi * 0.2 * 0.2;
  const double volume = volume_m3(build([&](auto& b) { add_lathe_loop(b, profile, 96); }));
  EXPECT_NEAR(volume, pappus, 0.01 * pappus);
}

TEST(Primitives, MirroredPartsKeepTheirWindingOutward) {
  const auto add = [](MeshBuilder& b) {
    add_loft(b, {{{0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, {{0, 1, 1}, {1, 1, 1}, {0, 2, 1}}});
  };
  const Mesh left = build(add);
  const Mesh right = build([&](MeshBuilder& b) { add(b.mirror_y(true)); });
  EXPECT_NEAR(volume_m3(left), 0.5, 1e-6);
  EXPECT_NEAR(volume_m3(right), 0.5, 1e-6);
  EXPECT_EQ(right.vertices.front().y(), -left.vertices.front().y());
}

TEST(Materials, AreNamedOnceAndPhysical) {
  std::vector<std::string> names;
  for (const Material& m : materials()) {
    EXPECT_EQ(std::count(names.begin(), names.end(), m.name), 0) << m.name;
    names.push_back(m.name);
    EXPECT_GT(m.diffuse, 0) << m.name;
    EXPECT_LE(m.diffuse + m.transmission, 1) << m.name;
    EXPECT_TRUE(m.specular_f0 >= 0 && m.specular_f0 < 1 && m.ggx_alpha >= 0 && m.retro >= 0) << m.name;
    EXPECT_TRUE((m.color.array() >= 0).all() && (m.color.array() <= 1).all()) << m.name;
  }
}

}  // namespace
}  // namespace tarmac::scenes
