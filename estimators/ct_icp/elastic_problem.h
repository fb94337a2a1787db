/// One sweep's least-squares problem with its associations fixed, and the two ways of solving it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/trajectory.h"
#include "estimators/blocks/assembler.h"
#include "estimators/blocks/plane_association.h"
#include "estimators/blocks/robust_loss.h"

namespace tarmac::estimators {

struct Keypoint {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< as measured [m]
  double alpha = 1;                                  ///< place in time between the sweep's begin (0) and end (1)
  std::uint32_t point = 0;                           ///< index into the sweep
};

/// Regularisers, all by the poses of the sweep before. Each enters the cost as N beta |.|^2 / 2, N being the number of
/// data residuals, so that a beta is relative to the mean of theirs:
///   location            t_b - t_e'                       (' is the sweep before)
///   constant velocity   (t_e - t_b) - (t_e' - t_b')
///   small velocity      t_b - t_e
///   orientation         1 - (q_b . q_e')^2, scalar
/// Source: Dellenbach et al., ICRA 2022, eq. 5-6; upstream's motion model.
struct Regularisers {
  double beta_location = 0, beta_constant_velocity = 0, beta_small_velocity = 0, beta_orientation = 0;
  core::SE3 T_previous_begin = core::SE3::Identity(), T_previous_end = core::SE3::Identity();
  /// As upstream master's Gauss-Newton has them: location as t_b - t_e of this sweep, acting on the begin alone;
  /// constant velocity acting on the end alone.
  bool quirk = false;
};

struct ElasticProblem {
  std::span<const Keypoint> keypoints;
  std::span<const Association> associations;  ///< one a keypoint
  RobustLoss loss;
  const Regularisers* regularisers = nullptr;  ///< none: no prior; they hold for two-pose motions only
};

/// Data rows: J = J(by the pose at alpha) x J(of that pose by begin and end), weight w^2 drho/ds at s = (w r)^2.
/// `equations` is set to zero first and must have as many blocks as the motion.
void assemble(const ElasticProblem& problem, const core::Segment& motion, NormalEquations& equations);

/// One Gauss-Newton step; poses <- poses Exp(x). False when the equations are singular: the motion is unchanged.
bool gauss_newton_step(const ElasticProblem& problem, core::Segment& motion);

/// At most `max_iterations` Levenberg-Marquardt steps of Ceres from `motion`: one thread, no time limit. False when
/// Ceres finds no usable solution: the motion is unchanged. Throws std::invalid_argument for regularisers with quirk,
/// which are no gradient of any cost.
bool solve_with_ceres(const ElasticProblem& problem, int max_iterations, core::Segment& motion);

/// Half the sum of the robust data costs and the regularisers.
double cost(const ElasticProblem& problem, const core::Segment& motion);

/// The regularisers' scalar terms at a two-pose motion: value, weight and Jacobian by begin and end.
struct PriorRow {
  double value = 0, weight = 0;
  core::Row6 by_begin = core::Row6::Zero(), by_end = core::Row6::Zero();
};
std::vector<PriorRow> prior_rows(const Regularisers& regularisers, int residuals, const core::Segment& motion);

}  // namespace tarmac::estimators
