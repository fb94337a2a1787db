// Equipment and people by their measures.
#include "scenes/equipment/equipment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scenes/equipment/person.h"
#include "tests/scenes/mesh_checks.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

class EveryEquipment : public ::testing::TestWithParam<const char*> {
 protected:
  const EquipmentEntry& entry() const { return equipment_entry(GetParam()); }
};

TEST_P(EveryEquipment, HasItsMeasures) {
  const Vector3d size = tests::extent_of(make_equipment(entry().name)).size();
  const Vector3d body(entry().length_m, entry().width_m, entry().height_m);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(size[k], body[k] - 0.08) << "axis " << k;
    EXPECT_LE(size[k], body[k] + entry().attached_m + 0.08) << "axis " << k;
  }
}

TEST_P(EveryEquipment, StandsOnTheGround) {
  const tests::Extent e = tests::extent_of(make_equipment(entry().name));
  EXPECT_NEAR(e.low.z(), 0, 0.035);
  // The origin is in the middle of the footprint, up to what is attached.
  EXPECT_LT(std::abs(e.middle().x()), 0.7 + entry().attached_m / 2);
  EXPECT_LT(std::abs(e.middle().y()), 0.15 + entry().attached_m / 2);
}

TEST_P(EveryEquipment, ConsistsOfClosedPartsExceptPanes) {
  const Mesh mesh = make_equipment(entry().name);
  for (const auto& part : tests::parts_of(mesh)) {
    const tests::PartFacts facts = tests::facts_of(mesh, part);
    EXPECT_GT(facts.smallest_triangle_m2, 1e-8);
    if (mesh.materials[part.front()] == static_cast<std::uint16_t>(MaterialId::glass_clear_float_pane)) continue;
    EXPECT_TRUE(facts.closed) << facts.middle.transpose();
    EXPECT_GT(facts.volume_m3, 0) << facts.middle.transpose();
  }
}

std::vector<const char*> names() {
  std::vector<const char*> list;
  for (const EquipmentEntry& e : equipment()) list.push_back(e.name);
  return list;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEquipment, ::testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Equipment, AnUnknownNameIsAnErrorWithASuggestion) {
  try {
    equipment_entry("fuel-truk");
    FAIL() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("refueller"));
  }
  try {
    equipment_entry("refuller");
    FAIL() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean refueller?"));
  }
}

TEST(PassengerStairs, ReachTheSillTheyAreBuiltFor) {
  for (const double sill_m : {1.2, 2.66, 3.4, 5.2}) {
    MeshBuilder b("stairs");
    add_passenger_stairs(b, sill_m);
    const Mesh mesh = std::move(b).build();
    const double front = passenger_stairs_front_m(sill_m);
    const tests::Hit hit = tests::first_hit(mesh, Vector3d(front - 0.4, 0, 10), -Vector3d::UnitZ());
    EXPECT_NEAR(10 - hit.distance_m, sill_m + 0.03, 1e-5);
    EXPECT_EQ(tests::first_hit(mesh, Vector3d(front + 0.01, 0, 10), -Vector3d::UnitZ()).distance_m,
              std::numeric_limits<double>::infinity());
  }
}

TEST(Person, IsOneMetreSeventyFiveTallAndStandsOnBothFeet) {
  const Mesh person = make_person({});
  const tests::Extent e = tests::extent_of(person);
  EXPECT_NEAR(e.high.z(), 1.75, 0.005);
  EXPECT_NEAR(e.low.z(), 0, 1e-5);
  std::size_t left = 0, right = 0;
  for (const Eigen::Vector3f& v : person.vertices) {
    if (v.z() < 0.001f) ++(v.y() > 0 ? left : right);
  }
  EXPECT_GE(left, 4u);
  EXPECT_GE(right, 4u);
}

TEST(Person, TheLowerFootStaysOnTheGroundThroughTheStride) {
  for (const double gait : {0.5, 1.0}) {
    for (int k = 0; k < 72; ++k) {
      const tests::Extent e = tests::extent_of(make_person({.gait_phase_rad = 2 * pi * k / 72, .gait = gait}));
      EXPECT_LT(std::abs(e.low.z()), 0.003) << "phase " << k * 5 << " deg";
    }
  }
}

TEST(Person, TheStandingFootHardlySlipsAtTheStridesSpeed) {
  const double stride = person_stride_m();
  EXPECT_NEAR(stride, 1.4, 0.05);
  // The right foot stands while the left leg swings forward: phases -pi/2 to pi/2.
  double low = 1e9, high = -1e9;
  for (int k = -30; k <= 30; ++k) {
    const double phase = pi / 2 * k / 30;
    const auto T = person_pose({.gait_phase_rad = phase, .gait = 1});
    const double x = T[6].translation().x() + stride * phase / (2 * pi);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  EXPECT_LT(high - low, 0.16);
  EXPECT_LT(high - low, 0.25 * stride / 2) << "of a step";
}

TEST(Person, JointsHoldInEveryPosture) {
  const auto& parts = person_parts();
  for (const PersonPosture& posture : {PersonPosture{}, PersonPosture{.gait_phase_rad = 1, .gait = 1},
                                       PersonPosture{.arms_raised = 1, .wave_phase_rad = 2},
                                       PersonPosture{.gait_phase_rad = 4, .gait = 0.7, .arms_raised = 0.5}}) {
    const auto T = person_pose(posture);
    ASSERT_EQ(T.size(), parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      ASSERT_LT(parts[p].parent, static_cast<int>(p));
      EXPECT_TRUE(T[p].linear().isUnitary(1e-9));
      if (parts[p].parent < 0) continue;
      EXPECT_LT((T[p].translation() - T[static_cast<std::size_t>(parts[p].parent)] * parts[p].joint_m).norm(), 1e-12)
          << parts[p].name;
    }
    const tests::Extent e = tests::extent_of(make_person(posture));
    EXPECT_LT(e.low.cwiseAbs().cwiseMax(e.high.cwiseAbs()).norm(), kPersonRadius_m);
  }
}

TEST(Person, RaisedWandsAreAboveTheHead) {
  EXPECT_GT(tests::extent_of(make_person({.arms_raised = 1})).high.z(), 1.9);
}

TEST(Person, WearsRetroReflectingBands) {
  double area = 0;
  const Mesh person = make_person({});
  for (std::size_t t = 0; t < person.triangles.size(); ++t) {
    if (person.materials[t] != static_cast<std::uint16_t>(MaterialId::retro_sheeting_ra1)) continue;
    const auto& [i, j, k] = person.triangles[t];
    const Vector3d a = person.vertices[i].cast<double>();
    area += 0.5 * (person.vertices[j].cast<double>() - a).cross(person.vertices[k].cast<double>() - a).norm();
  }
  EXPECT_GT(area, 0.13) << "class 2 clothing";  // EN ISO 20471: 0.13 m2 of band
}

}  // namespace
}  // namespace tarmac::scenes
