/// What an odometry on a window leaves behind of one sweep, in the terms that all methods share.
#pragma once

#include "core/diagnostics.h"
#include "core/measurements.h"
#include "estimators/window_odometry/odometry.h"

namespace tarmac::estimators {

/// The matches of the last association, with residuals, robust weights and Jacobians at the motion that came out.
///   rows: r = n^T (p_map - q) [m]; the match's weight squared x robust loss; J by the pose at the point's time. Of
///         distributions: along their direction of least spread, as `surface`, no part of H_data
///   H_data: all matches' information by the pose at the sweep's end, the motion moving as a rigid whole, x sigma_m^2
///   H_prior: what the window says of the pose at the sweep's end without this sweep's points, x sigma_m^2; zero where
///            it leaves a direction free
///   covariance: the window's, of the pose at the sweep's end, with this sweep's points and all that the state depends on
core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const WindowOdometry& odometry,
                                 const WindowOdometry::Step& step, core::DiagnosticsLevel level);

}  // namespace tarmac::estimators
