// What a step of the sliding-window and batch solver costs, by the length of the window.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "core/gp_trajectory.h"
#include "core/random.h"
#include "core/spline_trajectory.h"
#include "estimators/window/window.h"
#include "tools/bench/cpu_clock.h"
#include "tools/bench/rows.h"

namespace tarmac::tools {
namespace {

using core::Duration;
using core::Time;
using estimators::Window;

constexpr Duration kSpacing = std::chrono::milliseconds(100);
const Time kBegin = core::time_from_ns(1'700'000'000'000'000'000);

struct Load {
  int intervals = 0;
  int stamps = 0, points = 0;  // of the LiDAR: an interval, a stamp
  Duration imu_period{};
};

/// Forward at 2 m/s, turning this way and that.
std::vector<core::SE3> some_poses(int n) {
  const core::RandomStream stream(1, "bench/window");
  core::SE3 T = core::SE3::Identity();
  std::vector<core::SE3> poses;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::uint64_t>(i);
    core::Vector6 step;
    step << 0.2, 0, 0, 0.02 * stream.normal(k, 0), 0.02 * stream.normal(k, 1), 0.02 * stream.normal(k, 2);
    poses.push_back(T);
    T = core::se3::normalized(T * core::se3::exp(step));
  }
  return poses;
}

std::unique_ptr<core::ParametricTrajectory> spline(int intervals) {
  constexpr int kOrder = 4;
  const int n = intervals + kOrder - 1;
  std::vector<Time> knots;
  for (int i = 0; i < n + kOrder; ++i) knots.push_back(kBegin + (i - kOrder + 1) * kSpacing);
  return std::make_unique<core::SplineTrajectory>(core::SplineKind::split, kOrder, some_poses(n), knots);
}

std::unique_ptr<core::ParametricTrajectory> process(int intervals) {
  const std::unique_ptr<core::ParametricTrajectory> motion = spline(intervals + 1);
  core::GpPrior prior;
  prior.model = core::GpModel::wnoj;
  prior.qc.setConstant(100);
  std::vector<core::GpKnot> knots;
  for (int i = 0; i <= intervals; ++i)
    knots.push_back(core::gp_knot(kBegin + i * kSpacing, motion->at(kBegin + i * kSpacing)));
  return std::make_unique<core::GpTrajectory>(prior, knots);
}

estimators::LidarFactors planes(const core::Trajectory& motion, const Load& load) {
  const core::RandomStream stream(2, "bench/window");
  estimators::LidarFactors factors;
  std::uint64_t draw = 0;
  for (int i = 0; i < load.intervals * load.stamps; ++i) {
    const Time t = kBegin + kSpacing * i / load.stamps;
    const core::SE3 T = motion.pose(t);
    factors.stamps.push_back(t);
    for (int k = 0; k < load.points; ++k, ++draw) {
      const auto vector = [&](std::uint32_t j) {
        return Eigen::Vector3d(stream.normal(draw, j), stream.normal(draw, j + 1), stream.normal(draw, j + 2));
      };
      estimators::LidarFactor& f = factors.factors.emplace_back();
      f.p_body = 10 * vector(0);
      f.n_map = vector(3).normalized();
      f.q_map = T * f.p_body + 0.02 * vector(6);
    }
    factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
  }
  return factors;
}

Window make_window(std::unique_ptr<core::ParametricTrajectory> trajectory, const Load& load) {
  estimators::WindowModel model;
  model.gyro_sigma_rad_s = 0.01;
  model.accel_sigma_m_s2 = 0.1;
  model.gyro_walk_rad_s2_rthz = 1e-4;
  model.accel_walk_m_s3_rthz = 1e-3;
  model.free_gravity = true;
  model.gravity_sigma_rad = 0.05;
  estimators::WindowState state;
  state.trajectory = std::move(trajectory);
  state.biases = {{kBegin, core::Vector6::Zero()}};
  Window window(model, std::move(state));
  window.set_lidar(0, planes(window.trajectory(), load));
  for (Time t = kBegin; t < window.trajectory().end(); t += load.imu_period) {
    const core::Kinematics k = window.trajectory().at(t);
    estimators::ImuReading reading;
    reading.t = t;
    reading.gyro_rad_s = k.omega_body;
    reading.accel_m_s2 = k.T_world_body.linear().transpose() * (k.a_world + Eigen::Vector3d(0, 0, 9.80665));
    window.add(reading);
  }
  core::StateVector sigma = core::StateVector::Zero();
  sigma.head<6>().setConstant(0.01);
  window.add_anchor(kBegin, window.trajectory().at(kBegin), sigma);
  window.add_bias_anchor(0, core::Vector6::Zero(), core::Vector6::Ones());
  return window;
}

/// Best of `rounds`.
template <class Work>
double best_cpu_s(int rounds, const Work& work) {
  double best = cpu_s_of(work);
  for (int i = 1; i < rounds; ++i) best = std::min(best, cpu_s_of(work));
  return best;
}

void add_case(const std::string& model, std::unique_ptr<core::ParametricTrajectory> trajectory, const Load& load,
              int rounds, BenchRows& rows) {
  const std::string variant = fmt::format("{}-{}-intervals", model, load.intervals);
  const int knots = trajectory->blocks();
  const Window window = make_window(std::move(trajectory), load);
  const auto row = [&](const std::string& metric, double seconds) {
    rows.push_back({"window", variant, metric + "_ms", 1e3 * seconds, "ms"});
    rows.push_back({"window", variant, metric + "_us_per_knot", 1e6 * seconds / knots, "us"});
  };
  estimators::BandedSystem system = window.normal_equations();
  row("assemble", best_cpu_s(rounds, [&] { system = window.normal_equations(); }));
  row("cost", best_cpu_s(rounds, [&] { static_cast<void>(window.cost()); }));
  Eigen::VectorXd step;
  bool solved = true;
  row("solve", best_cpu_s(rounds, [&] { solved = system.solve(0, step) && solved; }));
  const int size = window.trajectory().block_size();
  row("covariances", best_cpu_s(rounds, [&] { solved = !system.covariance_runs(size, size).empty() && solved; }));
  if (!solved) throw std::runtime_error("bench window: the normal equations are singular");
}

}  // namespace

BenchRows bench_window(const Console& console) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const core::Progress progress = console.progress("window");
  const std::vector<int> sliding = {10, 20, 40, 80}, batch = {1000, 2000, 4000, 8000, 16000};
  const double all = static_cast<double>(2 * sliding.size() + batch.size());
  BenchRows rows;
  double done = 0;
  for (const int intervals : sliding) {  // 1024 columns a sweep of which each keeps two points, 200 Hz
    const Load load{intervals, 1024, 2, std::chrono::milliseconds(5)};
    add_case("spline", spline(intervals), load, 9, rows);
    progress(++done / all, fmt::format("{} intervals", intervals));
    add_case("wnoj", process(intervals), load, 9, rows);
    progress(++done / all, fmt::format("{} intervals", intervals));
  }
  for (const int intervals : batch) {  // thinned, as a batch over minutes is
    add_case("batch-spline", spline(intervals), {intervals, 64, 2, std::chrono::milliseconds(5)}, 3, rows);
    progress(++done / all, fmt::format("{} intervals", intervals));
  }
  return rows;
}

}  // namespace tarmac::tools
