/// Errors of every point at its own firing time: only exact truth can give these.
///
/// All compare x = A T^(t_i) T_body_lidar p_i, by the estimate T^ and the nominal extrinsic, with y = T(t_i)
/// T_body_lidar p_i, by the truth and the true extrinsic: the same measured p_i, so range noise cancels, and the same
/// true firing time t_i. What differs is A, the motion that carries map onto world:
///   point      A = T_0 T^_0^-1, from the first scored reference pose: drift and bending together
///   se3        A = the rigid fit of all reference positions
///   deskew     A = for each sweep the rigid motion that fits its static points best: bending alone
///   reference  A = T_k T^_k^-1, from the sweep's own reference pose: bending as seen from the reference instant
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/estimate.h"
#include "metrics/evaluation.h"
#include "metrics/row_set.h"
#include "metrics/statistics.h"
#include "metrics/sweep_source.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

/// The families that are also kept by phase in the sweep, over static points.
enum class PointFamily : std::size_t { point = 0, deskew = 1, reference = 2 };
inline constexpr std::size_t kPointFamilies = 3;

/// Sums of squared errors [m^2] and their count.
struct SquaredSum {
  double sum = 0;
  std::uint64_t n = 0;
  void add(double e_squared) {
    sum += e_squared;
    ++n;
  }
  void add(const SquaredSum& other) {
    sum += other.sum;
    n += other.n;
  }
  double rms() const;  ///< NaN when empty
};

/// What one sweep gives.
struct SweepErrors {
  bool scored = false;
  core::Time t;                               ///< its true end
  std::uint64_t points = 0;                   ///< finite ones in the recording
  std::uint64_t placed = 0;                   ///< of these the ones that estimate and truth cover
  std::array<SquaredSum, kPointFamilies> of;  ///< static points
  std::array<std::vector<SquaredSum>, kPointFamilies> by_phase;
  SquaredSum se3, moving;
  double largest_squared = 0;  ///< of family `point`
  std::optional<double> shear_m, shear_rad;
  MapSample map;
};

struct PointScorer {
  const core::PiecewiseTrajectory& estimate;
  const core::SmoothTrajectory& truth;
  core::SE3 T_body_lidar_nominal, T_body_lidar_true;
  core::SE3 A_first;  ///< T_world_map by the first scored reference pose
  core::SE3 A_se3;    ///< T_world_map by the rigid fit of the reference positions
  int phase_bins = 32;
  /// Of merged sweeps, by sensor: what carries points of the nominal body frame to where the sensor truly saw them, in
  /// place of T_body_lidar_true.
  std::vector<core::SE3> T_body_true = {};

  const core::SE3& true_mounting(std::uint16_t sensor) const {
    return T_body_true.empty() ? T_body_lidar_true : T_body_true.at(sensor);
  }
};

/// Distributions over static points; their sums do not depend on the order in which sweeps come.
struct PointHistograms {
  explicit PointHistograms(int phase_bins);
  void add(const PointHistograms& other);
  SquaredHistogram<10> point;
  std::array<std::vector<SquaredHistogram<6>>, kPointFamilies> by_phase;
};

/// Scores one sweep. `T_map_body_reference` and `reference` are the sweep's reference pose and instant;
/// `map_points` of its points go into the sample. Throws InputError when labels and sweep differ in length.
SweepErrors score_sweep(const PointScorer& scorer, const core::LidarSweep& sweep, const sim::truth::PointLabels& labels,
                        core::Time reference, const core::SE3& T_map_body_reference, std::size_t map_points,
                        PointHistograms& histograms);

/// point_error_*, deskew_error_rms_m, sweep_shear_*, point_coverage_percent.
void add_point_rows(const std::vector<SweepErrors>& sweeps, const PointHistograms& histograms, RowSet& rows);

/// point_error_by_phase, deskew_error_by_phase, reference_error_by_phase: RMS over static points a bin of phase
/// (0 = the sweep's first firing, 1 = its last), with the band from the 5th to the 95th percentile; and
/// deskew_error_vs_time, RMS a sweep over the time of its end.
void add_point_series(const std::vector<SweepErrors>& sweeps, const PointHistograms& histograms, core::Time t_zero,
                      std::vector<Series>& series);

}  // namespace tarmac::metrics
