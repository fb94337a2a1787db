/// One sweep's point-to-surface residuals, boiled down to sums.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/diagnostics.h"
#include "metrics/sweep_rates.h"

namespace tarmac::metrics {

/// Residuals whose points were fired in one part of the sweep.
struct PhaseBin {
  double n = 0, r = 0, rr = 0;                   ///< count, sum of r and of r^2
  Eigen::Matrix3d nn = Eigen::Matrix3d::Zero();  ///< sum of w n n^T, body axes
  Eigen::Vector3d nr = Eigen::Vector3d::Zero();  ///< sum of w n r
  void add(const PhaseBin& other, double times = 1);
};

/// A sweep's error as a motion over phase s in [0, 1], in the body's axes at mid-sweep:
///   xi(s) = xi0 + (s - 1/2) slope + ((s - 1/2)^2 - 1/12) bend,     r_i = J_i xi(s_i)
/// fitted with Tukey's weights. `information` is that of (slope, bend) with xi0 free, by the spread of its residuals.
struct SweepShape {
  using Vector12 = Eigen::Matrix<double, 12, 1>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  Vector12 value = Vector12::Zero();  ///< slope (translation [m], rotation [rad]), bend
  Matrix12 information = Matrix12::Zero();
};

/// How much of the sweep's motion passes unseen within one value of the stamp: r = ... - (u - 1/2) J twist q, u the
/// point's place among those with its stamp. One sweep's share of sum(information) q = sum(score).
struct SawTooth {
  double information = 0, score = 0;
};

struct SweepResiduals {
  std::int64_t index = 0;
  std::size_t rows = 0;
  double sigma_m = 0;  ///< spread of a residual about the fit, robust
  double span_s = 0;   ///< that phase 0 to 1 stands for, by the stamps
  std::vector<PhaseBin> bins;
  bool fitted = false;  ///< shape and saw hold; needs rates and at least 60 rows
  SweepRates rates;
  SweepShape shape;
  SawTooth saw;
};

struct ReduceSettings {
  int phase_bins = 32;
  double gate_m = 0.5;  ///< residuals beyond are no measurement of this surface
};

/// @param place  by the point's index, its place within its stamp; empty: no saw-tooth
/// @param rates  nullptr: bins only
SweepResiduals reduce_sweep(const core::SweepDiagnostics& sweep, core::Duration duration, const SweepRates* rates,
                            std::span<const float> place, const ReduceSettings& settings);

/// Where phase 0 and 1 lie, in ns from the sweep's begin: its span, stretched where stamps leave it; where they cover
/// less than a third of it (a wrong unit), the stamps' own span.
std::array<double, 2> phase_span_ns(std::span<const core::ResidualRow> rows, core::Duration duration);

}  // namespace tarmac::metrics
