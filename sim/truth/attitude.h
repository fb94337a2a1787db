/// Yaw, pitch and roll as functions of time, as a rotation with its rates.
#pragma once

#include <Eigen/Core>

#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// R = Rz(yaw) Ry(pitch) Rx(roll), with its body rates. The angles need two derivatives by time.
struct Attitude {
  Eigen::Matrix3d R_world_body;
  Eigen::Vector3d omega_body, alpha_body;

  Attitude(const Jet& yaw, const Jet& pitch_angle, const Jet& roll_angle) {
    const SinCos y = sin_cos(yaw), p = sin_cos(pitch_angle), r = sin_cos(roll_angle);
    const double cy = y.cos.f, sy = y.sin.f, cp = p.cos.f, sp = p.sin.f, cr = r.cos.f, sr = r.sin.f;
    R_world_body << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,              //
        -sp, cp * sr, cp * cr;
    const Jet dy = derivative(yaw), dp = derivative(pitch_angle), dr = derivative(roll_angle);
    const Jet wx = dr - dy * p.sin, wy = dp * r.cos + dy * p.cos * r.sin, wz = dy * p.cos * r.cos - dp * r.sin;
    omega_body = {wx.f, wy.f, wz.f};
    alpha_body = {wx.d1, wy.d1, wz.d1};
  }
};

}  // namespace tarmac::sim::truth
