#include "core/spline_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/knots.h"
#include "core/random.h"
#include "tests/core/spline_cases.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using spline_cases::kOrigin_ns;
using tests::message_of;
using tests::pose_difference;

constexpr double kPi = 3.14159265358979323846;

/// A slalom with a swaying body: 8 m/s, turns at 1 rad/s, frequencies of 0.3 and 0.7 Hz.
SE3 slalom(double s) {
  SE3 T = SE3::Identity();
  T.linear() =
      so3::exp({0, 0, 0.5 * std::sin(2 * kPi * 0.3 * s)}) * so3::exp({0.05 * std::sin(2 * kPi * 0.7 * s), 0, 0});
  T.translation() = Eigen::Vector3d(8 * s, 3 * std::sin(2 * kPi * 0.3 * s), 0.1 * std::cos(2 * kPi * 0.7 * s));
  return T;
}

std::vector<Time> times_between(Time begin, Time end, int count) {
  std::vector<Time> times;
  for (int i = 0; i < count; ++i) times.push_back(begin + (end - begin) * i / (count - 1));
  return times;
}

struct Fit {
  SplineKind kind;
  int order;
};
class SplineFit : public ::testing::TestWithParam<Fit> {};
INSTANTIATE_TEST_SUITE_P(Spline, SplineFit,
                         ::testing::Values(Fit{SplineKind::split, 4}, Fit{SplineKind::split, 5},
                                           Fit{SplineKind::split, 6}, Fit{SplineKind::se3, 4}, Fit{SplineKind::se3, 5},
                                           Fit{SplineKind::se3, 6}),
                         [](const auto& each) {
                           return std::string(each.param.kind == SplineKind::split ? "split" : "se3") + "_order" +
                                  std::to_string(each.param.order);
                         });

const Time kBegin = time_from_ns(kOrigin_ns), kEnd = kBegin + Duration(3'000'000'000);

std::vector<SE3> slalom_at(std::span<const Time> times) {
  std::vector<SE3> poses;
  for (const Time t : times) poses.push_back(slalom(to_s(t - kBegin)));
  return poses;
}

TEST_P(SplineFit, RecoversASplineFromItsOwnPoses) {
  const auto [kind, order] = GetParam();
  const RandomStream stream(1, "test/fit");
  std::vector<Time> inner = {kBegin};
  for (std::uint64_t i = 0; inner.back() <= kEnd; ++i) {
    inner.push_back(inner.back() + Duration(static_cast<std::int64_t>(1e8 * (0.6 + stream.uniform(i)))));
  }
  const std::vector<Time> knots = with_margins(inner, order);
  std::vector<SE3> control;
  for (std::uint64_t i = 0; i + static_cast<std::uint64_t>(order) < knots.size(); ++i) {
    Vector6 xi;
    for (std::uint32_t k = 0; k < 6; ++k) xi[k] = 0.2 * stream.normal(1000 + i, k);
    control.push_back(slalom(0.1 * static_cast<double>(i)) * se3::exp(xi));
  }
  const SplineTrajectory truth(kind, order, control, knots);
  const auto times = times_between(truth.begin(), truth.end(), 400);
  std::vector<SE3> poses(times.size());
  truth.poses(times, poses);
  const SplineTrajectory fitted = fit_spline(kind, order, knots, times, poses, {.smoothness = 0});
  for (int i = 0; i < truth.blocks(); ++i) {
    EXPECT_LT(pose_difference(fitted.control_points()[static_cast<std::size_t>(i)],
                              truth.control_points()[static_cast<std::size_t>(i)]),
              1e-7)
        << i;
  }
  for (const Time t : times_between(truth.begin(), truth.end(), 333)) {
    EXPECT_LT(pose_difference(fitted.pose(t), truth.pose(t)), 1e-10);
  }
}

/// The error of an interpolating cubic spline is 5/384 h^4 |p''''|, and the other orders' are smaller still.
TEST_P(SplineFit, FollowsASmoothMotionAsCloselyAsItsOrderAllows) {
  const auto [kind, order] = GetParam();
  const auto times = times_between(kBegin, kEnd, 301);
  const double h = 0.1, omega = 2 * kPi * 0.3;
  const SplineTrajectory spline = fit_spline(kind, order, uniform_knots(kBegin, kEnd, duration_from_s(h), order), times,
                                             slalom_at(times), {.smoothness = 1e-12});
  const double bound_m = 5.0 / 384 * std::pow(h, 4) * 3 * std::pow(omega, 4);
  for (const Time t : times_between(kBegin, kEnd, 997)) {
    // Rotation (0.5 rad at the same frequency, and 0.05 rad at 0.7 Hz) is bounded alike; se3 adds the bend of a path
    // of 0.8 m between control points.
    EXPECT_LT(pose_difference(spline.pose(t), slalom(to_s(t - kBegin))), 10 * bound_m) << to_s(t - kBegin);
  }
}

TEST_P(SplineFit, SmoothnessBridgesAGapAndStraightensWithItsWeight) {
  const auto [kind, order] = GetParam();
  auto times = times_between(kBegin, kBegin + Duration(1'000'000'000), 101);
  const auto later = times_between(kBegin + Duration(2'000'000'000), kEnd, 101);
  times.insert(times.end(), later.begin(), later.end());
  const auto knots = uniform_knots(kBegin, kEnd, Duration(100'000'000), order);
  EXPECT_THAT(message_of<InputError>(
                  [&] { fit_spline(SplineKind::split, order, knots, times, slalom_at(times), {.smoothness = 0}); }),
              ::testing::HasSubstr("do not determine"));
  const auto energy = [&](double smoothness) {
    const SplineTrajectory spline = fit_spline(kind, order, knots, times, slalom_at(times), {.smoothness = smoothness});
    double sum = 0;
    for (const Time t : times_between(kBegin, kEnd, 500)) {
      const Kinematics state = spline.at(t);
      sum += state.a_world.squaredNorm() + state.alpha_body.squaredNorm();
    }
    return sum;
  };
  const double loose = energy(1e-6), stiff = energy(1e-1), stiffest = energy(1e3);
  EXPECT_LT(stiff, loose);
  EXPECT_LT(stiffest, 1e-3 * loose) << "towards a straight line at constant velocity";
}

TEST(SplineFitInput, IsRefusedWhereItMakesNoProblem) {
  const auto knots = uniform_knots(kBegin, kEnd, Duration(100'000'000), 4);
  const auto fit = [&](std::vector<Time> times, std::size_t poses) {
    return fit_spline(SplineKind::split, 4, knots, times, std::vector<SE3>(poses, SE3::Identity()));
  };
  EXPECT_NO_THROW(fit({kBegin, kEnd}, 2));
  EXPECT_THROW(fit({}, 0), InputError);
  EXPECT_THROW(fit({kBegin, kEnd}, 3), InputError);
  EXPECT_THROW(fit({kBegin, kBegin}, 2), InputError);
  EXPECT_THROW(fit({kBegin - Duration(1), kEnd}, 2), InputError);
  EXPECT_THROW(fit({kBegin, kEnd + Duration(200'000'000)}, 2), InputError);
}

}  // namespace
}  // namespace tarmac::core
