#include "core/spline_interval.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "core/error.h"

namespace tarmac::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSteps = kMaxSplineOrder - 1;
/// Below it, dividing by the angle could overflow; what is neglected is far below the smallest digit of any pose.
constexpr double kNoAngle_rad = 1e-100;

// ---- Dual numbers of matrices
// ---------------------------------------------------------------------------------------- The adjoint of SE(3) and all
// functions of it are 6x6 matrices [X Y; 0 X]: X + eps Y with eps^2 = 0, and a tangent (rho, phi) is phi + eps rho. So
// the formulas of SO(3) hold for SE(3) as they stand, over dual numbers.

struct DualVector {
  Vector3d real, dual;
};
struct DualMatrix {
  Matrix3d real, dual;
};
DualVector operator+(const DualVector& a, const DualVector& b) {
  return {a.real + b.real, a.dual + b.dual};
}
DualVector operator-(const DualVector& a, const DualVector& b) {
  return {a.real - b.real, a.dual - b.dual};
}
DualVector operator*(double s, const DualVector& a) {
  return {s * a.real, s * a.dual};
}
DualVector operator*(const DualMatrix& a, const DualVector& b) {
  return {a.real * b.real, a.real * b.dual + a.dual * b.real};
}
DualMatrix operator+(const DualMatrix& a, const DualMatrix& b) {
  return {a.real + b.real, a.dual + b.dual};
}
DualMatrix operator-(const DualMatrix& a, const DualMatrix& b) {
  return {a.real - b.real, a.dual - b.dual};
}
DualMatrix operator*(double s, const DualMatrix& a) {
  return {s * a.real, s * a.dual};
}
DualMatrix operator*(const DualMatrix& a, const DualMatrix& b) {
  return {a.real * b.real, a.real * b.dual + a.dual * b.real};
}

/// A_j = Exp(lambda d): its rotation, and (se3) its translation.
struct Factor {
  double w;
  Vector3d xyz;
  Vector3d t_m;
};

template <bool kTranslates>
inline void set_factor(const SplineStep& step, double lambda, Factor& factor) {
  const double half = 0.5 * lambda * step.angle_rad;
  const double s = std::sin(half), c = std::cos(half);
  factor.w = c;
  factor.xyz = s * step.axis;
  if constexpr (kTranslates) {
    // The integral of Exp(s d) rho over s: sin and 1 - cos of the whole angle.
    factor.t_m = lambda * step.along_m + (2 * s * c) * step.across_m + (2 * s * s) * step.turned_m;
  }
}

inline Eigen::Quaterniond quaternion_of(const Factor& f) {
  return {f.w, f.xyz.x(), f.xyz.y(), f.xyz.z()};
}

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
  for (int j = 0; j < k - 1; ++j) {
    Factor factor;
    set_factor<kind == SplineKind::se3>(view.steps[j], lambda[j], factor);
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

/// lambda_j and its first three derivatives by time.
struct Lambdas {
  double value[kSteps], first[kSteps], second[kSteps], third[kSteps];
};

Lambdas lambdas(const SplineInterval& interval, int order, double u) {
  Lambdas out;
  const double s1 = interval.per_s, s2 = 2 * s1 * s1, s3 = 6 * s1 * s1 * s1;
  for (int j = 0; j < order - 1; ++j) {
    double a = 0, b = 0, c = 0, d = 0;  // Horner, of the Taylor coefficients too
    for (int m = order - 1; m >= 0; --m) {
      d = d * u + c;
      c = c * u + b;
      b = b * u + a;
      a = a * u + interval.lambda[static_cast<std::size_t>(m)][static_cast<std::size_t>(j)];
    }
    out.value[j] = a;
    out.first[j] = b * s1;
    out.second[j] = c * s2;
    out.third[j] = d * s3;
  }
  return out;
}

/// Position and its first three derivatives by time (split).
std::array<Vector3d, 4> position_of(const SplineInterval& interval, int order, double u) {
  Vector3d a = Vector3d::Zero(), b = a, c = a, d = a;
  for (int m = order - 1; m >= 0; --m) {
    d = d * u + c;
    c = c * u + b;
    b = b * u + a;
    a = a * u + interval.position[static_cast<std::size_t>(m)];
  }
  const double s = interval.per_s;
  return {a, b * s, c * (2 * s * s), d * (6 * s * s * s)};
}

// ---- The two groups, alike
// -------------------------------------------------------------------------------------------

struct So3 {
  using Vector = Vector3d;
  using Matrix = Matrix3d;
  static Vector zero() { return Vector::Zero(); }
  static Matrix scaled_identity(double s) { return s * Matrix3d::Identity(); }
  static Matrix hat(const Vector& v) { return so3::hat(v); }
  static Vector d(const SplineStepJacobians& step) { return step.phi; }
  static Matrix right_inverse(const SplineStepJacobians& step) { return step.right_inverse_real; }
  static Matrix left_inverse(const SplineStepJacobians& step) { return step.left_inverse_real; }
  /// Ad(Exp(lambda d))^-1
  static Matrix adjoint_inverse(const SplineStep& step, double lambda) {
    Factor factor;
    set_factor<false>(step, lambda, factor);
    return quaternion_of(factor).toRotationMatrix().transpose();
  }
  /// lambda Jr(lambda d)
  static Matrix scaled_jacobian(const SplineStep& step, const SplineStepJacobians&, double lambda) {
    if (step.angle_rad < kNoAngle_rad) return lambda * Matrix3d::Identity();
    const double half = 0.5 * lambda * step.angle_rad, s = std::sin(half), c = std::cos(half);
    const double sine = 2 * s * c / step.angle_rad, rest = 2 * s * s / step.angle_rad;
    return sine * Matrix3d::Identity() + (lambda - sine) * step.axis * step.axis.transpose() -
           rest * so3::hat(step.axis);
  }
};

/// B = (1 - cos x)/x^2, C = (x - sin x)/x^3 and their derivatives over x; series below x = 0.2, where the closed forms
/// lose digits.
struct JacobianCoefficients {
  double B, C, B1, C1;
};
JacobianCoefficients jacobian_coefficients(double x) {
  const double y = x * x;
  if (x < 0.2) {
    return {1. / 2 - y * (1. / 24 - y * (1. / 720 - y * (1. / 40320 - y * (1. / 3628800 - y / 479001600)))),
            1. / 6 - y * (1. / 120 - y * (1. / 5040 - y * (1. / 362880 - y * (1. / 39916800 - y / 6227020800.)))),
            -2. / 24 + y * (4. / 720 - y * (6. / 40320 - y * (8. / 3628800 - y * (10. / 479001600)))),
            -2. / 120 + y * (4. / 5040 - y * (6. / 362880 - y * (8. / 39916800 - y * (10. / 6227020800.))))};
  }
  const double s = std::sin(x), half_s = std::sin(0.5 * x);
  const double A = s / x, B = 2 * half_s * half_s / y, C = (x - s) / (y * x);
  return {B, C, (A - 2 * B) / y, (B - 3 * C) / y};
}

struct Se3 {
  using Vector = DualVector;
  using Matrix = DualMatrix;
  static Vector zero() { return {Vector3d::Zero(), Vector3d::Zero()}; }
  static Matrix scaled_identity(double s) { return {s * Matrix3d::Identity(), Matrix3d::Zero()}; }
  static Matrix hat(const Vector& v) { return {so3::hat(v.real), so3::hat(v.dual)}; }
  static Vector d(const SplineStepJacobians& step) { return {step.phi, step.rho}; }
  static Matrix right_inverse(const SplineStepJacobians& s) { return {s.right_inverse_real, s.right_inverse_dual}; }
  static Matrix left_inverse(const SplineStepJacobians& s) { return {s.left_inverse_real, s.left_inverse_dual}; }
  static Matrix adjoint_inverse(const SplineStep& step, double lambda) {
    Factor factor;
    set_factor<true>(step, lambda, factor);
    const Matrix3d R_inverse = quaternion_of(factor).toRotationMatrix().transpose();
    return {R_inverse, -R_inverse * so3::hat(factor.t_m)};
  }
  /// lambda Jr(lambda phi) = lambda I - lambda^2 B phi^ + lambda^3 C phi^ phi^ with B, C at x = lambda |phi|, and its
  /// derivative along rho.
  static Matrix scaled_jacobian(const SplineStep& step, const SplineStepJacobians& jacobians, double lambda) {
    const JacobianCoefficients c = jacobian_coefficients(lambda * step.angle_rad);
    const Matrix3d P = so3::hat(jacobians.phi), R = so3::hat(jacobians.rho), PP = P * P, PR = P * R;
    const double l2 = lambda * lambda, l3 = l2 * lambda, turn = l2 * jacobians.phi.dot(jacobians.rho);
    // R P is the transpose of P R: both are products of two skew matrices.
    return {lambda * Matrix3d::Identity() - l2 * c.B * P + l3 * c.C * PP,
            -l2 * (c.B * R + turn * c.B1 * P) + l3 * (c.C * (PR + PR.transpose()) + turn * c.C1 * PP)};
  }
};

/// Velocity, acceleration and jerk in the body's frame after every step, and what carries them from one to the next.
template <class Group>
struct Forward {
  typename Group::Matrix carry[kSteps];  ///< Ad(A_j)^-1
  typename Group::Vector w[kSteps + 1], al[kSteps + 1], jerk[kSteps + 1];
};

/// w_j = Ad^-1 w_{j-1} + lambda' d; al_j = Ad^-1 al_{j-1} + lambda'' d + lambda' w_j x d;
/// jerk_j = Ad^-1 jerk_{j-1} + lambda''' d + (lambda'' w_j + 2 lambda' al_j - lambda'^2 (w_j x d)) x d.
template <class Group>
Forward<Group> forward(const SplineView& view, const Lambdas& l, bool with_jerk) {
  using Vector = typename Group::Vector;
  using Matrix = typename Group::Matrix;
  Forward<Group> f;
  f.w[0] = f.al[0] = f.jerk[0] = Group::zero();
  for (int j = 0; j < view.order - 1; ++j) {
    const Vector d = Group::d(view.jacobians[j]);
    const double l1 = l.first[j], l2 = l.second[j];
    f.carry[j] = Group::adjoint_inverse(view.steps[j], l.value[j]);
    f.w[j + 1] = f.carry[j] * f.w[j] + l1 * d;
    const Vector w_d = Group::hat(f.w[j + 1]) * d;
    f.al[j + 1] = f.carry[j] * f.al[j] + l2 * d + l1 * w_d;
    if (with_jerk) {
      const Matrix outer = Group::hat(l2 * f.w[j + 1] + (2 * l1) * f.al[j + 1] - (l1 * l1) * w_d);
      f.jerk[j + 1] = f.carry[j] * f.jerk[j] + l.third[j] * d + outer * d;
    }
  }
  return f;
}

/// Derivatives of pose, velocity and acceleration in the body's frame by the control points perturbed on the right.
template <class Group>
struct Columns {
  typename Group::Matrix pose[kMaxSplineOrder], w[kMaxSplineOrder], al[kMaxSplineOrder];
};

/// Step j takes a change delta of d into changes of what it hands on,
///   tau = lambda Jr(lambda d) delta, omega = (Ad^-1 w_{j-1})^ tau + lambda' delta,
///   alpha = (Ad^-1 al_{j-1})^ tau + lambda'' delta + lambda' (w_j^ delta - d^ omega);
/// the later steps carry those on by [P 0 0; 0 P 0; 0 S P], gathered from the last step backwards.
template <class Group>
Columns<Group> backward(const SplineView& view, const Lambdas& l, const Forward<Group>& f, Derivative upto) {
  using Matrix = typename Group::Matrix;
  const bool velocity = upto >= Derivative::velocity, acceleration = upto >= Derivative::acceleration;
  const int k = view.order;
  Columns<Group> out;
  Matrix P = Group::scaled_identity(1), S = Group::scaled_identity(0);
  for (int j = k - 2; j >= 0; --j) {
    const SplineStepJacobians& step = view.jacobians[j];
    const Matrix right = Group::right_inverse(step), left = Group::left_inverse(step);
    const Matrix tau = Group::scaled_jacobian(view.steps[j], step, l.value[j]);
    // Control point j + 1 ends this step and begins the next, which has been here already.
    const auto spread = [&](Matrix* columns, const Matrix& by_d) {
      if (j == k - 2) {
        columns[j + 1] = by_d * right;
      } else {
        columns[j + 1] = columns[j + 1] + by_d * right;
      }
      columns[j] = Group::scaled_identity(0) - by_d * left;
    };
    spread(out.pose, P * tau);
    if (velocity) {
      const Matrix omega = Group::hat(f.carry[j] * f.w[j]) * tau + Group::scaled_identity(l.first[j]);
      spread(out.w, P * omega);
      if (acceleration) {
        const Matrix d_hat = Group::hat(Group::d(step));
        const Matrix alpha = Group::hat(f.carry[j] * f.al[j]) * tau + Group::scaled_identity(l.second[j]) +
                             l.first[j] * (Group::hat(f.w[j + 1]) - d_hat * omega);
        spread(out.al, S * omega + P * alpha);
        S = (S - l.first[j] * (P * d_hat)) * f.carry[j];
      }
    }
    P = P * f.carry[j];
  }
  out.pose[0] = out.pose[0] + P;
  return out;
}

void set_state(const SplineView& view, const Forward<So3>& f, double u, Kinematics& state) {
  const int n = view.order - 1;
  const auto p = position_of(*view.interval, view.order, u);
  state.T_world_body = spline_pose(view, u);
  state.v_world = p[1];
  state.a_world = p[2];
  state.omega_body = f.w[n];
  state.alpha_body = f.al[n];
}

/// v = R nu, a = R (d(nu)/dt + omega x nu).
void set_state(const SplineView& view, const Forward<Se3>& f, double u, Kinematics& state) {
  const int n = view.order - 1;
  const Vector3d &nu = f.w[n].dual, &nu_dot = f.al[n].dual;
  state.T_world_body = spline_pose(view, u);
  state.omega_body = f.w[n].real;
  state.alpha_body = f.al[n].real;
  state.v_world = state.T_world_body.linear() * nu;
  state.a_world = state.T_world_body.linear() * (nu_dot + state.omega_body.cross(nu));
}

/// With a = R b: R (db/dt + omega x b).
Vector3d jerk_world(const Forward<Se3>& f, int n, const Kinematics& state) {
  const Vector3d &nu = f.w[n].dual, &nu_dot = f.al[n].dual, &omega = state.omega_body;
  const Vector3d b = nu_dot + omega.cross(nu);
  const Vector3d b_dot = f.jerk[n].dual + state.alpha_body.cross(nu) + omega.cross(nu_dot);
  return state.T_world_body.linear() * (b_dot + omega.cross(b));
}

/// Rows of one control point's six columns.
template <class J>
void set_columns(const SplineView& view, const Lambdas& l, const Columns<So3>& columns, const StateJet& jet,
                 Derivative upto, int i, J&& out) {
  // The control point's own weight: what the steps to it and from it leave.
  const auto weight = [&](const double* lambda, double first) {
    return (i == 0 ? first : lambda[i - 1]) - (i + 1 < view.order ? lambda[i] : 0.0);
  };
  const Matrix3d R_inverse = jet.state.T_world_body.linear().transpose();
  out.template block<3, 3>(state_row::pose, 0) = weight(l.value, 1) * R_inverse;
  out.template block<3, 3>(state_row::pose + 3, 3) = columns.pose[i];
  if (upto < Derivative::velocity) return;
  out.template block<3, 3>(state_row::velocity, 0).diagonal().setConstant(weight(l.first, 0));
  out.template block<3, 3>(state_row::omega, 3) = columns.w[i];
  if (upto < Derivative::acceleration) return;
  out.template block<3, 3>(state_row::acceleration, 0).diagonal().setConstant(weight(l.second, 0));
  out.template block<3, 3>(state_row::alpha, 3) = columns.al[i];
}

/// dv = R (d(nu) - nu^ phi), da = R (d(d(nu)/dt) - nu^ d(omega) + omega^ d(nu) - b^ phi) with b = R^T a.
template <class J>
void set_columns(const SplineView&, const Lambdas&, const Columns<Se3>& columns, const StateJet& jet, Derivative upto,
                 int i, J&& out) {
  const DualMatrix& pose = columns.pose[i];
  out.template block<3, 3>(state_row::pose, 0) = pose.real;
  out.template block<3, 3>(state_row::pose, 3) = pose.dual;
  out.template block<3, 3>(state_row::pose + 3, 3) = pose.real;
  if (upto < Derivative::velocity) return;
  const Matrix3d R = jet.state.T_world_body.linear();
  const Matrix3d nu_hat = so3::hat(R.transpose() * jet.state.v_world);
  const DualMatrix& w = columns.w[i];
  out.template block<3, 3>(state_row::velocity, 0) = R * w.real;
  out.template block<3, 3>(state_row::velocity, 3) = R * (w.dual - nu_hat * pose.real);
  out.template block<3, 3>(state_row::omega, 3) = w.real;
  if (upto < Derivative::acceleration) return;
  const Matrix3d omega_hat = so3::hat(jet.state.omega_body), b_hat = so3::hat(R.transpose() * jet.state.a_world);
  const DualMatrix& al = columns.al[i];
  out.template block<3, 3>(state_row::acceleration, 0) = R * (al.real + omega_hat * w.real);
  out.template block<3, 3>(state_row::acceleration, 3) =
      R * (al.dual - nu_hat * w.real + omega_hat * w.dual - b_hat * pose.real);
  out.template block<3, 3>(state_row::alpha, 3) = al.real;
}

template <class Group>
void jet_of(const SplineView& view, double u, Derivative upto, StateJet& jet) {
  const Lambdas l = lambdas(*view.interval, view.order, u);
  const Forward<Group> f = forward<Group>(view, l, false);
  set_state(view, f, u, jet.state);
  const Columns<Group> columns = backward<Group>(view, l, f, upto);
  jet.J.resize(state_row::count, 6 * view.order);
  jet.J.topRows(state_row::filled(upto)).setZero();
  for (int i = 0; i < view.order; ++i) {
    set_columns(view, l, columns, jet, upto, i, jet.J.template middleCols<6>(6 * i));
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
    for (std::size_t i = 0; i < ascending.size(); ++i) {
      const Time t = ascending[i];
      if (i > 0 && t <= ascending[i - 1]) {
        if (t < ascending[i - 1]) throw InputError(fmt::format("time {} of a batch lies before the one before it", i));
        out[i] = out[i - 1];
        continue;
      }
      while (t >= view.interval->end && view.interval != last) {
        ++view.interval;
        ++view.steps;
      }
      pose_of<order(), kind()>(view, view.interval->u(t), out[i]);
    }
  });
}

Kinematics spline_kinematics(const SplineView& view, double u) {
  const Lambdas l = lambdas(*view.interval, view.order, u);
  Kinematics state;
  if (view.kind == SplineKind::split) {
    set_state(view, forward<So3>(view, l, false), u, state);
  } else {
    set_state(view, forward<Se3>(view, l, false), u, state);
  }
  return state;
}

StateVector spline_rate(const SplineView& view, double u, Derivative upto) {
  const Lambdas l = lambdas(*view.interval, view.order, u);
  const int n = view.order - 1;
  Kinematics state;
  Vector3d jerk, alpha_dot;
  if (view.kind == SplineKind::split) {
    const Forward<So3> f = forward<So3>(view, l, true);
    set_state(view, f, u, state);
    jerk = position_of(*view.interval, view.order, u)[3];
    alpha_dot = f.jerk[n];
  } else {
    const Forward<Se3> f = forward<Se3>(view, l, true);
    set_state(view, f, u, state);
    jerk = jerk_world(f, n, state);
    alpha_dot = f.jerk[n].real;
  }
  StateVector rate = StateVector::Zero();
  rate.segment<3>(state_row::pose) = state.T_world_body.linear().transpose() * state.v_world;
  rate.segment<3>(state_row::pose + 3) = state.omega_body;
  if (upto < Derivative::velocity) return rate;
  rate.segment<3>(state_row::velocity) = state.a_world;
  rate.segment<3>(state_row::omega) = state.alpha_body;
  if (upto < Derivative::acceleration) return rate;
  rate.segment<3>(state_row::acceleration) = jerk;
  rate.segment<3>(state_row::alpha) = alpha_dot;
  return rate;
}

void spline_jet(const SplineView& view, double u, Derivative upto, StateJet& jet) {
  view.kind == SplineKind::split ? jet_of<So3>(view, u, upto, jet) : jet_of<Se3>(view, u, upto, jet);
}

}  // namespace tarmac::core
