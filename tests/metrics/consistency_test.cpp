// NEES of poses whose error is known in terms of the covariance that is stated.
#include "metrics/consistency.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

Matrix6 some_covariance() {
  Matrix6 L = Matrix6::Zero();
  const RandomStream stream(1, "test/covariance");
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      L(i, j) = (i == j ? 0.02 : 0.005 * stream.normal(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(j)));
  return L * L.transpose();
}

/// Poses along an arc in a tilted map, off by xi(k) in the body's frame; the first is exact.
template <class Error>
std::vector<PosePair> off_by(int n, const Error& error) {
  const SE3 T_map_world = pose({120, -75, 11}, {0.3, -0.8, 2.3});
  std::vector<PosePair> pairs;
  for (int k = 0; k < n; ++k) {
    const SE3 T_true = pose({0.8 * k, 0.02 * k * k, 1}, {0, 0.01, 0.05 * k});
    SE3 T_estimated = T_map_world * T_true;
    if (k > 0) T_estimated = T_estimated * se3::exp(error(k)).inverse();
    pairs.push_back({k, time_from_ns(k * 100'000'000LL), T_true, T_estimated, 0.8 * k});
  }
  return pairs;
}

std::vector<StatedCovariance> stated(int n, const Matrix6& covariance) {
  std::vector<StatedCovariance> all;
  for (int k = 0; k < n; ++k) all.push_back({k, covariance});
  return all;
}

/// xi = L u has xi^T (L L^T)^-1 xi = |u|^2, whatever the frame.
TEST(Consistency, NeesIsTheSquareOfTheWhitenedError) {
  const Matrix6 P = some_covariance();
  const Eigen::LLT<Matrix6> llt(P);
  const auto error = [&](int k) {
    const Vector6 u = Vector6::Unit(k % 6) * (1 + 0.1 * k);
    return Vector6(llt.matrixL() * u);
  };
  std::size_t left_out = 0;
  const std::vector<Nees> all = nees_of(off_by(20, error), stated(20, P), left_out);
  ASSERT_EQ(all.size(), 19u) << "the first fixes the frame";
  EXPECT_EQ(left_out, 0u);
  for (int k = 1; k < 20; ++k) {
    const double expected = (1 + 0.1 * k) * (1 + 0.1 * k);
    EXPECT_NEAR(all[static_cast<std::size_t>(k - 1)].nees, expected, 1e-8 * expected);
  }
}

TEST(Consistency, ErrorsDrawnFromTheStatedCovarianceAreCoveredByItsEllipsoids) {
  const Matrix6 P = some_covariance();
  const Eigen::LLT<Matrix6> llt(P);
  const RandomStream stream(2, "test/errors");
  const auto error = [&](int k) {
    Vector6 u;
    for (std::uint32_t i = 0; i < 6; ++i) u[i] = stream.normal(static_cast<std::uint64_t>(k), i);
    return Vector6(llt.matrixL() * u);
  };
  constexpr int kSweeps = 4000;
  const std::vector<PosePair> pairs = off_by(kSweeps, error);
  // Deviations stated half as large: all of NEES four times.
  for (const double scale : {1.0, 0.25}) {
    std::vector<SweepDiagnostics> sweeps(kSweeps);
    for (int k = 0; k < kSweeps; ++k) {
      sweeps[static_cast<std::size_t>(k)].index = k;
      sweeps[static_cast<std::size_t>(k)].covariance = scale * P;
    }
    const DiagnosticsSource diagnostics = diagnostics_of(sweeps);
    RowSet rows("causal");
    std::vector<Series> series;
    add_consistency(pairs, &diagnostics, Time{}, rows, series);
    const std::vector<Row> made = rows.rows();
    ASSERT_EQ(made.size(), 3u);
    // The mean of 4000 chi-squared with 6 degrees of freedom has a deviation of 0.0091 of itself.
    EXPECT_NEAR(*made[0].value * scale, 1, 4 * 0.0091) << made[0].metric;
    EXPECT_NEAR(*made[1].value, std::sqrt(*made[0].value), 1e-12);
    if (scale == 1)
      EXPECT_NEAR(*made[2].value, 95, 4 * 0.35) << "binomial";
    else
      EXPECT_LT(*made[2].value, 40) << "P(chi-squared of 6 < 12.59 / 4) is 0.21";
    ASSERT_EQ(series.size(), 1u);
    EXPECT_EQ(series[0].y.size(), static_cast<std::size_t>(kSweeps - 1));
  }
}

TEST(Consistency, WhatStatesNoCovarianceIsLeftOutAndSaysSo) {
  const auto none = [](int) { return Vector6(Vector6::Constant(1e-3)); };
  const std::vector<PosePair> pairs = off_by(4, none);
  const auto status = [&](const std::vector<Matrix6>& covariances) {
    std::vector<SweepDiagnostics> sweeps(covariances.size());
    for (std::size_t k = 0; k < sweeps.size(); ++k) {
      sweeps[k].index = static_cast<std::int64_t>(k);
      sweeps[k].covariance = covariances[k];
    }
    const DiagnosticsSource diagnostics = diagnostics_of(sweeps);
    RowSet rows("causal");
    std::vector<Series> series;
    add_consistency(pairs, &diagnostics, Time{}, rows, series);
    EXPECT_EQ(series.empty(), !rows.rows()[0].value.has_value());
    return rows.rows()[0].status;
  };
  const Matrix6 zero = Matrix6::Zero(), good = Matrix6::Identity();
  EXPECT_EQ(status({zero, zero, zero, zero}), "n/a: the method states no covariance of its poses");
  EXPECT_EQ(status({good, -good, -good, -good}), "n/a: no scored sweep has a positive definite covariance");
  EXPECT_EQ(status({good, good, zero, -good}), "ok: 1 sweeps; 1 without a positive definite covariance left out");
  Matrix6 broken = good;
  broken(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status({good, good, good, broken}), "ok: 2 sweeps; 1 without a positive definite covariance left out");
  RowSet rows("causal");
  std::vector<Series> series;
  add_consistency(pairs, nullptr, Time{}, rows, series);
  EXPECT_EQ(rows.rows()[0].status, "n/a: the run recorded no diagnostics");
}

}  // namespace
}  // namespace tarmac::metrics::tests
