#include "metrics/registry.h"

namespace tarmac::metrics {

namespace {

constexpr const char* kFirst = "first valid reference pose";
constexpr const char* kNone = "none needed";
constexpr const char* kZhang = "Zhang and Scaramuzza 2018, A Tutorial on Quantitative Trajectory Evaluation";
constexpr const char* kSturm = "Sturm et al. 2012, A Benchmark for the Evaluation of RGB-D SLAM Systems";
constexpr const char* kUmeyama = "Umeyama 1991, Least-Squares Estimation of Transformation Parameters";
constexpr const char* kKitti =
    "Geiger et al. 2012, Are we ready for Autonomous Driving? The KITTI Vision Benchmark Suite";
constexpr const char* kOwn = "metrics/README.md";
constexpr const char* kBarShalom =
    "Bar-Shalom, Li and Kirubarajan 2001, Estimation with Applications to Tracking and Navigation, 5.4";
constexpr const char* kDegeneracy = "metrics/README.md; Zhang, Kaess and Singh 2016; Wilson 1927";

constexpr MetricEntry kMetrics[] = {
    {"coverage_percent", "%", false, kNone,
     "Share of the recording's sweeps that are scored: neither initialising nor lost, and inside the truth's span.",
     kOwn, "coverage"},
    {"point_coverage_percent", "%", false, kNone,
     "Share of the recording's finite points that are scored: their sweep is, and the estimate covers their firing "
     "time.",
     kOwn, "coverage"},

    {"ate_first_pose_rmse_m", "m", true, kFirst,
     "Position error at the sweeps' reference instants after carrying the first estimated pose onto the true one; RMS.",
     kSturm, "trajectory"},
    {"ate_first_pose_median_m", "m", true, kFirst, "Median of the same position errors.", kSturm, "trajectory"},
    {"ate_first_pose_max_m", "m", true, kFirst, "Largest of the same position errors.", kSturm, "trajectory"},
    {"ate_first_pose_rot_rmse_deg", "deg", true, kFirst,
     "Rotation error at the reference instants after carrying the first estimated pose onto the true one; RMS angle.",
     kZhang, "trajectory"},
    {"ate_yaw_pos_rmse_m", "m", true, "yaw and position",
     "RMS position error after the best turn about the vertical and the best shift; a map that is not gravity-aligned "
     "is levelled by its first pose before.",
     kZhang, "trajectory"},
    {"ate_se3_rmse_m", "m", true, "SE(3)", "RMS position error after the best rigid motion of the whole path.",
     kUmeyama, "trajectory"},
    {"ate_se3_median_m", "m", true, "SE(3)", "Median of the same position errors.", kUmeyama, "trajectory"},
    {"ate_se3_max_m", "m", true, "SE(3)", "Largest of the same position errors.", kUmeyama, "trajectory"},
    {"ate_sim3_rmse_m", "m", true, "Sim(3)",
     "RMS position error after the best rigid motion and scale: what is left is shape.", kUmeyama, "trajectory"},
    {"ate_none_rmse_m", "m", true, "none",
     "RMS position error as it stands; n/a for a method that is given no initial pose.", kSturm, "trajectory"},

    {"rpe_1sweep_trans_rmse_m", "m", true, kNone,
     "Error of the motion from one sweep's reference instant to the next, translation part; RMS.", kSturm,
     "trajectory"},
    {"rpe_1sweep_rot_rmse_deg", "deg", true, kNone, "The same, rotation part.", kSturm, "trajectory"},
    {"rpe_10sweep_trans_rmse_m", "m", true, kNone, "Error of the motion over ten sweeps, translation part; RMS.",
     kSturm, "trajectory"},
    {"rpe_10sweep_rot_rmse_deg", "deg", true, kNone, "The same, rotation part.", kSturm, "trajectory"},
    {"rpe_1s_trans_rmse_m", "m", true, kNone,
     "Error of the motion over one second (to the reference instant nearest to it), translation part; RMS.", kSturm,
     "trajectory"},
    {"rpe_1s_rot_rmse_deg", "deg", true, kNone, "The same, rotation part.", kSturm, "trajectory"},
    {"rpe_10m_trans_rmse_m", "m", true, kNone,
     "Error of the motion over ten metres of true path (to the first reference instant not before), translation part; "
     "RMS.",
     kSturm, "trajectory"},
    {"rpe_10m_rot_rmse_deg", "deg", true, kNone, "The same, rotation part.", kSturm, "trajectory"},

    {"end_error_m", "m", true, kFirst, "Position error at the last scored reference instant.", kOwn, "trajectory"},
    {"end_error_percent", "%", true, kFirst,
     "End error over the length of the true path between first and last scored pose.", kOwn, "trajectory"},
    {"path_length_m", "m", false, kNone, "Length of the true path between the first and the last scored pose.", kOwn,
     "trajectory"},

    {"kitti_trans_percent", "%", true, kNone,
     "KITTI's translation error: over segments of 100 to 800 m, error of the motion over the segment's length; mean. "
     "n/a below 200 m of path; the count of segments is beside it.",
     kKitti, "drift"},
    {"kitti_rot_deg_per_100m", "deg/100m", true, kNone, "KITTI's rotation error over the same segments; mean.", kKitti,
     "drift"},
    {"drift_50m_along_rms_m", "m", true, kNone,
     "Error of the motion over 50 m of true path, seen at its end along the true heading; RMS.", kOwn, "drift"},
    {"drift_50m_cross_rms_m", "m", true, kNone, "The same, across the true heading.", kOwn, "drift"},
    {"drift_50m_height_rms_m", "m", true, kNone, "The same, in height.", kOwn, "drift"},
    {"drift_50m_yaw_rms_deg", "deg", true, kNone, "Rotation error over 50 m of true path, about the vertical; RMS.",
     kOwn, "drift"},
    {"drift_50m_tilt_rms_deg", "deg", true, kNone, "The same, roll and pitch together.", kOwn, "drift"},

    {"point_error_rms_m", "m", true, kFirst,
     "How far from its true place the estimate puts each static point, at the point's own firing time; RMS.", kOwn,
     "points"},
    {"point_error_p50_m", "m", true, kFirst, "Median of the same point errors.", kOwn, "points"},
    {"point_error_p95_m", "m", true, kFirst, "95th percentile of the same point errors.", kOwn, "points"},
    {"point_error_max_m", "m", true, kFirst, "Largest of the same point errors.", kOwn, "points"},
    {"point_error_se3_rms_m", "m", true, "SE(3)",
     "The same RMS after the rigid motion that fits the reference positions best.", kOwn, "points"},
    {"point_error_moving_rms_m", "m", true, kFirst, "The same RMS over points on moving objects.", kOwn, "points"},
    {"deskew_error_rms_m", "m", true, "each sweep's own best rigid motion",
     "How far a sweep is bent: distance of its static points from their true places after the sweep's best rigid "
     "motion; RMS over all points. Large when motion during the sweep is not undone.",
     kOwn, "points"},
    {"deskew_error_braking_rms_m", "m", true, "each sweep's own best rigid motion",
     "The same over the sweeps in whose middle the vehicle truly brakes harder than 2.5 m/s2.", kOwn, "points"},
    {"sweep_shear_rms_m", "m", true, kNone,
     "Error of the motion from a sweep's first to its last firing, translation part; RMS over sweeps.", kOwn, "points"},
    {"sweep_shear_rot_rms_deg", "deg", true, kNone, "The same, rotation part.", kOwn, "points"},

    {"oracle_degenerate_percent", "%", false, kNone,
     "Share of sweeps whose exact geometry leaves a direction of the pose free: smallest scaled eigenvalue of the "
     "6-DOF block of exact normals below 1e-3.",
     kDegeneracy, "degeneracy"},
    {"oracle_degenerate_12dof_percent", "%", false, kNone,
     "Share of sweeps whose exact geometry leaves the motion inside the sweep free: smallest eigenvalue of the "
     "difference's Schur complement below 5e-5.",
     kDegeneracy, "degeneracy"},
    {"oracle_lambda_min_6dof_median", "1", false, kNone,
     "Median over sweeps of the smallest scaled eigenvalue of the 6-DOF block of exact normals.", kDegeneracy,
     "degeneracy"},
    {"solve_lambda_min_6dof_median", "1", false, kNone,
     "Median over sweeps of the smallest scaled eigenvalue of the 6-DOF block of the residuals that the method solved "
     "with.",
     kDegeneracy, "degeneracy"},
    {"solve_lambda_min_12dof_difference_median", "1", false, kNone,
     "The same of the motion inside the sweep: the difference's Schur complement in the 12-DOF block.", kDegeneracy,
     "degeneracy"},
    {"solve_condition_6dof_median", "1", true, kNone, "Median over sweeps of the same 6-DOF block's condition number.",
     kDegeneracy, "degeneracy"},
    {"solve_condition_12dof_median", "1", true, kNone,
     "Median over sweeps of the same 12-DOF block's condition number.", kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_precision", "1", false, kNone,
     "Of the sweeps that the smallest 6-DOF eigenvalue by the residuals that the method solved with flags, the share "
     "that the oracle calls degenerate; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_recall", "1", false, kNone,
     "Of the sweeps that the oracle calls degenerate, the share that the same eigenvalue flags; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_f1", "1", false, kNone, "Harmonic mean of the two.", kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_auc", "1", false, kNone,
     "Probability that the same eigenvalue is smaller on a degenerate sweep than on another: what any threshold could "
     "reach; 0.5 knows nothing.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_event_precision", "1", false, kNone,
     "Precision over stretches of at least 5 flagged sweeps.", kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_event_recall", "1", false, kNone, "Recall over stretches of at least 5 degenerate sweeps.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_6dof_lead_time_s", "s", false, kNone,
     "From the first flag to the oracle's onset, median over events: above 0 the method warns first.", kDegeneracy,
     "degeneracy"},
    {"degeneracy_solve_12dof_precision", "1", false, kNone,
     "Of the sweeps that the smallest eigenvalue of the motion inside the sweep by the residuals that the method "
     "solved with flags, the share that the oracle calls degenerate; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_12dof_recall", "1", false, kNone,
     "Of the sweeps that the oracle calls degenerate, the share that the same eigenvalue flags; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_solve_12dof_f1", "1", false, kNone, "Harmonic mean of the two.", kDegeneracy, "degeneracy"},
    {"degeneracy_solve_12dof_auc", "1", false, kNone,
     "Probability that the same eigenvalue is smaller on a degenerate sweep than on another: what any threshold could "
     "reach; 0.5 knows nothing.",
     kDegeneracy, "degeneracy"},
    {"surface_lambda_min_6dof_median", "1", false, kNone,
     "Median over sweeps of the smallest scaled eigenvalue of the 6-DOF block of the method's point-to-surface "
     "residuals.",
     kDegeneracy, "degeneracy"},
    {"surface_lambda_min_12dof_difference_median", "1", false, kNone,
     "The same of the motion inside the sweep: the difference's Schur complement in the 12-DOF block.", kDegeneracy,
     "degeneracy"},
    {"surface_condition_6dof_median", "1", true, kNone,
     "Median over sweeps of the same 6-DOF block's condition number.", kDegeneracy, "degeneracy"},
    {"surface_condition_12dof_median", "1", true, kNone,
     "Median over sweeps of the same 12-DOF block's condition number.", kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_precision", "1", false, kNone,
     "Of the sweeps that the smallest 6-DOF eigenvalue by the method's point-to-surface residuals flags, the share "
     "that the oracle calls degenerate; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_recall", "1", false, kNone,
     "Of the sweeps that the oracle calls degenerate, the share that the same eigenvalue flags; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_f1", "1", false, kNone, "Harmonic mean of the two.", kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_auc", "1", false, kNone,
     "Probability that the same eigenvalue is smaller on a degenerate sweep than on another: what any threshold could "
     "reach; 0.5 knows nothing.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_event_precision", "1", false, kNone,
     "Precision over stretches of at least 5 flagged sweeps.", kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_event_recall", "1", false, kNone,
     "Recall over stretches of at least 5 degenerate sweeps.", kDegeneracy, "degeneracy"},
    {"degeneracy_surface_6dof_lead_time_s", "s", false, kNone,
     "From the first flag to the oracle's onset, median over events: above 0 the method warns first.", kDegeneracy,
     "degeneracy"},
    {"degeneracy_surface_12dof_precision", "1", false, kNone,
     "Of the sweeps that the smallest eigenvalue of the motion inside the sweep by the method's point-to-surface "
     "residuals flags, the share that the oracle calls degenerate; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_surface_12dof_recall", "1", false, kNone,
     "Of the sweeps that the oracle calls degenerate, the share that the same eigenvalue flags; 95 % Wilson interval.",
     kDegeneracy, "degeneracy"},
    {"degeneracy_surface_12dof_f1", "1", false, kNone, "Harmonic mean of the two.", kDegeneracy, "degeneracy"},
    {"degeneracy_surface_12dof_auc", "1", false, kNone,
     "Probability that the same eigenvalue is smaller on a degenerate sweep than on another: what any threshold could "
     "reach; 0.5 knows nothing.",
     kDegeneracy, "degeneracy"},
    {"anees_per_dof", "1", true, kFirst,
     "Squared pose error in terms of the covariance that the method states, per degree of freedom; mean over sweeps. "
     "1: "
     "the covariance tells the truth; above: over-confident. No bound is set: no covariance knows how the method's own "
     "map has drifted.",
     kBarShalom, "consistency"},
    {"anees_root_per_dof", "1", true, kFirst,
     "Root of the same: by what factor the stated standard deviations are too small.", kBarShalom, "consistency"},
    {"nees_covered_percent", "%", false, kFirst,
     "Share of sweeps whose true pose lies in the 95 % ellipsoid of the stated covariance.", kBarShalom, "consistency"},
    {"time_lag_ms", "ms", true, kNone,
     "Lag in time at which the motions from sweep to sweep fit the truth best; positive: the estimate is late. 95 % "
     "bootstrap interval.",
     kOwn, "timing"},
    {"ate_per_lag_m_per_s", "m/s", true, kNone,
     "How much the SE(3)-aligned ATE grows per second of further lag: negative where the estimate runs ahead.", kOwn,
     "timing"},
    {"ate_first_pose_lag_corrected_rmse_m", "m", true, kFirst,
     "ATE with the truth taken earlier by the best lag; beside the headline where a fault was injected.", kOwn,
     "timing"},
    {"ate_se3_lag_corrected_rmse_m", "m", true, "SE(3)", "The same after the best rigid motion.", kOwn, "timing"},
    {"residual_spread_m", "m", true, kNone,
     "Spread of point-to-surface residuals about the smooth motion that fits each sweep's; median over sweeps.", kOwn,
     "residuals"},
    {"residual_lag_rotation_ms", "ms", true, kNone,
     "How late the turning inside sweeps is against the points: the residuals' slope over the sweep, regressed on the "
     "change of the rate of turn. The LiDAR-IMU offset of a method that places points by an IMU. 95 % bootstrap "
     "interval.",
     kOwn, "residuals"},
    {"residual_lag_translation_ms", "ms", true, kNone, "The same for velocity.", kOwn, "residuals"},
    {"residual_scale_rotation_percent", "%", true, kNone,
     "By how much the turning inside sweeps is overdone: the same slope, regressed on the rate of turn itself.", kOwn,
     "residuals"},
    {"residual_scale_translation_percent", "%", true, kNone, "The same for velocity.", kOwn, "residuals"},
    {"residual_omitted_acceleration_percent", "%", true, kNone,
     "Share of the acceleration inside sweeps that the method leaves out, by the residuals' bend.", kOwn, "residuals"},
    {"stamp_quantum_ms", "ms", true, kNone,
     "Time for which a point's stamp stands still, by the saw-tooth of residuals within it.", kOwn, "residuals"},

    {"iterations_mean", "1", true, kNone, "Mean number of the method's iterations a sweep.", kOwn, "effort"},
    {"sweep_time_p50_ms", "ms", true, kNone, "Median wall time the method took for a sweep.", kOwn, "cost"},
    {"sweep_time_p95_ms", "ms", true, kNone, "95th percentile of the wall time for a sweep.", kOwn, "cost"},
    {"sweep_time_p99_ms", "ms", true, kNone, "99th percentile of the wall time for a sweep.", kOwn, "cost"},
    {"sweep_cpu_p50_ms", "ms", true, kNone, "Median processor time, all threads, for a sweep.", kOwn, "cost"},
    {"real_time_factor", "1", false, kNone, "Recorded seconds per second of the run: above 1 the method keeps up.",
     kOwn, "cost"},
    {"peak_memory_mb", "MB", true, kNone, "Largest memory of the method's process.", kOwn, "cost"},
};

}  // namespace

std::span<const MetricEntry> metrics() {
  return kMetrics;
}

const MetricEntry* find_metric(const std::string& name) {
  for (const MetricEntry& entry : kMetrics)
    if (name == entry.name) return &entry;
  return nullptr;
}

}  // namespace tarmac::metrics
