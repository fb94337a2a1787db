/// The oracle: what a sweep's geometry allows, whoever registers it. Its blocks are those of exact point-to-plane
/// residuals, one a static return, with the exact normal of the macro surface (before micro-relief) where the beam met
/// it, at the return's true firing time and the true pose. It is a property of recording and truth, not of any method.
///
///   r = n'(p - q)     dr/dxi = [ n'  (p x n)' ]   for p <- Exp(xi) p, p and n in frame c of information.h
///
/// Degenerate (docs: metrics/README.md): smallest eigenvalue of the scaled 6-DOF block below 1e-3; motion inside the
/// sweep: smallest eigenvalue of the difference's Schur complement below 5e-5. No hysteresis.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/trajectory.h"
#include "metrics/degeneracy/information.h"
#include "metrics/degeneracy/rule.h"
#include "metrics/sweep_source.h"
#include "sim/raycast/tracer.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

inline constexpr double kOracleDegenerateBelow = 1e-3;       ///< smallest eigenvalue, 6-DOF
inline constexpr double kOracleShearDegenerateBelow = 5e-5;  ///< smallest eigenvalue, difference's Schur complement

/// One beam's end on a surface, in the world.
struct SurfacePoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d n_world = Eigen::Vector3d::Zero();  ///< unit normal
  double phase = 0;                                   ///< in the sweep: 0 its first firing, 1 its last
};

/// The block of exact point-to-plane residuals, seen in frame c.
SweepInformation exact_information(std::span<const SurfacePoint> points, const core::SE3& T_world_c);

struct OracleSweep {
  std::int64_t index = 0;  ///< of the recording's sweep
  core::Time begin, end;   ///< true
  core::SE3 T_world_c = core::SE3::Identity();
  Eigen::Vector3d p_world_body = Eigen::Vector3d::Zero();  ///< the body's origin at mid-sweep
  double mean_range_m = 0;                                 ///< of the static returns
  std::size_t static_returns = 0;                          ///< of the recording
  std::size_t points = 0;                                  ///< that were asked for a normal
  std::size_t disagreeing = 0;          ///< of these: the traced beam met another object (an edge); left out
  std::optional<BlockAnalysis> blocks;  ///< empty: truth does not cover the sweep, or too few returns

  /// The smallest eigenvalues that decide; empty where the blocks are.
  std::optional<double> lambda_pose() const;
  std::optional<double> lambda_difference() const;
};

struct Oracle {
  std::vector<OracleSweep> sweeps;  ///< one a sweep of the recording
};

struct OracleSettings {
  int threads = 1;
  /// Returns asked for a normal, a sweep. Where there are more, every k-th is taken, k odd, so that every channel of a
  /// sensor with an even number of them takes its turn.
  std::size_t points_per_sweep = 8192;
};

/// Traces the beams of the recording's static returns again. Throws InputError when labels and recording do not belong
/// together. The same result at any number of threads.
Oracle make_oracle(const SweepSource& sweeps, const sim::truth::GroundTruth& truth,
                   const std::vector<sim::truth::PointLabels>& labels, const sim::raycast::Tracer& tracer,
                   const OracleSettings& settings);

/// The same; builds the truth's scene and its tracer, and reads labels from the truth's folder.
Oracle make_oracle(const core::Recording& recording, const sim::truth::GroundTruth& truth,
                   const OracleSettings& settings);

}  // namespace tarmac::metrics
