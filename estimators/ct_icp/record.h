/// What CT-ICP leaves behind of one sweep, in the terms that all methods share.
#pragma once

#include "core/diagnostics.h"
#include "core/measurements.h"
#include "estimators/ct_icp/odometry.h"

namespace tarmac::estimators {

/// The associations of the last iteration, with residuals, robust weights and Jacobians at the motion that came out.
///   rows: r = n^T (p_map - q), weight w^2 drho/ds, J by the pose at the point's own time
///   H_data: the same rows by the pose at the reference instant (the end), the motion moving as a rigid whole:
///           T_end <- T_end Exp(xi) makes T(t) <- T(t) Exp(Ad(T(t)^-1 T_end) xi)
///   H_prior: the regularisers by the same
core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const CtOdometry& odometry,
                                 const CtOdometry::Step& step, core::DiagnosticsLevel level);

}  // namespace tarmac::estimators
