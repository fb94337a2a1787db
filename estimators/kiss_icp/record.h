/// What KISS-ICP leaves behind of one sweep, in the terms that all methods share.
#pragma once

#include "core/diagnostics.h"
#include "core/measurements.h"
#include "core/trajectory.h"
#include "estimators/estimator.h"
#include "estimators/kiss_icp/odometry.h"

namespace tarmac::estimators {

/// T_map_body(t) over [begin, end] of the sweep. Modelled: T_k Exp((s(t) - 1) Log D) T_lidar_body, one screw, since s
/// is linear in t. Measured: the path, carried to where the registration put its end. Where nothing moves the pose is
/// held. Where the points cover so little of the sweep that reaching its begin and end would stretch the twist more
/// than twofold, only the time between the first and the last point is covered.
std::vector<core::Segment> placed_by(const core::LidarSweep& sweep, const SweepMotion& motion,
                                     const core::SE3& T_map_lidar, const core::SE3& T_lidar_body);

/// The record of the last iteration, at the pose at which it was linearised. With p the point in the body's frame and
/// a perturbation T_map_body <- T_map_body Exp(xi):  dr/dxi = R [ I  -[p]x ].
///   H_data: p deskewed, T_map_body at the reference instant (R cancels)
///   rows: p as measured, T_map_body at the point's own time; three rows a point, along the map's axes
///   surface: n^T (T p - c), n and c the normal (towards the sensor) and the centre of the plane through the map's
///   points around the partner; only where they lie on a plane. Weight: 1 where the registration's kernel is flat,
///   falling with the distance as the kernel does. dr/dxi = [ n^T  (p x n)^T ], n in the body's axes.
core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const KissOdometry& odometry,
                                 const KissOdometry::Step& step, const core::SE3& T_lidar_body,
                                 core::DiagnosticsLevel level);

/// Everything that is said of a sweep, from what the odometry did with it.
SweepOutcome outcome_of(const core::LidarSweep& sweep, const KissOdometry& odometry, KissOdometry::Step step,
                        const core::SE3& T_lidar_body, core::DiagnosticsLevel level);

}  // namespace tarmac::estimators
