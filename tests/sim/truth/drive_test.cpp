#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "core/error.h"
#include "tests/sim/truth/hill.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/numeric.h"
#include "tests/support/numeric_jet.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;
using tests::derivative_of;
using tests::Hill;
using tests::stand_turn;

/// z = 0.015 x - 0.008 y + 2.
class Slope final : public scenes::Ground {
 public:
  double height_m(double x, double y, Eigen::Vector2d* g, Eigen::Vector3d* H) const override {
    if (g) *g << 0.015, -0.008;
    if (H) H->setZero();
    return 0.015 * x - 0.008 * y + 2;
  }
};

std::shared_ptr<const SmoothTrajectory> drive(const std::string& yaml, double duration_s,
                                              std::shared_ptr<const scenes::Ground> ground = nullptr) {
  return make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(duration_s), std::move(ground), 1);
}

/// Nothing but the path: no wander, ripple, road, vibration or load transfer.
const std::string bare = R"(
kind: drive
path: [{straight_m: 20}, {turn_deg: 90, radius_m: 6, blend_m: 4}, {straight_m: 40}]
speed: [{to_m_s: 4, peak_m_s2: 2}]
jitter: {speed_fraction_rms: 0}
wander: {lateral_rms_m: 0}
road: {roughness: none, joint_spacing_m: 0}
suspension: {dive_deg_per_m_s2: 0, lean_deg_per_m_s2: 0}
vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, rolling_rms_deg_s: 0}
)";

TEST(Drive, KinematicsAreTheDerivativesOfThePose) {
  const auto motion = stand_turn(24, 1, std::make_shared<Hill>());
  const auto at = [&](double t) { return motion->at(time_from_s(t)); };
  const auto p = [&](double t) -> Vector3d { return at(t).T_world_body.translation(); };
  const auto v = [&](double t) -> Vector3d { return at(t).v_world; };
  const auto R = [&](double t) -> Eigen::Matrix3d { return at(t).T_world_body.linear(); };
  const auto w = [&](double t) -> Vector3d { return at(t).omega_body; };
  constexpr double h = 2.5e-4;
  // Rest, speeding up, cruise, hard braking, tight turn; away from and amid joints.
  for (double t = 0.5; t < 23.9; t += 0.2171) {
    t = std::round(t * 1e6) * 1e-6;  // differences must hit whole nanoseconds
    const Kinematics k = at(t);
    EXPECT_LT((k.v_world - derivative_of(p, t, h)).norm(), 1e-7) << t;
    EXPECT_LT((k.a_world - derivative_of(v, t, h)).norm(), 1e-5) << t;
    const Eigen::Matrix3d W = k.T_world_body.linear().transpose() * derivative_of(R, t, h);
    const Vector3d omega(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1));
    EXPECT_LT((k.omega_body - omega / 2).norm(), 1e-8) << t;
    EXPECT_LT((k.alpha_body - derivative_of(w, t, h)).norm(), 1e-5) << t;
  }
}

TEST(Drive, StandTurnIsLongRestsBrakesHardAndTurnsTightly) {
  const auto motion = stand_turn(68);
  double length_m = 0, hardest = 0, fastest_turn = 0, brake_x_m = 0, top_speed = 0;
  double x_max = -1e9, x_min = 1e9, y_max = -1e9;
  Vector3d before = motion->pose(Time()).translation();
  for (int k = 1; k <= 6800; ++k) {
    const Kinematics now = motion->at(time_from_ns(k * 10'000'000LL));
    const Vector3d p = now.T_world_body.translation();
    if (k <= 300) {
      EXPECT_LT(now.v_world.norm(), 0.02) << "at rest but for the engine, k = " << k;
    } else {
      length_m += (p - before).head<2>().norm();
    }
    before = p;
    const double a_forward = now.T_world_body.linear().col(0).dot(now.a_world);
    if (a_forward < hardest) hardest = a_forward, brake_x_m = p.x();
    fastest_turn = std::max(fastest_turn, now.omega_body.z());
    top_speed = std::max(top_speed, now.v_world.norm());
    x_max = std::max(x_max, p.x()), x_min = std::min(x_min, p.x()), y_max = std::max(y_max, p.y());
  }
  EXPECT_GT(length_m, 255);
  EXPECT_LT(hardest, -4.5);
  EXPECT_NEAR(brake_x_m, 13, 3) << "on the road behind the stand";
  EXPECT_NEAR(fastest_turn, 0.5, 0.1);
  EXPECT_NEAR(top_speed, 7, 0.5);
  EXPECT_NEAR(x_max, 26, 1);
  EXPECT_NEAR(y_max, 38, 1);
  EXPECT_NEAR(x_min, -30, 1);
  EXPECT_LT(motion->at(motion->end()).v_world.norm(), 0.05) << "it has stopped";
}

TEST(Drive, WithoutDisturbancesTheRearAxleFollowsThePathAndDoesNotSlip) {
  const auto motion = drive(bare, 20);
  EXPECT_LT(tests::pose_difference(motion->pose(time_from_s(3)), SE3::Identity()), 1e-15);
  for (double t = 3.1; t < 20; t += 0.1) {
    const Kinematics k = motion->at(time_from_s(t));
    const Vector3d v_body = k.T_world_body.linear().transpose() * k.v_world;
    EXPECT_LT(std::abs(v_body.y()) + std::abs(v_body.z()), 1e-12) << t;
    EXPECT_LT(std::abs(k.T_world_body.translation().z()), 1e-15) << t;
  }
  const SE3 end = motion->pose(motion->end());
  EXPECT_NEAR(so3::angle_rad(end.linear()), std::numbers::pi / 2, 1e-12);
}

TEST(Drive, BrakingDipsTheNoseAndALeftTurnLeansTheBodyRight) {
  const auto motion = drive(R"(
kind: drive
start: {speed_m_s: 6}
rest_s: 1
path: [{straight_m: 10}, {turn_deg: 300, radius_m: 20, blend_m: 4}]
speed: [{at_s: 13, to_m_s: 2, peak_m_s2: 4}]
stop_peak_m_s2: 0
jitter: {speed_fraction_rms: 0}
wander: {lateral_rms_m: 0}
road: {roughness: none, joint_spacing_m: 0}
vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, rolling_rms_deg_s: 0}
)",
                            16);
  // Steady turn: a = v^2 / R = 1.8 m/s^2 leans by lean * a; roll about x, left side up.
  const Eigen::Matrix3d R = motion->pose(time_from_s(12.5)).linear();
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.45 * std::numbers::pi / 180 * 36 / 20, 1e-5);
  double lowest_nose = 0;
  for (double t = 13; t < 15.5; t += 0.01) {
    lowest_nose = std::min(lowest_nose, motion->pose(time_from_s(t)).linear()(2, 0));
  }
  EXPECT_LT(lowest_nose, -0.5 * std::numbers::pi / 180) << "x axis points down by half a degree at least";
}

TEST(Drive, StandsAndDrivesOnASlopeAsThePlaneTellsIt) {
  const auto ground = std::make_shared<Slope>();
  const auto motion = drive(bare, 16, ground);
  for (const double t : {1.0, 9.0}) {  // at rest, and long after the speed became constant, before the turn
    const SE3 T = motion->pose(time_from_s(t));
    const Vector3d normal = Vector3d(-0.015, 0.008, 1).normalized();
    EXPECT_NEAR(T.linear().col(2).dot(normal), 1, 1e-7) << t;
    EXPECT_NEAR(T.translation().z(), ground->height_m(T.translation().x(), T.translation().y(), nullptr, nullptr), 1e-3)
        << t;
  }
}

TEST(Drive, SameSeedSameBitsAlsoFromThreadsAndAnotherSeedAnotherDrive) {
  const auto a = stand_turn(8, 5), b = stand_turn(8, 5), c = stand_turn(8, 6);
  std::vector<Kinematics> from_threads(80);
  std::vector<std::thread> threads;
  for (int part = 0; part < 4; ++part) {
    threads.emplace_back([&, part] {
      for (int k = part; k < 80; k += 4) from_threads[k] = b->at(time_from_ns(k * 100'000'001LL));
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int k = 0; k < 80; ++k) {
    const Kinematics want = a->at(time_from_ns(k * 100'000'001LL));
    EXPECT_EQ(want.T_world_body.matrix(), from_threads[k].T_world_body.matrix());
    EXPECT_EQ(want.a_world, from_threads[k].a_world);
    EXPECT_EQ(want.alpha_body, from_threads[k].alpha_body);
  }
  EXPECT_NE(a->pose(time_from_s(7)).matrix(), c->pose(time_from_s(7)).matrix());
}

TEST(Drive, RefusesTimesOutsideItsSpan) {
  const auto motion = drive(bare, 4);
  EXPECT_NO_THROW(motion->at(motion->end()));
  EXPECT_THROW(motion->at(motion->end() + Duration(1)), OutOfSpan);
  EXPECT_THROW(motion->at(Time() - Duration(1)), OutOfSpan);
}

std::string error_of_drive(const std::string& yaml) {
  return tests::message_of<InputError>([&] { drive(yaml, 10); });
}

TEST(Drive, ErrorsNameFileLineAndField) {
  EXPECT_THAT(error_of_drive("kind: drive\n"), AllOf(HasSubstr("test.yaml"), HasSubstr("path")));
  EXPECT_THAT(error_of_drive("kind: drive\npath:\n  - {straight_m: 9}\n  - {turn_deg: 20, radius_m: 5}\n"),
              AllOf(HasSubstr("test.yaml:4"), HasSubstr("path"), HasSubstr("blend_m")));
  EXPECT_THAT(
      error_of_drive("kind: drive\npath: [{straight_m: 90}]\nspeed:\n  - {to_m_s: 5}\n  - {to_m_s: 0, by_m: 6}\n"),
      AllOf(HasSubstr("test.yaml:5"), HasSubstr("speed"), HasSubstr("raise peak_m_s2")));
  EXPECT_THAT(error_of_drive("kind: drive\npath: [{straight_m: 9}]\nspeed: [{to_m_s: 8}]\n"),
              AllOf(HasSubstr("stop_peak_m_s2"), HasSubstr("end of the path")));
  EXPECT_THAT(error_of_drive("kind: drive\npath: [{straight_m: 9}]\nroad: {roughness: E}\n"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("road.roughness")));
  EXPECT_THAT(error_of_drive("kind: drive\npath: [{straight_m: 9}]\njitter: {min_wavelength_m: 100}\n"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("max_wavelength_m")));
  EXPECT_THAT(error_of_drive("kind: drive\npath: [{straigth_m: 9}]\n"), HasSubstr("straight_m"));
}

}  // namespace
}  // namespace tarmac::sim::truth
