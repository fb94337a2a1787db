#include "scenes/actors/trailers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/actors/convoys.h"
#include "scenes/paths/planar_path.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::scenes {
namespace {

/// A circle of radius r, counter-clockwise from (r, 0).
PlanarJets on_circle(double r, double s) {
  const double k = 1 / r, angle = k * s, sin = std::sin(angle), cos = std::cos(angle);
  return {{r * cos, -sin, -k * cos, k * k * sin}, {r * sin, cos, -k * sin, -k * k * cos}, {angle + M_PI / 2, k, 0, 0}};
}

PlanarPath bend(double radius_m, double turn_deg, double straight_m) {
  const std::vector<PathPiece> pieces{{.straight_m = 3},
                                      {.straight_m = 0, .turn_deg = turn_deg, .radius_m = radius_m, .blend_m = 2},
                                      {.straight_m = straight_m}};
  std::vector<PlanarPath::Problem> problems;
  PlanarPath path({}, pieces, {}, problems);
  EXPECT_TRUE(problems.empty());
  path.tabulate(path.length_m());
  return path;
}

TrailerChain::Leader leader_on(const PlanarPath& path) {
  return [&path](double s) {
    const PlanarPath::Point p = path.at(s);
    const SinCos direction = sin_cos(p.heading);
    return PlanarJets{{p.x_m, direction.cos.f, direction.cos.d1, direction.cos.d2},
                      {p.y_m, direction.sin.f, direction.sin.d1, direction.sin.d2},
                      p.heading};
  };
}

// r_hitch^2 = r^2 + a^2 and r_axle^2 = r_hitch^2 - L^2, link after link.
TEST(Trailers, SettleOnTheCirclesOfTheSteadyTurn) {
  const double r = 8, a = 0.6, L = 2.1;
  const TrailerChain chain([&](double s) { return on_circle(r, s); }, std::vector<TrailerChain::Link>(4, {a, L}), 120);
  const double s = 119.3;
  const PlanarJets lead = on_circle(r, s);
  double expected = r;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    expected = std::sqrt(expected * expected + a * a - L * L);
    const PlanarPose axle = chain.pose(i, s, {lead.x_m.f, lead.y_m.f, lead.heading.f});
    EXPECT_NEAR(std::hypot(axle.x_m, axle.y_m), expected, 1e-9) << "link " << i;
  }
}

// Behind a coupling that moves straight on, tan(d / 2) falls as exp(-s / L).
TEST(Trailers, BendDecaysAsTheClosedFormOfTheTractrixSays) {
  const PlanarPath path = bend(6, 90, 30);
  const double L = 3.7, begin = path.length_m() - 30;
  const TrailerChain chain(leader_on(path), {{0, L}}, path.length_m());
  const double heading = path.heading(begin).f;
  const double at_begin = std::tan((chain.heading(0, begin).f - heading) / 2);
  EXPECT_GT(std::abs(at_begin), 0.1);
  for (double s = 0; s < 29; s += 0.37)
    EXPECT_NEAR(std::tan((chain.heading(0, begin + s).f - heading) / 2), at_begin * std::exp(-s / L), 1e-10) << s;
}

TEST(Trailers, LawHoldsBetweenTheNodesAndDerivativesAreConsistent) {
  const PlanarPath path = bend(7, 120, 20);
  const std::vector<TrailerChain::Link> links{{0.93, 3.7}, {0.6, 3.7}, {0.6, 3.7}};
  const TrailerChain chain(leader_on(path), links, path.length_m());
  const auto axle = [&](std::size_t i, double s) {
    const PlanarPath::Point p = path.at(s);
    const PlanarPose pose = chain.pose(i, s, {p.x_m, p.y_m, p.heading.f});
    return Eigen::Vector2d(pose.x_m, pose.y_m);
  };
  for (double s = 1.013; s < path.length_m() - 1; s += 0.217) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Jet heading = chain.heading(i, s);
      const Eigen::Vector2d v = tests::derivative_of([&](double x) { return axle(i, x); }, s, 2e-3);
      EXPECT_NEAR(-std::sin(heading.f) * v.x() + std::cos(heading.f) * v.y(), 0, 1e-8) << "slips at " << s;
      const auto twin = [&](auto part) {
        return tests::derivative_of([&](double x) { return part(chain.heading(i, x)); }, s, 2e-3);
      };
      EXPECT_NEAR(heading.d1, twin([](const Jet& j) { return j.f; }), 1e-9);
      EXPECT_NEAR(heading.d2, twin([](const Jet& j) { return j.d1; }), 1e-8);
      EXPECT_NEAR(heading.d3, twin([](const Jet& j) { return j.d2; }), 1e-5);
    }
  }
}

TEST(Trailers, HalvingTheStepChangesNothingThatCounts) {
  const PlanarPath path = bend(6, 150, 20);
  const std::vector<TrailerChain::Link> links(5, {0.6, 3.7});
  const TrailerChain coarse(leader_on(path), links, path.length_m()),
      fine(leader_on(path), links, path.length_m(), 0.025);
  for (double s = 0.01; s < path.length_m(); s += 0.0713)
    for (std::size_t i = 0; i < links.size(); ++i)
      EXPECT_NEAR(coarse.heading(i, s).f, fine.heading(i, s).f, 1e-10) << i << " at " << s;
}

TEST(Pushback, NoseGearRollsAlongTheTowbarAndTheTractorDoesNotSlip) {
  const std::vector<PathPiece> pieces{
      {.straight_m = 20}, {.straight_m = 0, .turn_deg = -80, .radius_m = 20, .blend_m = 12}, {.straight_m = 15}};
  std::vector<PlanarPath::Problem> path_problems;
  PlanarPath path({.x_m = 3, .y_m = 20, .heading_deg = -90}, pieces, {}, path_problems);
  path.tabulate(path.length_m());
  std::vector<SpeedProfile::Problem> speed_problems;
  const SpeedEvent off{.to_m_s = 1.2, .peak_m_s2 = 0.3};
  const SpeedProfile speed({.start_m_s = 0, .rest_s = 0, .events = {off}, .stop_peak_m_s2 = 0.3}, path.length_m(), {},
                           speed_problems);
  ASSERT_TRUE(path_problems.empty() && speed_problems.empty());
  const double wheelbase = 12.64, bar = 4.5, tractor = 4;
  const Pushback pushback(Course(path, speed), wheelbase, bar, tractor);
  const auto u = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  const auto place = [&](std::size_t body, double s) {
    const PlanarPose p = pushback.body(body, s);
    return Eigen::Vector2d(p.x_m, p.y_m);
  };
  const auto nose = [&](double s) {
    return Eigen::Vector2d(place(Pushback::aircraft, s) +
                           wheelbase * u(pushback.body(Pushback::aircraft, s).heading_rad));
  };
  double sharpest = 0;
  for (double s = 0.5; s < path.length_m() - 0.5; s += 0.31) {
    const PlanarPose towbar = pushback.body(Pushback::towbar, s), pusher = pushback.body(Pushback::tractor, s);
    EXPECT_LT((place(Pushback::towbar, s) + bar * u(towbar.heading_rad) - nose(s)).norm(), 1e-12);
    EXPECT_LT((place(Pushback::tractor, s) + tractor * u(pusher.heading_rad) - place(Pushback::towbar, s)).norm(),
              1e-12);
    const auto slip = [](const Eigen::Vector2d& v, double heading) {
      return std::abs(std::cos(heading) * v.y() - std::sin(heading) * v.x());
    };
    EXPECT_LT(slip(tests::derivative_of(nose, s, 1e-3), towbar.heading_rad), 1e-8) << s;
    EXPECT_LT(
        slip(tests::derivative_of([&](double x) { return place(Pushback::tractor, x); }, s, 1e-3), pusher.heading_rad),
        1e-8)
        << s;
    const double steer = towbar.heading_rad + M_PI - pushback.body(Pushback::aircraft, s).heading_rad;
    sharpest = std::max(sharpest, std::abs(std::remainder(steer, 2 * M_PI)));
  }
  EXPECT_NEAR(pushback.sharpest_steer().angle_rad, std::atan(wheelbase / 20), 1e-3);
  EXPECT_NEAR(sharpest, pushback.sharpest_steer().angle_rad, 1e-3);
}

}  // namespace
}  // namespace tarmac::scenes
