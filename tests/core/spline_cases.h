/// Splines for tests: every kind, order and spacing of knots, with a lively motion.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <vector>

#include "core/random.h"
#include "core/spline_trajectory.h"
#include "tests/core/parametric_laws.h"

namespace tarmac::core::spline_cases {

struct Case {
  SplineKind kind;
  int order;
  bool uniform;
};
inline void PrintTo(const Case& c, std::ostream* out) {
  *out << (c.kind == SplineKind::split ? "split" : "se3") << "_order" << c.order << (c.uniform ? "_even" : "_uneven");
}

inline constexpr std::int64_t kSpacing_ns = 100'000'000;
inline constexpr std::int64_t kOrigin_ns = 1'700'000'000'000'000'123;

/// Spacings of 0.1 s, or from 40 to 160 ms.
inline std::vector<Time> make_knots(int count, bool uniform) {
  const RandomStream stream(1, "test/spline_knots");
  std::vector<Time> knots = {time_from_ns(kOrigin_ns)};
  for (int i = 1; i < count; ++i) {
    const double factor = uniform ? 1 : 0.4 + 1.2 * stream.uniform(static_cast<std::uint64_t>(i));
    knots.push_back(knots.back() + Duration(static_cast<std::int64_t>(factor * kSpacing_ns)));
  }
  return knots;
}

inline Eigen::Vector3d vector(const RandomStream& stream, std::uint64_t i, std::uint32_t j) {
  return {stream.normal(i, 3 * j), stream.normal(i, 3 * j + 1), stream.normal(i, 3 * j + 2)};
}

/// A lively motion: about 10 m/s and 2 rad/s, changing from one control point to the next.
inline SplineTrajectory lively(const Case& c, std::uint64_t seed, int n = 12) {
  const RandomStream stream(seed, "test/spline");
  SE3 T = SE3::Identity();
  T.translation() = Eigen::Vector3d(300, -200, 10);
  std::vector<SE3> control;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(n); ++i) {
    Vector6 step;
    step << Eigen::Vector3d(1, 0, 0) + 0.3 * vector(stream, i, 0), 0.15 * vector(stream, i, 1);
    T = se3::normalized(T * se3::exp(step));
    control.push_back(T);
  }
  return {c.kind, c.order, control, make_knots(n + c.order, c.uniform)};
}

/// Times all over the span, the knots among them.
inline std::vector<Time> some_times(const SplineTrajectory& spline, int count, std::uint64_t seed = 5) {
  const RandomStream stream(seed, "test/times");
  std::vector<Time> times = {spline.begin(), spline.end()};
  const double span_ns = static_cast<double>((spline.end() - spline.begin()).count());
  for (int i = 0; i < count; ++i) {
    times.push_back(spline.begin() +
                    Duration(static_cast<std::int64_t>(span_ns * stream.uniform(static_cast<std::uint64_t>(i)))));
  }
  for (const Time t : spline.knots()) {
    if (spline.covers(t)) times.push_back(t);
  }
  std::sort(times.begin(), times.end());
  return times;
}

inline bool same_bits(const Kinematics& a, const Kinematics& b) {
  return a.T_world_body.matrix() == b.T_world_body.matrix() && state_difference(a, b).tail<12>().norm() == 0;
}

inline std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const SplineKind kind : {SplineKind::split, SplineKind::se3}) {
    for (const int order : {4, 5, 6}) {
      for (const bool uniform : {true, false}) cases.push_back({kind, order, uniform});
    }
  }
  return cases;
}

}  // namespace tarmac::core::spline_cases
