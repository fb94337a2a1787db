#include "sim/truth/bumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/truth/motion.h"
#include "sim/truth/road.h"
#include "sim/truth/vehicles.h"
#include "tests/support/numeric_jet.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using testing::AllOf;
using testing::HasSubstr;
using tests::derivative_of;

TEST(Bumps, DerivativesMatchDifferencesAndVanishAtTheEnds) {
  const Bumps bumps({{.kind = "hump", .at_m = 5}, {.kind = "kerb", .at_m = 8, .tracks = "left"}}, 0.12);
  const auto f = [&](double s) { return bumps.at(s).left_m.f; };
  const auto d1 = [&](double s) { return bumps.at(s).left_m.d1; };
  const auto d2 = [&](double s) { return bumps.at(s).left_m.d2; };
  for (const double s : {4.6, 4.8, 5.0, 5.3, 7.95, 8.0, 8.03, 8.2}) {
    const Jet z = bumps.at(s).left_m;
    EXPECT_NEAR(z.d1, derivative_of(f, s, 1e-4), 1e-9) << s;
    EXPECT_NEAR(z.d2, derivative_of(d1, s, 1e-4), 1e-5) << s;
    EXPECT_NEAR(z.d3, derivative_of(d2, s, 1e-4), 1e-2) << s;
  }
  // cos^4: all of value and three derivatives go to nothing at 0.8 m and the contact patch.
  const Jet end = bumps.at(5 + 0.46 - 1e-7).left_m;
  EXPECT_LT(std::abs(end.f) + std::abs(end.d1) + std::abs(end.d2) + std::abs(end.d3), 1e-3);
}

TEST(Bumps, AKerbStaysAndOneTrackIsOneTrack) {
  const Bumps bumps({{.kind = "kerb", .at_m = 8, .height_mm = -30, .tracks = "left"}, {.kind = "manhole", .at_m = 12}},
                    0.1);
  EXPECT_EQ(bumps.at(7).left_m.f, 0);
  EXPECT_DOUBLE_EQ(bumps.at(9).left_m.f, -0.03);
  EXPECT_EQ(bumps.at(9).right_m.f, 0);
  EXPECT_DOUBLE_EQ(bumps.at(12).right_m.f, 0.015);
  EXPECT_DOUBLE_EQ(bumps.at(12).left_m.f, -0.015) << "the manhole lies below the kerb";
}

TEST(Bumps, EachAxleMeetsThemInItsTurn) {
  RoadOptions flat;
  flat.roughness = "none";
  flat.joint_spacing_m = 0;
  const Road road(flat, 3, 1.6, 1,
                  {{.kind = "hump", .at_m = 20, .height_mm = 60}, {.kind = "manhole", .at_m = 40, .tracks = "right"}});
  EXPECT_DOUBLE_EQ(road.at(17)[heave].f, 0.03) << "the front axle is on it, three metres ahead";
  EXPECT_DOUBLE_EQ(road.at(17)[pitch].f, -0.06 / 3) << "nose up";
  EXPECT_EQ(road.at(17)[roll].f, 0);
  EXPECT_DOUBLE_EQ(road.at(20)[pitch].f, 0.06 / 3);
  EXPECT_EQ(road.at(18.5)[heave].f, 0) << "between the axles";
  EXPECT_DOUBLE_EQ(road.at(40)[roll].f, -0.015 / (2 * 1.6)) << "one of two axles, right side up";
}

/// One axle of a van of 1.4 Hz and 30 % over the hump at 10 km/h. The wheel's own peaks are 7.5 up and 8 m/s^2 down
/// with a car's quarter at 80 mm; the middle of the body has about half of it while one axle is on the hump.
TEST(Bumps, AHumpThrowsTheMiddleOfAVanByHalfOfWhatItDoesToAWheel) {
  const auto motion = make_motion(ConfigNode::parse(R"(
kind: drive
start: {speed_m_s: 2.78}
rest_s: 0
path: [{straight_m: 40}]
stop_peak_m_s2: 0
jitter: {speed_fraction_rms: 0}
wander: {lateral_rms_m: 0}
road: {roughness: none, joint_spacing_m: 0}
bumps: [{kind: hump, at_m: 15, height_mm: 60, length_m: 0.6}]
vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, rolling_rms_deg_s: 0}
)",
                                                    "test.yaml"),
                                  duration_from_s(9), nullptr, 1);
  double highest = 0, lowest = 0;
  for (double t = 3.9; t < 4.8; t += 1e-3) {  // front axle on it, rear axle not yet
    const Kinematics k = motion->at(time_from_s(t));
    const Eigen::Vector3d middle(1.5, 0, 0), w = k.omega_body;
    const double a =
        (k.a_world + k.T_world_body.linear() * (k.alpha_body.cross(middle) + w.cross(w.cross(middle)))).z();
    highest = std::max(highest, a), lowest = std::min(lowest, a);
  }
  std::printf("hump: %.2f up, %.2f down\n", highest, lowest);
  EXPECT_NEAR(highest, 7.5 / 2 * 60 / 80, 1);
  EXPECT_NEAR(lowest, -8.0 / 2 * 60 / 80, 1);
}

std::string error_of_road(const std::string& yaml) {
  return tests::message_of<InputError>(
      [&] { make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(10), nullptr, 1); });
}

TEST(Bumps, WheelsThatLeaveTheGroundAreAnErrorWithPlaceAndRemedy) {
  const std::string fast = R"(
kind: drive
vehicle: baggage-tractor
start: {speed_m_s: 4}
rest_s: 0
path: [{straight_m: 90}]
bumps:
  - {kind: cable-ramp, at_m: 20}
)";
  EXPECT_THAT(error_of_road(fast), AllOf(HasSubstr("test.yaml:7"), HasSubstr("bumps"), HasSubstr("leave the ground"),
                                         HasSubstr("m along the path"), HasSubstr("drive slower")));
  EXPECT_THAT(error_of_road("kind: drive\npath: [{straight_m: 9}]\nbumps: [{kind: crub}]\n"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("bumps.0.kind"), HasSubstr("kerb")));
  EXPECT_THAT(error_of_road("kind: drive\nvehicle: vam\npath: [{straight_m: 9}]\n"),
              AllOf(HasSubstr("test.yaml:2"), HasSubstr("did you mean 'van'")));
}

TEST(Vehicles, SetDefaultsThatTheBlockMayStillChange) {
  const auto resolved = [](const std::string& yaml) { return resolve_motion(ConfigNode::parse(yaml, "test.yaml")); };
  const std::string path = "kind: drive\npath: [{straight_m: 9}]\n";
  EXPECT_EQ(resolved(path), resolved(path + "vehicle: van\n")) << "the van is the default";
  EXPECT_THAT(resolved(path + "vehicle: bus\n"), HasSubstr("wheelbase_m: 5.9"));
  const std::string other = resolved(path + "vehicle: bus\nsuspension: {wheelbase_m: 6.5}\n");
  EXPECT_THAT(other, AllOf(HasSubstr("wheelbase_m: 6.5"), HasSubstr("roll_hz: 0.95")));
  // A driver notices: in a turn the bus leans most, the pushback tractor least.
  std::vector<double> lean;
  for (const std::string& name : vehicle_names()) {
    SuspensionOptions suspension;
    VibrationOptions vibration;
    set_vehicle(name, suspension, vibration);
    lean.push_back(suspension.lean_deg_per_m_s2 * 9.81);
  }
  EXPECT_THAT(lean, testing::ElementsAre(
                        testing::AllOf(testing::Gt(3), testing::Lt(6)), testing::AllOf(testing::Gt(3), testing::Lt(6)),
                        testing::AllOf(testing::Gt(4), testing::Lt(7)), testing::AllOf(testing::Gt(1), testing::Lt(2)),
                        testing::AllOf(testing::Gt(1), testing::Lt(2))));
}

}  // namespace
}  // namespace tarmac::sim::truth
