/// Degeneracy of a run: the eigenvalues of what the method recorded, beside the oracle's, and how well the one tells of
/// the other.
///
/// Sources of a block: `oracle` (exact normals, oracle.h), `solve` (the residuals that the method solved with) and
/// `surface` (its point-to-surface residuals; the same for a point-to-plane method). A point-to-point method's solve
/// block is never singular: every row along an axis holds that axis, whatever the surface is.
///
/// Series over the time of the sweep's end; P = "oracle_" for the oracle, "" for solve, "surface_" for surface where
/// the method solves with others:
///   Plambda_min_6dof_vs_time, Plambda_min_12dof_difference_vs_time    smallest eigenvalues, scaled (information.h)
///   Plambda_min_12dof_vs_time, Pcondition_6dof_vs_time, Pcondition_12dof_vs_time            (not of surface)
///   Pdegeneracy_class_vs_time, Pdegeneracy_class_12dof_vs_time        0 ok, 1 weak, 2 degenerate, NaN unknown
///   weak_D_vs_time, oracle_weak_D_vs_time   share of direction D in the weak subspace of the 6-DOF block, D =
///                                           along_track, cross_track, height, roll, pitch, yaw of the body; the
///                                           method's by its surface residuals where it has them
///   prior_share_vs_time                     share of priors in the information along the weakest direction of solve
///   path_degenerate                         [m] true path where the oracle says degenerate (NaN: a gap)
#pragma once

#include <string>
#include <vector>

#include "core/estimate.h"
#include "metrics/degeneracy/method_blocks.h"
#include "metrics/degeneracy/oracle.h"
#include "metrics/evaluation.h"
#include "metrics/row_set.h"
#include "metrics/sweep_source.h"

namespace tarmac::metrics {

struct DegeneracySettings {
  int threads = 1;
  /// What the thresholds on methods' blocks assume of their normals' noise. The oracle has none.
  double normal_noise_deg = 2;
};

struct DegeneracyInput {
  const core::Estimate& estimate;
  const DiagnosticsSource* diagnostics = nullptr;  ///< nullptr: the method's side is n/a
  const SweepSource& sweeps;
  const Oracle* oracle = nullptr;  ///< nullptr: a recording without truth; what needs it is n/a
  core::Time t_zero;
};

/// A source's verdict on one sweep.
struct SweepVerdict {
  std::int64_t index = 0;
  double t_s = 0;
  std::size_t rows = 0;
  std::optional<BlockAnalysis> blocks;
  DegeneracyClass pose = DegeneracyClass::unknown, difference = DegeneracyClass::unknown;
};

struct DegeneracyReport {
  std::vector<SweepVerdict> oracle, solve, surface;
  double method_threshold = kOracleDegenerateBelow;  ///< of the methods' 6-DOF class
  bool solves_with_surface = false;                  ///< `surface` is `solve`
  std::vector<std::optional<double>> prior_share;    ///< one a sweep of `solve`
};

DegeneracyReport degeneracy_report(const DegeneracyInput& input, const DegeneracySettings& settings);

/// The registry's rows of family `degeneracy`; the series above, findings_of() and to_csv() into `evaluation`.
void add_degeneracy(const DegeneracyInput& input, const DegeneracySettings& settings, RowSet& rows,
                    Evaluation& evaluation);

/// Degenerate stretches of at least 5 sweeps in words, the 10 longest: by the oracle, or, without truth, by the
/// method's surface residuals. Topic "degeneracy".
std::vector<Finding> findings_of(const DegeneracyReport& report);

/// A line a sweep and source: classes, condition numbers, all eigenvalues in ascending order (6-DOF, 12-DOF, Schur
/// complements of mean and difference), and the shares of the weak subspace.
std::string to_csv(const DegeneracyReport& report);

}  // namespace tarmac::metrics
