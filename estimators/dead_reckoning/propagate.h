/// Strapdown integration of an IMU.
#pragma once

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::estimators {

/// Motion of the IMU's frame: p_map = R_map_imu p_imu + p.
struct InertialState {
  core::Time t;
  Eigen::Matrix3d R_map_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_map_m = Eigen::Vector3d::Zero();

  core::SE3 T_map_imu() const;
};

/// The state at `to`, with rate and specific force constant in the IMU's frame between:
///   R' = R Exp(phi), v' = v + (R G1(phi) f + g) dt, p' = p + v dt + (R G2(phi) f + g / 2) dt^2
/// phi = omega dt, G1 = sum phi^n / (n+1)!, G2 = sum phi^n / (n+2)!, g = (0, 0, -|g|). Exact for such a motion; for
/// samples that are means over the interval the error is of second order in dt. `to` may lie before state.t.
/// Source: Bloesch et al., The Two-State Implicit Filter (RA-L 2018), eq. for Gamma_m; derivation in README.md.
InertialState propagate(const InertialState& state, const Eigen::Vector3d& omega_rad_s, const Eigen::Vector3d& f_m_s2,
                        double gravity_m_s2, core::Time to);

/// G2(phi) above.
Eigen::Matrix3d second_integral(const Eigen::Vector3d& phi);

}  // namespace tarmac::estimators
