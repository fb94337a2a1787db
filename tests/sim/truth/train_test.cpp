#include "sim/truth/train.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "sim/truth/motion.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using testing::AllOf;
using testing::HasSubstr;

const std::vector<Train::Link> dolly{{0.6, 1.3}, {0, 1.6}};

Jet circle(double s, double radius) {
  return {s / radius, 1 / radius, 0, 0};
}

/// Distance of the last axle from the centre of the circle that the tug's rear axle drives on.
double radius_of_last_axle(double radius, double s) {
  Train::Problem problem;
  const Train train(
      dolly, [&](double x) { return circle(x, radius); }, s + 1, problem);
  EXPECT_EQ(problem.message, "");
  const auto headings = train.headings(s);
  double psi = s / radius, x = radius * std::sin(psi), y = radius * (1 - std::cos(psi));
  for (std::size_t i = 0; i < 2; ++i) {
    x -= dolly[i].hitch_m * std::cos(psi), y -= dolly[i].hitch_m * std::sin(psi);
    psi = headings[i].f;
    x -= dolly[i].length_m * std::cos(psi), y -= dolly[i].length_m * std::sin(psi);
  }
  return std::hypot(x, y - radius);
}

/// On a circle every axle runs on one of its own: the hitch at r^2 + a^2, each link's end at the root of what is left
/// of the hitch's r^2 less the link's length squared.
TEST(Train, OnACircleEachAxleFindsItsOwn) {
  for (const double R : {6.0, 8.0}) {
    const double want = std::sqrt(R * R + 0.6 * 0.6 - 1.3 * 1.3 - 1.6 * 1.6);
    EXPECT_NEAR(radius_of_last_axle(R, 60), want, 1e-9) << R;
  }
  EXPECT_NEAR(radius_of_last_axle(6, 60), 5.67, 0.005);
  EXPECT_NEAR(radius_of_last_axle(8, 60), 7.75, 0.005);
}

/// A single link hitched on the axle itself, behind a tug on a straight: tan(theta / 2) falls as exp(-s / L).
TEST(Train, FallsInLineBehindAStraightAsTheTractrixDoes) {
  Train::Problem problem;
  // The tug has turned by 1 rad when the straight begins: a very short turn far back is all it takes.
  const auto heading = [](double s) {
    const Jet h = scenes::chain({1 / (1 + std::exp(-(s - 2) / 0.05)), 0, 0, 0}, {s, 1, 0, 0});
    const double e = h.f * (1 - h.f) / 0.05;
    return Jet{h.f, e, e * (1 - 2 * h.f) / 0.05, e * (1 - 6 * h.f + 6 * h.f * h.f) / 0.0025};
  };
  const Train train({{0, 2}}, heading, 20, problem);
  EXPECT_EQ(problem.message, "");
  const double from = 1 - train.headings(4)[0].f;  // exp(-40): the turn is over
  for (const double s : {5.0, 8.0, 15.0}) {
    const double fold = 1 - train.headings(s)[0].f;
    EXPECT_NEAR(std::tan(fold / 2), std::tan(from / 2) * std::exp(-(s - 4) / 2), 1e-10) << s;
  }
}

TEST(Train, TableHasTheDerivativesThatItsEquationsGive) {
  Train::Problem problem;
  const auto heading = [](double s) {
    return Jet{0.6 * std::sin(s / 4), 0.15 * std::cos(s / 4), -0.0375 * std::sin(s / 4), -0.009375 * std::cos(s / 4)};
  };
  const Train train(dolly, heading, 40, problem);
  EXPECT_EQ(problem.message, "");
  EXPECT_LT(train.certificate_rad(), 1e-10);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto f = [&](double s) { return train.headings(s)[i].f; };
    const auto d1 = [&](double s) { return train.headings(s)[i].d1; };
    const auto d2 = [&](double s) { return train.headings(s)[i].d2; };
    for (double s = 0.5; s < 39; s += 0.737) {
      const Jet theta = train.headings(s)[i];
      EXPECT_NEAR(theta.d1, tests::derivative_of(f, s, 4e-3), 1e-9) << s;
      EXPECT_NEAR(theta.d2, tests::derivative_of(d1, s, 4e-3), 1e-9) << s;
      EXPECT_NEAR(theta.d3, tests::derivative_of(d2, s, 4e-3), 1e-6) << s;
    }
  }
}

/// The trailer's axle does not slip: all of its velocity is along its heading. Looked at where suspension and shaking
/// are off.
TEST(Towed, AxleDoesNotSlipAndCutsTheCorner) {
  const auto motion = make_motion(ConfigNode::parse(R"(
kind: towed
tug:
  rest_s: 1
  path: [{straight_m: 15}, {turn_deg: 90, radius_m: 6, blend_m: 4}, {straight_m: 30}]
  speed: [{to_m_s: 4, peak_m_s2: 2}]
  wander: {lateral_rms_m: 0}
links: [{hitch_m: 0.6, length_m: 1.3}, {hitch_m: 0, length_m: 1.6}]
road: {roughness: none, joint_spacing_m: 0}
suspension: {dive_deg_per_m_s2: 0, lean_deg_per_m_s2: 0}
vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, rolling_rms_deg_s: 0}
)",
                                                    "test.yaml"),
                                  duration_from_s(16), nullptr, 1);
  EXPECT_NEAR(motion->pose(Time()).translation().x(), -3.5, 1e-12) << "behind the tug by 0.6 + 1.3 + 1.6 m";
  double fastest_turn = 0;
  for (double t = 1.2; t < 16; t += 0.05) {
    const Kinematics k = motion->at(time_from_s(t));
    const Eigen::Vector3d v_body = k.T_world_body.linear().transpose() * k.v_world;
    EXPECT_LT(std::abs(v_body.y()), 1e-9) << t;
    EXPECT_GE(v_body.x(), 0) << t;
    fastest_turn = std::max(fastest_turn, k.omega_body.z());
  }
  EXPECT_GT(fastest_turn, 0.4);
}

TEST(Towed, AJackKnifeIsAnErrorWithPlaceAndRemedy) {
  const std::string yaml =
      "kind: towed\ntug: {path: [{turn_deg: 300, radius_m: 2, blend_m: 1}], speed: [{to_m_s: 2}]}\n"
      "links:\n  - {hitch_m: 0.6, length_m: 4}\n";
  try {
    make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(20), nullptr, 1);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("test.yaml:3"), HasSubstr("links"), HasSubstr("jack-knifes"),
                                    HasSubstr("wider turns")));
  }
  EXPECT_THROW(resolve_motion(ConfigNode::parse("kind: towed\nlinks: []\n", "test.yaml")), InputError);
}

}  // namespace
}  // namespace tarmac::sim::truth
