#include "metrics/residual_slope.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using Eigen::Vector3d;

namespace {

using Vector12 = SweepShape::Vector12;
using Matrix12 = SweepShape::Matrix12;
using Design = Eigen::Matrix<double, 12, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kFewestSweeps = 20;
constexpr double kHuber = 1.345;
constexpr double kPriorInformation = 1e-12;  // a direction that no sweep shows stays at 0

/// Columns: k of translation and rotation, d of both, g of both.
Design design(const SweepResiduals& sweep) {
  Design B = Design::Zero();
  const double D = sweep.span_s, T = core::to_s(sweep.rates.end - sweep.rates.begin);
  const Vector6 change = sweep.rates.change * (D / T);  // over the span, where the stamps stretch it
  for (int part = 0; part < 2; ++part) {
    B.block<3, 1>(3 * part, part) = D * sweep.rates.twist.segment<3>(3 * part);
    B.block<3, 1>(3 * part, 2 + part) = -change.segment<3>(3 * part);
    B.block<3, 1>(6 + 3 * part, 4 + part) = -0.5 * D * change.segment<3>(3 * part);
  }
  return B;
}

struct Sample {
  Design B;
  Vector12 y;
  Matrix12 covariance;
  Matrix12 weight = Matrix12::Identity();
};

std::vector<Sample> samples_of(const std::vector<SweepResiduals>& sweeps) {
  std::vector<Sample> samples;
  for (const SweepResiduals& sweep : sweeps) {
    if (!sweep.fitted) continue;
    // What a sweep leaves open gets a metre or radian of its own.
    const Matrix12 information = sweep.shape.information + Matrix12::Identity();
    samples.push_back({design(sweep), sweep.shape.value, information.ldlt().solve(Matrix12::Identity())});
  }
  return samples;
}

struct Sums {
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  void add(const Sums& other, double times) {
    H += times * other.H;
    g += times * other.g;
  }
  Vector6 solve() const { return (H + kPriorInformation * Matrix6::Identity()).ldlt().solve(g); }
};

Sums sums_of(const Sample& s) {
  const Eigen::Matrix<double, 6, 12> BW = s.B.transpose() * s.weight;
  return {BW * s.B, BW * s.y};
}

/// Robust variance of each component about the regression, less what the sweeps' own fits explain.
Vector12 excess_variance(const std::vector<Sample>& samples, const Vector6& theta) {
  Vector12 excess = Vector12::Zero();
  for (int c = 0; c < 12; ++c) {
    std::vector<double> off, own;
    for (const Sample& s : samples) {
      off.push_back(std::abs((s.y - s.B * theta)[c]));
      own.push_back(s.covariance(c, c));
    }
    const double sigma = 1.4826 * quantile(std::move(off), 0.5);
    excess[c] = std::max(0.0, sigma * sigma - quantile(std::move(own), 0.5));
  }
  return excess;
}

void weigh(std::vector<Sample>& samples, const Vector6& theta, const Vector12& excess) {
  for (Sample& s : samples) {
    const Matrix12 covariance = s.covariance + Matrix12(excess.asDiagonal());
    s.weight = covariance.ldlt().solve(Matrix12::Identity());
    const Vector12 e = s.y - s.B * theta;
    const double distance = std::sqrt(e.dot(s.weight * e) / 12);
    if (distance > kHuber) s.weight *= kHuber / distance;
  }
}

Bootstrapped quantum(const std::vector<SweepResiduals>& sweeps, const std::vector<std::vector<int>>& draws) {
  const auto ratio = [&](const std::vector<int>* times) {
    double information = 0, score = 0;
    std::size_t k = 0;
    for (const SweepResiduals& sweep : sweeps) {
      if (!sweep.fitted) continue;
      const double n = times ? (*times)[k] : 1;
      ++k;
      information += n * sweep.saw.information;
      score += n * sweep.saw.score;
    }
    return information > 0 ? score / information : 0.0;
  };
  std::vector<double> replicates;
  for (const std::vector<int>& times : draws) replicates.push_back(ratio(&times));
  return bootstrapped(ratio(nullptr), replicates);
}

void keep_excitation(const std::vector<SweepResiduals>& sweeps, SlopeFit& fit) {
  std::vector<double> spans, dv, dw;
  std::size_t inside = 0;
  for (const SweepResiduals& sweep : sweeps) {
    if (!sweep.fitted) continue;
    spans.push_back(sweep.span_s);
    dv.push_back(sweep.rates.change.head<3>().norm());
    dw.push_back(sweep.rates.change.tail<3>().norm());
    inside += sweep.rates.inside;
  }
  fit.inside = 2 * inside > spans.size();
  fit.span_s = quantile(spans, 0.5);
  fit.speed_change_rms_m_s = rms(dv);
  fit.rate_change_rms_rad_s = rms(dw);
}

}  // namespace

SlopeFit fit_slopes(const std::vector<SweepResiduals>& sweeps, const BootstrapSettings& settings) {
  std::vector<Sample> samples = samples_of(sweeps);
  SlopeFit fit;
  fit.sweeps = samples.size();
  if (samples.size() < kFewestSweeps) return fit;
  keep_excitation(sweeps, fit);

  Vector6 theta = Vector6::Zero();
  std::vector<Sums> sums;
  for (int round = 0; round < 6; ++round) {
    weigh(samples, theta, excess_variance(samples, theta));
    Sums all;
    sums.clear();
    for (const Sample& s : samples) {
      sums.push_back(sums_of(s));
      all.add(sums.back(), 1);
    }
    theta = all.solve();
  }
  const auto draws = block_bootstrap(samples.size(), settings, "metrics/residual_slope");
  std::vector<std::vector<double>> replicates(6);
  for (const std::vector<int>& times : draws) {
    Sums all;
    for (std::size_t k = 0; k < sums.size(); ++k) all.add(sums[k], times[k]);
    const Vector6 x = all.solve();
    for (std::size_t c = 0; c < 6; ++c) replicates[c].push_back(x[static_cast<int>(c)]);
  }
  Bootstrapped* const out[6] = {&fit.scale_translation, &fit.scale_rotation,      &fit.lag_translation_s,
                                &fit.lag_rotation_s,    &fit.omitted_translation, &fit.omitted_rotation};
  for (std::size_t c = 0; c < 6; ++c) *out[c] = bootstrapped(theta[static_cast<int>(c)], replicates[c]);
  fit.quantum_s = quantum(sweeps, draws);
  return fit;
}

void add_slope_series(const std::vector<SweepResiduals>& sweeps, const SlopeFit& fit, std::vector<Series>& series) {
  const double deg = 180 / std::numbers::pi;
  Series rotation{"residual_slope_vs_domega",
                  "change of the rate of turn over the sweep [deg/s]",
                  "slope of the rotation error [deg/sweep]",
                  {},
                  {},
                  {},
                  {}};
  Series translation{"residual_slope_vs_dv",
                     "change of velocity over the sweep [m/s]",
                     "slope of the displacement [m/sweep]",
                     {},
                     {},
                     {},
                     {}};
  for (const SweepResiduals& sweep : sweeps) {
    if (!sweep.fitted) continue;
    for (int axis = 0; axis < 3; ++axis) {
      rotation.x.push_back(deg * sweep.rates.change[3 + axis]);
      rotation.y.push_back(deg * sweep.shape.value[3 + axis]);
      translation.x.push_back(sweep.rates.change[axis]);
      translation.y.push_back(sweep.shape.value[axis]);
    }
  }
  const auto line = [](const Series& scatter, const Bootstrapped& lag_s) {
    Series s{scatter.name + "_fit", scatter.x_label, scatter.y_label, {}, {}, {}, {}};
    if (scatter.x.empty()) return s;
    const auto [low, high] = std::minmax_element(scatter.x.begin(), scatter.x.end());
    for (const double x : {*low, 0.0, *high}) {
      s.x.push_back(x);
      s.y.push_back(-lag_s.value * x);
      s.low.push_back(-lag_s.value * x - lag_s.sigma * std::abs(x));
      s.high.push_back(-lag_s.value * x + lag_s.sigma * std::abs(x));
    }
    return s;
  };
  const Series rotation_fit = line(rotation, fit.lag_rotation_s),
               translation_fit = line(translation, fit.lag_translation_s);
  for (const Series& s : {rotation, rotation_fit, translation, translation_fit}) series.push_back(s);
}

}  // namespace tarmac::metrics
