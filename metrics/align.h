/// Fitting an estimate's map frame to the world, from corresponding positions.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/lie.h"

namespace tarmac::metrics {

enum class Alignment : std::uint8_t { none, first_pose, yaw_pos, se3, sim3 };
/// "none", "first_pose", "yaw_pos", "se3", "sim3": the middle of the metrics' names (`ate_se3_rmse_m`).
const char* name_of(Alignment alignment);
/// Takes `-` for `_`; throws InputError that lists the names.
Alignment alignment(const std::string& name);

/// p_world = scale R p_map + t.
struct Similarity {
  double scale = 1;
  core::SE3 T_world_map = core::SE3::Identity();
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_map) const {
    return T_world_map.linear() * (scale * p_map) + T_world_map.translation();
  }
};

/// A fit; where positions leave some of it free, it is still a minimum, and `note` says what is free.
struct Fit {
  Similarity A;
  std::string note;
};

/// argmax over rotations R of trace(R^T H), where H = sum of q p^T over `count` centred pairs [m^2]: the rotation that
/// carries points p onto q best. What H leaves free (all points equal, or on one line) is taken from `R_preferred`: of
/// all maxima the one nearest to it. `note` (may be nullptr) then says so.
/// Source: Umeyama 1991, eq. 34-43; Kabsch 1976.
Eigen::Matrix3d fit_rotation(const Eigen::Matrix3d& H, double count, const Eigen::Matrix3d& R_preferred,
                             std::string* note);

/// argmin over rigid motions of sum ||q_i - (R p_i + t)||^2. Shapes: 3 x N both, N >= 1.
Fit align_se3(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m, const Eigen::Matrix3d& R_preferred);

/// The same with a scale. Empty when the positions p are all equal: no scale is defined then.
std::optional<Fit> align_sim3(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m,
                              const Eigen::Matrix3d& R_preferred);

/// argmin over rotations about z and translations, after turning p by `R_level`, which makes map's z axis point up.
/// Source: Zhang and Scaramuzza 2018, A Tutorial on Quantitative Trajectory Evaluation, eq. 20.
Fit align_yaw_position(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m,
                       const Eigen::Matrix3d& R_level);

}  // namespace tarmac::metrics
