/// Pavement relief: a height field over a macro surface, met after tracing.
#pragma once

#include <Eigen/Core>

#include "scenes/scene.h"

namespace tarmac::sim::raycast {

struct ReliefHit {
  double t_m = 0;            ///< where the ray meets the relief
  double cos_incidence = 0;  ///< with the relief's own normal
};

/// The ray o + t d (world axes, |d| = 1) meets the macro plane at t_macro_m in p; `normal` is the plane's unit normal,
/// turned towards the sensor. With h the height over the plane along that normal, what is sought is a root of
///   f(t) = (t - t_macro) n'd - h(x(t), y(t))          f'(t) = n'd - grad h' (dx, dy)
/// One Newton step from t_macro settles smooth texture seen from above. Where the step leaves more than 50 micrometres
/// of height it is repeated, inside a bracket, so that the result always lies on the relief.
///
/// At grazing incidence a ray may cross the relief several times; the crossing found is near t_macro and need not be
/// the first, for crests do not shade the troughs behind them. Below |n'd| = 0.01 (0.6 degrees) that question has no
/// useful answer within a millimetre of height, and the macro surface is kept.
ReliefHit meet_relief(const scenes::Relief& relief, const Eigen::Vector3d& p_macro_world,
                      const Eigen::Vector3d& direction, const Eigen::Vector3d& normal, double t_macro_m);

}  // namespace tarmac::sim::raycast
