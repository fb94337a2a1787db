// Every type of aircraft against its published figures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/error.h"
#include "scenes/aircraft/aircraft.h"
#include "tests/scenes/mesh_checks.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;
using tests::Extent;
using tests::extent_of;

/// From the makers' airport-planning documents (ATR: weight and recovery manuals). Ranges: light to heavy.
struct Published {
  double length, span, height_low, height_high, sill_low, sill_high, fuselage_width, fuselage_height, crown_low,
      crown_high, belly;
  double nose_gear_x;
  std::vector<std::array<double, 4>> main_gear;  ///< x, track, wheels a leg, tyre radius
  double nose_wheel_radius, bridge_door_x;
  char code;
};

const std::map<std::string, Published>& published() {
  static const std::map<std::string, Published> table{
      {"a320",
       {37.57,
        35.80,
        11.83,
        12.08,
        3.38,
        3.48,
        3.95,
        4.14,
        5.86,
        5.97,
        1.79,
        5.07,
        {{17.71, 7.59, 2, 0.584}},
        0.381,
        5.04,
        'C'}},
      {"b737-800",
       {39.47,
        35.79,
        12.37,
        12.62,
        2.59,
        2.74,
        3.76,
        4.01,
        5.41,
        5.56,
        1.4,
        4.09,
        {{19.69, 5.72, 2, 0.56}},
        0.34,
        5.03,
        'C'}},
      {"a350-900",
       {66.80,
        64.75,
        17.14,
        17.47,
        5.04,
        5.36,
        5.96,
        6.09,
        8.50,
        8.64,
        2.0,
        4.63,
        {{33.29, 10.60, 4, 0.70}},
        0.55,
        6.82,
        'E'}},
      {"b777-300er",
       {73.86,
        64.80,
        18.24,
        18.85,
        4.80,
        5.13,
        6.20,
        6.20,
        8.46,
        8.78,
        2.2,
        5.89,
        {{37.11, 10.97, 6, 0.67}},
        0.60,
        6.74,
        'E'}},
      {"atr-72",
       {27.166,
        27.05,
        7.60,
        7.70,
        1.1,
        1.3,
        2.77,
        2.87,
        3.6,
        3.8,
        0.85,
        1.728,
        {{12.5, 4.10, 2, 0.43}},
        0.25,
        20.5,
        'C'}},
      {"a380",
       {72.73,
        79.75,
        24.12,
        24.27,
        5.10,
        5.36,
        7.14,
        8.41,
        10.75,
        10.97,
        2.38,
        4.97,
        {{33.58, 12.46, 4, 0.70}, {36.85, 5.26, 6, 0.70}},
        0.62,
        6.32,
        'F'}},
      {"e190",
       {36.24,
        28.72,
        10.33,
        10.57,
        2.58,
        2.63,
        3.01,
        3.35,
        5.0,
        5.2,
        1.6,
        4.13,
        {{17.96, 5.94, 2, 0.50}},
        0.30,
        5.14,
        'C'}},
  };
  return table;
}

/// Built once.
const Mesh& mesh_of(const std::string& name) {
  static std::map<std::string, Mesh> meshes;
  if (!meshes.contains(name)) meshes[name] = make_aircraft(aircraft_type(name));
  return meshes[name];
}

class EveryAircraft : public ::testing::TestWithParam<std::string> {
 protected:
  const AircraftType& type() const { return aircraft_type(GetParam()); }
  const Mesh& mesh() const { return mesh_of(GetParam()); }
  const Published& p() const { return published().at(GetParam()); }
};

TEST_P(EveryAircraft, HasThePublishedLengthSpanAndHeight) {
  const Extent e = extent_of(mesh());
  EXPECT_NEAR(e.high.x() - e.low.x(), p().length, 0.05);
  EXPECT_NEAR(e.high.x(), 0, 0.01) << "the nose tip is the origin";
  EXPECT_NEAR(e.high.y() - e.low.y(), p().span, 0.05);
  EXPECT_LE(e.high.y() - e.low.y(), p().span + 0.001);
  EXPECT_GE(e.high.z(), p().height_low);
  EXPECT_LE(e.high.z(), p().height_high);
  EXPECT_EQ(type().icao_code, p().code);
}

TEST_P(EveryAircraft, HasThePublishedFuselageAndSill) {
  double widest = 0, top = 0, bottom = 1e9;
  const double x = 0.42 * p().length;
  for (double z = 0; z < 12; z += 0.005) {
    const double half = fuselage_half_width_m(type(), x, z);
    widest = std::max(widest, half);
    if (half > 0) {
      top = z;
      bottom = std::min(bottom, z);
    }
  }
  EXPECT_NEAR(2 * widest, p().fuselage_width, 0.02 * p().fuselage_width);
  EXPECT_NEAR(top - bottom, p().fuselage_height, 0.02 * p().fuselage_height);
  EXPECT_GE(top, p().crown_low - 0.05);
  EXPECT_LE(top, p().crown_high + 0.05);
  EXPECT_GE(type().floor_z_m, p().sill_low);
  EXPECT_LE(type().floor_z_m, p().sill_high);
  EXPECT_EQ(type().doors.front().x_m, p().bridge_door_x);
  EXPECT_NEAR(type().belly_clearance_m, p().belly, 0.16);
}

TEST_P(EveryAircraft, StandsOnAllItsWheelsWhereTheyArePublished) {
  // A tyre touches z = 0 with the lowest vertices of its two innermost circles.
  std::vector<Vector3d> contacts;
  for (const Eigen::Vector3f& v : mesh().vertices) {
    ASSERT_GT(v.z(), -1e-4f) << "something is below the ground";
    if (v.z() < 1e-4f) contacts.push_back(v.cast<double>());
  }
  std::size_t wheels = 2;
  for (const auto& gear : p().main_gear) wheels += 2 * static_cast<std::size_t>(gear[2]);
  EXPECT_EQ(contacts.size(), 2 * wheels);
  const auto near = [&](double x, double y, double reach_x, double reach_y) {
    Extent e;
    std::size_t n = 0;
    for (const Vector3d& c : contacts) {
      if (std::abs(c.x() + x) > reach_x || std::abs(c.y() - y) > reach_y) continue;
      e.add(c);
      ++n;
    }
    EXPECT_GT(n, 0u);
    return e;
  };
  const Vector3d nose = near(p().nose_gear_x, 0, 1, 1).middle();
  EXPECT_NEAR(nose.x(), -p().nose_gear_x, 0.01);
  EXPECT_NEAR(nose.y(), 0, 0.01);
  for (const auto& [x, track, count, radius] : p().main_gear) {
    const Vector3d left = near(x, track / 2, 2.5, 1.4).middle(), right = near(x, -track / 2, 2.5, 1.4).middle();
    EXPECT_NEAR(left.x(), -x, 0.01);
    EXPECT_NEAR(left.y() - right.y(), track, 0.02);
  }
}

TEST_P(EveryAircraft, ConsistsOfClosedPartsThatFaceOutward) {
  for (const auto& part : tests::parts_of(mesh())) {
    const tests::PartFacts facts = tests::facts_of(mesh(), part);
    EXPECT_TRUE(facts.closed) << "an open part of " << part.size() << " triangles at " << facts.middle.transpose();
    EXPECT_GT(facts.volume_m3, 0) << "a part inside out at " << facts.middle.transpose();
    EXPECT_GT(facts.smallest_triangle_m2, 1e-8) << "at " << facts.middle.transpose();
  }
}

TEST_P(EveryAircraft, IsSymmetric) {
  // Every vertex has its mirror image, except those of the holds' doors, whose outline the skin's lines share anyway.
  std::set<std::array<long, 3>> cells;
  const auto cell = [](const Eigen::Vector3f& v, float sign) {
    return std::array<long, 3>{std::lround(v.x() * 500), std::lround(sign * v.y() * 500), std::lround(v.z() * 500)};
  };
  for (const Eigen::Vector3f& v : mesh().vertices) cells.insert(cell(v, 1));
  std::size_t alone = 0;
  for (const Eigen::Vector3f& v : mesh().vertices) {
    bool found = false;
    const auto [x, y, z] = cell(v, -1);
    for (long dx = -1; dx <= 1 && !found; ++dx) {
      for (long dy = -1; dy <= 1 && !found; ++dy) {
        for (long dz = -1; dz <= 1 && !found; ++dz) found = cells.contains({x + dx, y + dy, z + dz});
      }
    }
    alone += !found;
  }
  // Fan and propeller blades turn the same way on both sides.
  EXPECT_LT(static_cast<double>(alone), 0.03 * static_cast<double>(mesh().vertices.size()));
}

TEST_P(EveryAircraft, IsDeterministicAndModest) {
  const Mesh again = make_aircraft(type());
  EXPECT_EQ(again.vertices, mesh().vertices);
  EXPECT_EQ(again.triangles, mesh().triangles);
  EXPECT_LT(mesh().triangles.size(), 90000u);
}

TEST_P(EveryAircraft, OpensItsDoorIntoADarkCabin) {
  const Mesh open = make_aircraft(type(), 0);
  for (const auto& part : tests::parts_of(open)) EXPECT_TRUE(tests::facts_of(open, part).closed);
  const Door& door = type().doors.front();
  const double z = type().floor_z_m + door.height_m / 2;
  // A ray at mid-height of the door goes through the skin and meets something dark well inside.
  const auto first_hit = [&](const Mesh& m) {
    return tests::first_hit(m, Vector3d(-door.x_m, 30, z), -Vector3d::UnitY());
  };
  const double skin = fuselage_half_width_m(type(), door.x_m, z);
  const tests::Hit shut = first_hit(mesh()), inside = first_hit(open);
  EXPECT_NEAR(30 - shut.distance_m, skin, 0.02);
  EXPECT_LT(30 - inside.distance_m, 0) << "the far side of the entry area is beyond the centre line";
  EXPECT_LT(materials()[inside.material].diffuse, 0.15);
  // The leaf hangs ahead of the opening, outside the skin.
  const tests::Hit leaf =
      tests::first_hit(open, Vector3d(-door.x_m + 1.0 * door.width_m + 0.08, 30, z), -Vector3d::UnitY());
  EXPECT_GT(30 - leaf.distance_m, fuselage_half_width_m(type(), door.x_m - door.width_m - 0.08, z) + 0.05);
}

INSTANTIATE_TEST_SUITE_P(Types, EveryAircraft, ::testing::ValuesIn(aircraft_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(AircraftTable, HasTheSevenTypesByName) {
  EXPECT_THAT(aircraft_names(),
              testing::ElementsAre("a320", "a350-900", "a380", "atr-72", "b737-800", "b777-300er", "e190"));
}

TEST(AircraftTable, AnUnknownNameIsAnErrorWithASuggestion) {
  try {
    aircraft_type("a350");
    FAIL() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("there is no aircraft 'a350'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("b777-300er"));
  }
  try {
    aircraft_type("b737-80");
    FAIL() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean b737-800?"));
  }
}

TEST(AircraftTable, AHoldDoorCannotBeOpenedForPassengers) {
  const AircraftType& type = aircraft_type("a320");
  EXPECT_THROW(make_aircraft(type, type.doors.size() - 1), core::InputError);
  EXPECT_THROW(make_aircraft(type, 99), core::InputError);
}

/// Shares of the fuselage's side silhouette's and the wing's measures that tell types apart at a glance.
TEST(AircraftTable, SilhouettesDifferInWhatTellsTypesApart) {
  const auto engines = [](const char* name) { return 2 * aircraft_type(name).engines.size(); };
  EXPECT_EQ(engines("a380"), 4u);
  EXPECT_EQ(engines("b777-300er"), 2u);
  EXPECT_EQ(aircraft_type("b777-300er").main_gear.front().wheels, 6);
  EXPECT_EQ(aircraft_type("a350-900").main_gear.front().wheels, 4);
  EXPECT_TRUE(aircraft_type("atr-72").t_tail && aircraft_type("atr-72").high_wing);
  EXPECT_EQ(aircraft_type("atr-72").engines.front().propeller.blades, 6);
  EXPECT_LT(aircraft_type("b737-800").engines.front().flat_bottom, 1);
  // What rises above the wing at its tip: nothing on the 777, 2 m and more on A320, B737, A350.
  const auto rise = [](const char* name) {
    const AircraftType& t = aircraft_type(name);
    double tip = 0, plan = 0;
    for (const Eigen::Vector3f& v : mesh_of(name).vertices) {
      if (v.y() > t.span_m / 2 - 0.4) tip = std::max(tip, double(v.z()));
      if (std::abs(v.y() - (t.span_m / 2 - 4)) < 0.6) plan = std::max(plan, double(v.z()));
    }
    return tip - plan;
  };
  EXPECT_LT(rise("b777-300er"), 0.6);
  for (const char* name : {"a320", "b737-800", "a350-900"}) EXPECT_GT(rise(name), 1.8) << name;
}

}  // namespace
}  // namespace tarmac::scenes
