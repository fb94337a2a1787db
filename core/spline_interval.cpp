#include "core/spline_interval.h"

#include <fmt/format.h>

#include <type_traits>

#include "core/error.h"
#include "core/spline_groups.h"

namespace tarmac::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSteps = kMaxSplineOrder - 1;

template <int k>
inline void set_lambda(const SplineInterval& interval, double u, double* lambda) {
  for (int j = 0; j < k - 1; ++j) lambda[j] = interval.lambda[k - 1][j];
  for (int m = k - 2; m >= 0; --m) {
    for (int j = 0; j < k - 1; ++j) lambda[j] = lambda[j] * u + interval.lambda[m][j];
  }
}

template <int k, SplineKind kind>
inline void pose_of(const SplineView& view, double u, SE3& T) {
  const SplineInterval& interval = *view.interval;
  double lambda[kSteps];
  set_lambda<k>(interval, u, lambda);
  Eigen::Quaterniond q = interval.q_first;
  Vector3d p;
  if constexpr (kind == SplineKind::se3) {
    p = interval.p_first;
  } else {
    p = interval.position[k - 1];
    for (int m = k - 2; m >= 0; --m) p = p * u + interval.position[m];
  }
  Eigen::Array<double, k / 2 * 2, 1> half_rad, sine, cosine;  // an even number of at least k - 1
  half_rad[k / 2 * 2 - 1] = 0;
  for (int j = 0; j < k - 1; ++j) half_rad[j] = 0.5 * lambda[j] * view.steps[j].angle_rad;
  sine_cosine(half_rad, sine, cosine);
  for (int j = 0; j < k - 1; ++j) {
    const SplineFactor factor = factor_of<kind == SplineKind::se3>(view.steps[j], lambda[j], sine[j], cosine[j]);
    if constexpr (kind == SplineKind::se3) p += q._transformVector(factor.t_m);
    q = q * quaternion_of(factor);
  }
  T.linear() = q.toRotationMatrix();
  T.translation() = p;
  T.makeAffine();
}

/// Calls f with the order and the kind as constants.
template <class F>
void with_order_and_kind(const SplineView& view, const F& f) {
  const auto with_kind = [&](auto order) {
    if (view.kind == SplineKind::split) {
      f(order, std::integral_constant<SplineKind, SplineKind::split>{});
    } else {
      f(order, std::integral_constant<SplineKind, SplineKind::se3>{});
    }
  };
  if (view.order == 4) {
    with_kind(std::integral_constant<int, 4>{});
  } else if (view.order == 5) {
    with_kind(std::integral_constant<int, 5>{});
  } else {
    with_kind(std::integral_constant<int, 6>{});
  }
}

}  // namespace

SplineStep spline_step(SplineKind kind, const SE3& T_from, const SE3& T_to) {
  SplineStep step;
  const Matrix3d R = T_from.linear().transpose() * T_to.linear();
  const Vector3d phi = so3::log(R);
  const double angle_rad = phi.norm();
  const bool turns = angle_rad >= kNoAngle_rad;
  if (turns) {
    step.axis = phi / angle_rad;
    step.angle_rad = angle_rad;
  }
  if (kind == SplineKind::split) return step;
  const Vector3d rho =
      so3::left_jacobian_inverse(phi) * (T_from.linear().transpose() * (T_to.translation() - T_from.translation()));
  step.along_m = turns ? Vector3d(step.axis * step.axis.dot(rho)) : rho;
  if (turns) {
    step.across_m = (rho - step.along_m) / angle_rad;
    step.turned_m = step.axis.cross(rho) / angle_rad;
  }
  return step;
}

SplineStepJacobians spline_step_jacobians(SplineKind kind, const SE3& T_from, const SE3& T_to) {
  SplineStepJacobians out;
  const Matrix3d R = T_from.linear().transpose() * T_to.linear();
  out.phi = so3::log(R);
  out.left_inverse_real = so3::left_jacobian_inverse(out.phi);
  out.right_inverse_real = out.left_inverse_real.transpose();
  if (kind == SplineKind::split) {
    out.rho.setZero();
    out.left_inverse_dual.setZero();
    out.right_inverse_dual.setZero();
    return out;
  }
  out.rho = out.left_inverse_real * (T_from.linear().transpose() * (T_to.translation() - T_from.translation()));
  Vector6 xi;
  xi << out.rho, out.phi;
  out.left_inverse_dual = se3::left_jacobian_inverse(xi).topRightCorner<3, 3>();
  out.right_inverse_dual = se3::right_jacobian_inverse(xi).topRightCorner<3, 3>();
  return out;
}

SplineInterval spline_interval(SplineKind kind, int order, std::span<const Time> knots, std::span<const SE3> control) {
  SplineInterval interval;
  const BlendingMatrix C = cumulative(blending_matrix(order, knots));
  interval.begin = knots[static_cast<std::size_t>(order - 2)];
  interval.end = knots[static_cast<std::size_t>(order - 1)];
  interval.per_ns = 1.0 / static_cast<double>((interval.end - interval.begin).count());
  interval.per_s = 1e9 * interval.per_ns;
  interval.q_first = Eigen::Quaterniond(control[0].linear());
  interval.p_first = control[0].translation();
  const auto k = static_cast<std::size_t>(order);
  for (std::size_t m = 0; m < k; ++m) {
    interval.position[m] = m == 0 ? interval.p_first : Vector3d::Zero();
    for (std::size_t j = 1; j < k; ++j) {
      const double c = C(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(j));
      interval.lambda[m][j - 1] = c;
      if (kind == SplineKind::split) {
        interval.position[m] += c * (control[j].translation() - control[j - 1].translation());
      }
    }
  }
  return interval;
}

SE3 spline_pose(const SplineView& view, double u) {
  SE3 T;
  with_order_and_kind(view, [&](auto order, auto kind) { pose_of<order(), kind()>(view, u, T); });
  return T;
}

void spline_poses(SplineView view, const SplineInterval* last, std::span<const Time> ascending, std::span<SE3> out) {
  with_order_and_kind(view, [&](auto order, auto kind) {
    for (std::size_t i = 0, next = 0; i < ascending.size(); i = next) {
      const Time t = ascending[i];
      if (i > 0 && t < ascending[i - 1]) {
        throw InputError(fmt::format("time {} of a batch lies before the one before it", i));
      }
      while (t >= view.interval->end && view.interval != last) {
        ++view.interval;
        ++view.steps;
      }
      pose_of<order(), kind()>(view, view.interval->u(t), out[i]);
      for (next = i + 1; next < ascending.size() && ascending[next] == t; ++next) out[next] = out[i];
    }
  });
}

}  // namespace tarmac::core
