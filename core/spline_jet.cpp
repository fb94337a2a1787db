// Velocities, accelerations and Jacobians of spline_interval.h.
#include "core/spline_groups.h"
#include "core/spline_interval.h"

namespace tarmac::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSteps = kMaxSplineOrder - 1;

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

void set_state(const SplineView& view, const Forward<RotationGroup>& f, double u, Kinematics& state) {
  const int n = view.order - 1;
  const auto p = position_of(*view.interval, view.order, u);
  state.T_world_body = spline_pose(view, u);
  state.v_world = p[1];
  state.a_world = p[2];
  state.omega_body = f.w[n];
  state.alpha_body = f.al[n];
}

/// v = R nu, a = R (d(nu)/dt + omega x nu).
void set_state(const SplineView& view, const Forward<PoseGroup>& f, double u, Kinematics& state) {
  const int n = view.order - 1;
  const Vector3d &nu = f.w[n].dual, &nu_dot = f.al[n].dual;
  state.T_world_body = spline_pose(view, u);
  state.omega_body = f.w[n].real;
  state.alpha_body = f.al[n].real;
  state.v_world = state.T_world_body.linear() * nu;
  state.a_world = state.T_world_body.linear() * (nu_dot + state.omega_body.cross(nu));
}

/// With a = R b: R (db/dt + omega x b).
Vector3d jerk_world(const Forward<PoseGroup>& f, int n, const Kinematics& state) {
  const Vector3d &nu = f.w[n].dual, &nu_dot = f.al[n].dual, &omega = state.omega_body;
  const Vector3d b = nu_dot + omega.cross(nu);
  const Vector3d b_dot = f.jerk[n].dual + state.alpha_body.cross(nu) + omega.cross(nu_dot);
  return state.T_world_body.linear() * (b_dot + omega.cross(b));
}

/// Rows of one control point's six columns.
template <class J>
void set_columns(const SplineView& view, const Lambdas& l, const Columns<RotationGroup>& columns, const StateJet& jet,
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
void set_columns(const SplineView&, const Lambdas&, const Columns<PoseGroup>& columns, const StateJet& jet,
                 Derivative upto, int i, J&& out) {
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

Kinematics spline_kinematics(const SplineView& view, double u) {
  const Lambdas l = lambdas(*view.interval, view.order, u);
  Kinematics state;
  if (view.kind == SplineKind::split) {
    set_state(view, forward<RotationGroup>(view, l, false), u, state);
  } else {
    set_state(view, forward<PoseGroup>(view, l, false), u, state);
  }
  return state;
}

StateVector spline_rate(const SplineView& view, double u, Derivative upto) {
  const Lambdas l = lambdas(*view.interval, view.order, u);
  const int n = view.order - 1;
  Kinematics state;
  Vector3d jerk, alpha_dot;
  if (view.kind == SplineKind::split) {
    const Forward<RotationGroup> f = forward<RotationGroup>(view, l, true);
    set_state(view, f, u, state);
    jerk = position_of(*view.interval, view.order, u)[3];
    alpha_dot = f.jerk[n];
  } else {
    const Forward<PoseGroup> f = forward<PoseGroup>(view, l, true);
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
  view.kind == SplineKind::split ? jet_of<RotationGroup>(view, u, upto, jet) : jet_of<PoseGroup>(view, u, upto, jet);
}

}  // namespace tarmac::core
