/// Drives whose residuals are written down from geometry: a true motion, the motion by which a method placed its
/// points, and surfaces exactly where the truth saw them. Nothing here uses the instrument's model of small errors.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/diagnostics.h"
#include "metrics/diagnosis.h"
#include "metrics/evaluate.h"

namespace tarmac::metrics::tests {

/// What a method made of the time in a sweep.
struct Method {
  /// How it is wrong: T_map_body at a stamp, from the sweep's index and the stamp in s from its begin.
  std::function<core::SE3(int sweep, double stamp_s)> placed_by;
  /// Its stamps, from the true time in s since the sweep's begin.
  std::function<double(double t_s)> stamp_s = [](double t_s) { return t_s; };
  enum class Shape { sampled, screw, held } shape = Shape::sampled;
};

struct TimingWorld {
  explicit TimingWorld(std::uint64_t seed, int sweeps = 150);

  static constexpr double kPeriod = 0.1, kSpan = 0.0995;
  double begin_s(int k) const { return 1 + kPeriod * k; }
  core::SE3 truth(double t_s) const;
  const core::SmoothTrajectory& motion() const { return *motion_; }

  /// Runs the instrument over what the method would have recorded. Each sweep is first put where the truth has its
  /// middle, as a registration would; residuals carry `noise_m`.
  Evidence examine(const Method& method, double noise_m = 0.02) const;
  /// The same with its rows and series.
  Evidence examine(const Method& method, double noise_m, RowSet& rows, std::vector<Series>& series) const;

  std::uint64_t seed;
  int sweeps;

 private:
  std::shared_ptr<const core::SmoothTrajectory> motion_;
};

}  // namespace tarmac::metrics::tests
