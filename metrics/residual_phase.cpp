#include "metrics/residual_phase.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using Eigen::Vector3d;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOpenAxis = 0.003;  // three surfaces in a thousand face along the axis, or fewer
constexpr double kFewestPoints = 50;

/// What is said of one bin: mean, spread, displacement forward, left, up.
using BinFigures = std::array<double, 5>;

BinFigures figures(const PhaseBin& bin) {
  if (bin.n < kFewestPoints) return {kNaN, kNaN, kNaN, kNaN, kNaN};
  const double m = bin.r / bin.n;
  const Vector3d d = implied_displacement(bin);
  return {m, std::sqrt(std::max(0.0, bin.rr / bin.n - m * m)), d.x(), d.y(), d.z()};
}

std::vector<PhaseBin> pooled(const std::vector<SweepResiduals>& sweeps, const std::vector<int>* times) {
  std::vector<PhaseBin> bins(sweeps.empty() ? 0 : sweeps.front().bins.size());
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const int n = times ? (*times)[k] : 1;
    for (std::size_t b = 0; n > 0 && b < bins.size(); ++b) bins[b].add(sweeps[k].bins[b], n);
  }
  return bins;
}

/// Slope and bend of y over bins' centres, weighted by w; NaN bins are left out.
std::array<double, 2> trend(const std::vector<double>& y, const std::vector<double>& w) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  std::size_t used = 0;
  for (std::size_t b = 0; b < y.size(); ++b) {
    if (!std::isfinite(y[b])) continue;
    const double s = (static_cast<double>(b) + 0.5) / static_cast<double>(y.size()) - 0.5;
    // 4 s^2 runs from 0 in the middle to 1 at the ends.
    const Vector3d a(1, s, 4 * s * s);
    H += w[b] * a * a.transpose();
    g += w[b] * y[b] * a;
    ++used;
  }
  if (used < 6) return {kNaN, kNaN};
  const Vector3d x = H.ldlt().solve(g);
  return {x[1], x[2]};
}

struct Replicates {
  std::vector<std::array<std::vector<double>, 5>> bins;  ///< per bin and figure
  std::array<std::array<std::vector<double>, 2>, 3> trends;
};

void keep(const std::vector<PhaseBin>& bins, std::vector<BinFigures>& out,
          std::array<std::array<double, 2>, 3>& trends) {
  out.clear();
  std::vector<double> weights;
  for (const PhaseBin& bin : bins) {
    out.push_back(figures(bin));
    weights.push_back(bin.n);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> d;
    for (const BinFigures& f : out) d.push_back(f[2 + axis]);
    trends[axis] = trend(d, weights);
  }
}

}  // namespace

Vector3d implied_displacement(const PhaseBin& bin) {
  const Vector3d open = Vector3d::Constant(kNaN);
  if (!(bin.n > 0)) return open;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(bin.nn / bin.n);
  if (!(eigen.eigenvalues()[0] > kOpenAxis)) return open;
  return bin.nn.ldlt().solve(bin.nr);
}

PhaseTrend add_phase_series(const std::vector<SweepResiduals>& sweeps, const BootstrapSettings& settings,
                            std::vector<Series>& series) {
  static constexpr const char* kNames[5] = {"residual_mean_by_phase", "residual_spread_by_phase",
                                            "displacement_forward_by_phase", "displacement_left_by_phase",
                                            "displacement_up_by_phase"};
  static constexpr const char* kLabels[5] = {"mean residual [m]", "spread of residuals [m]",
                                             "implied displacement forward [m]", "implied displacement left [m]",
                                             "implied displacement up [m]"};
  std::vector<BinFigures> value, replicate;
  std::array<std::array<double, 2>, 3> trend_value{}, trend_replicate{};
  keep(pooled(sweeps, nullptr), value, trend_value);
  Replicates all;
  all.bins.resize(value.size());
  for (const std::vector<int>& times : block_bootstrap(sweeps.size(), settings, "metrics/residual_phase")) {
    keep(pooled(sweeps, &times), replicate, trend_replicate);
    for (std::size_t b = 0; b < value.size(); ++b)
      for (std::size_t f = 0; f < 5; ++f) all.bins[b][f].push_back(replicate[b][f]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t c = 0; c < 2; ++c) all.trends[axis][c].push_back(trend_replicate[axis][c]);
  }
  for (std::size_t f = 0; f < 5; ++f) {
    Series s{kNames[f], "phase in the sweep", kLabels[f], {}, {}, {}, {}};
    for (std::size_t b = 0; b < value.size(); ++b) {
      const Bootstrapped band = bootstrapped(value[b][f], all.bins[b][f]);
      s.x.push_back((static_cast<double>(b) + 0.5) / static_cast<double>(value.size()));
      s.y.push_back(band.value);
      s.low.push_back(band.low);
      s.high.push_back(band.high);
    }
    series.push_back(std::move(s));
  }
  PhaseTrend trends;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    trends.slope_m[axis] = bootstrapped(trend_value[axis][0], all.trends[axis][0]);
    trends.bend_m[axis] = bootstrapped(trend_value[axis][1], all.trends[axis][1]);
  }
  return trends;
}

}  // namespace tarmac::metrics
