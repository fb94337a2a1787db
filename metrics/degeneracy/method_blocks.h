/// The blocks of what a method recorded: its data residuals alone, priors and regularisers apart.
///
/// A row's Jacobian is by the pose at the point's own time, seen from the body there; the method's own trajectory T^
/// carries it into frame c (information.h): J_c = J Ad(T^(t)^-1 T_c), T_c = T^(middle) with the LiDAR's position as
/// origin. Weights are those of the solve.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "metrics/degeneracy/information.h"

namespace tarmac::metrics {

/// `sweep` tells when the sweep begins and ends; rows at times that the trajectory does not cover are left out.
SweepInformation information_of(std::span<const core::ResidualRow> rows, const core::PiecewiseTrajectory& trajectory,
                                const core::SweepResult& sweep, const core::SE3& T_map_c);

struct MethodSweep {
  std::int64_t index = 0;
  core::Time end;  ///< by the recording's clock
  std::size_t solve_rows = 0, surface_rows = 0;
  std::optional<BlockAnalysis> solve;    ///< of the residuals that the method solved with
  std::optional<BlockAnalysis> surface;  ///< of its point-to-surface residuals, which may be the same
  /// Of the information along the weakest direction of `solve`, the share that comes from priors; empty without any.
  std::optional<double> prior_share;
};

/// Level `system` gives the 6-DOF block alone, from H_data. `p_body_lidar_m`: where the LiDAR sits.
MethodSweep method_sweep(const core::SweepDiagnostics& record, const core::PiecewiseTrajectory& trajectory,
                         const core::SweepResult& sweep, const Eigen::Vector3d& p_body_lidar_m, double mean_range_m);

}  // namespace tarmac::metrics
