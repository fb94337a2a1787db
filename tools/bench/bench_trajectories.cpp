// What a query of a motion costs: poses at every stamp of a sweep, states with their Jacobians.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "core/gp_trajectory.h"
#include "core/knots.h"
#include "core/spline_fit.h"
#include "tools/bench/cpu_clock.h"
#include "tools/bench/rows.h"

namespace tarmac::tools {
namespace {

using core::Duration;
using core::SE3;
using core::Time;

constexpr int kRounds = 9;  // of each measure; the best counts
constexpr int kPoints = 131072, kStamps = 2048;
const Time kBegin = core::time_from_ns(1'700'000'000'000'000'000);
const Time kEnd = kBegin + Duration(1'000'000'000);
constexpr Duration kSpacing{100'000'000};

/// A slalom: 8 m/s, turning at up to 1 rad/s.
SE3 slalom(Time t) {
  const double s = core::to_s(t - kBegin);
  SE3 T = SE3::Identity();
  T.linear() = core::so3::exp({0, 0, 0.5 * std::sin(2 * s)}) * core::so3::exp({0.05 * std::sin(5 * s), 0, 0});
  T.translation() = Eigen::Vector3d(8 * s, 3 * std::sin(2 * s), 0.1 * std::cos(5 * s));
  return T;
}

core::SplineTrajectory spline(core::SplineKind kind, int order) {
  std::vector<Time> times;
  std::vector<SE3> poses;
  for (Time t = kBegin; t <= kEnd; t += Duration(10'000'000)) {
    times.push_back(t);
    poses.push_back(slalom(t));
  }
  return core::fit_spline(kind, order, core::uniform_knots(kBegin, kEnd, kSpacing, order), times, poses);
}

core::GpTrajectory process(core::GpModel model) {
  const core::SplineTrajectory smooth = spline(core::SplineKind::split, 6);
  std::vector<core::GpKnot> knots;
  for (Time t = kBegin; t <= kEnd; t += kSpacing) knots.push_back(core::gp_knot(t, smooth.at(t)));
  core::GpPrior prior;
  prior.model = model;
  if (model == core::GpModel::singer) prior.rate.setOnes();
  return {prior, std::move(knots)};
}

/// A sweep of 0.1 s in the middle, `points` to a stamp.
std::vector<Time> stamps(int points) {
  std::vector<Time> out;
  for (int i = 0; i < kPoints; ++i) {
    out.push_back(kBegin + Duration(450'000'000) + Duration(100'000'000LL * (i / points * points) / kPoints));
  }
  return out;
}

double best_ms(const std::function<void()>& work) {
  double best = 1e300;
  for (int round = 0; round < kRounds; ++round) best = std::min(best, 1e3 * cpu_s_of(work));
  return best;
}

void add_rows(const std::string& name, const core::ParametricTrajectory& trajectory, BenchRows& rows) {
  const std::vector<Time> distinct = stamps(1), shared = stamps(kPoints / kStamps);
  std::vector<Time> unique = shared;
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  if (unique.size() != kStamps) throw std::logic_error("bench trajectories: stamps are not what they should be");
  std::vector<SE3> poses(kPoints);
  std::vector<Eigen::Vector3d> points(kPoints, Eigen::Vector3d(10, 20, 3)), placed(kPoints);
  const auto row = [&](const char* metric, double value, const char* unit) {
    rows.push_back({"trajectories", name, metric, value, unit});
  };
  row("poses_131072_distinct_stamps_ms", best_ms([&] { trajectory.poses(distinct, poses); }), "ms");
  row("poses_131072_points_2048_stamps_ms", best_ms([&] { trajectory.poses(shared, poses); }), "ms");
  constexpr std::size_t kRun = kPoints / kStamps;
  const auto place = [&] {
    trajectory.poses(unique, std::span(poses).first(kStamps));
    for (std::size_t i = 0; i < kStamps; ++i) {
      const Eigen::Matrix3d R = poses[i].linear();
      const Eigen::Vector3d p = poses[i].translation();
      for (std::size_t k = i * kRun; k < (i + 1) * kRun; ++k) placed[k].noalias() = R * points[k] + p;
    }
  };
  row("place_131072_points_2048_stamps_ms", best_ms(place), "ms");
  if (!placed.back().allFinite()) throw std::logic_error("bench trajectories: a point was lost");
  core::StateJet jet;
  const auto jets = [&](core::Derivative upto) {
    return 1e3 / kStamps * best_ms([&] {
             for (const Time t : unique) trajectory.jet(t, upto, jet);
           });
  };
  row("jet_pose_us", jets(core::Derivative::pose), "us");
  row("jet_acceleration_us", jets(core::Derivative::acceleration), "us");
}

}  // namespace

BenchRows bench_trajectories(const Console&) {
  BenchRows rows;
  for (const int order : {4, 5, 6}) {
    add_rows(fmt::format("spline-split-order-{}", order), spline(core::SplineKind::split, order), rows);
    add_rows(fmt::format("spline-se3-order-{}", order), spline(core::SplineKind::se3, order), rows);
  }
  add_rows("gp-wnoa", process(core::GpModel::wnoa), rows);
  add_rows("gp-wnoj", process(core::GpModel::wnoj), rows);
  add_rows("gp-singer", process(core::GpModel::singer), rows);
  return rows;
}

}  // namespace tarmac::tools
