#include "core/gp_interval.h"

#include "core/lie_derivatives.h"
#include "core/stumpff.h"

namespace tarmac::core {
namespace {

Vector6 bracket(const Vector6& a, const Vector6& b) {
  const Eigen::Vector3d av = a.head<3>(), aw = a.tail<3>(), bv = b.head<3>(), bw = b.tail<3>();
  Vector6 out;
  out << aw.cross(bv) + av.cross(bw), aw.cross(bw);
  return out;
}

/// T Exp(xi), written out: what a pose query costs is this.
SE3 moved(const SE3& T, const Vector6& xi) {
  const Eigen::Vector3d rho = xi.head<3>(), phi = xi.tail<3>();
  const Stumpff s = stumpff(phi.squaredNorm());
  const Eigen::Vector3d cross = phi.cross(rho);
  const Eigen::Vector3d p = rho + s.s2 * cross + s.s3 * phi.cross(cross);
  const double x = phi.x(), y = phi.y(), z = phi.z();
  const double xx = s.s2 * x * x, yy = s.s2 * y * y, zz = s.s2 * z * z;
  const double xy = s.s2 * x * y, xz = s.s2 * x * z, yz = s.s2 * y * z;
  Eigen::Matrix3d E;
  E << 1 - yy - zz, xy - s.s1 * z, xz + s.s1 * y,  //
      xy + s.s1 * z, 1 - xx - zz, yz - s.s1 * x,   //
      xz - s.s1 * y, yz + s.s1 * x, 1 - xx - yy;
  SE3 out;
  out.linear().noalias() = T.linear().lazyProduct(E);
  out.translation().noalias() = T.linear().lazyProduct(p) + T.translation();
  out.makeAffine();
  return out;
}

Vector6 weighted(const std::array<Vector6, 3>& Lambda, const std::array<Vector6, 3>& gamma_1,
                 const std::array<Vector6, 3>& Psi, const std::array<Vector6, 3>& gamma_2) {
  Vector6 sum = Psi[0].cwiseProduct(gamma_2[0]);
  for (std::size_t j = 1; j < 3; ++j) {
    sum += Lambda[j].cwiseProduct(gamma_1[j]) + Psi[j].cwiseProduct(gamma_2[j]);
  }
  return sum;
}

}  // namespace

GpKnot gp_knot(Time t, const Kinematics& state) {
  const Eigen::Matrix3d R_body_world = state.T_world_body.linear().transpose();
  const Eigen::Vector3d nu = R_body_world * state.v_world;
  GpKnot knot;
  knot.t = t;
  knot.T_world_body = state.T_world_body;
  knot.varpi << nu, state.omega_body;
  knot.dvarpi << R_body_world * state.a_world - state.omega_body.cross(nu), state.alpha_body;
  return knot;
}

Kinematics kinematics(const GpKnot& knot) {
  const Eigen::Matrix3d& R = knot.T_world_body.linear();
  const Eigen::Vector3d nu = knot.varpi.head<3>(), omega = knot.varpi.tail<3>();
  return {knot.T_world_body, R * nu, R * (knot.dvarpi.head<3>() + omega.cross(nu)), omega, knot.dvarpi.tail<3>()};
}

GpAxisGroups group_axes(const GpPrior& prior) {
  GpAxisGroups groups;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const double rate = prior.model == GpModel::singer ? prior.rate[static_cast<Eigen::Index>(axis)] : 0;
    std::size_t k = 0;
    while (k < groups.rates.size() && groups.rates[k] != rate) ++k;
    if (k == groups.rates.size()) groups.rates.push_back(rate);
    groups.group_of_axis[axis] = k;
  }
  return groups;
}

GpInterval::GpInterval(GpModel model, const GpAxisGroups& groups, const GpKnot& first, const GpKnot& second)
    : model_(model), groups_(groups), T_(to_s(second.t - first.t)), T_first_(first.T_world_body) {
  for (const double rate : groups.rates) axes_.emplace_back(model, rate, T_);
  const Vector6 xi = se3::log(first.T_world_body.inverse() * second.T_world_body);
  const Matrix6 J_inverse = se3::right_jacobian_inverse(xi);
  const Vector6 eta = J_inverse * second.varpi;
  gamma_1_ = {Vector6::Zero(), first.varpi, Vector6::Zero()};
  gamma_2_ = {xi, eta, Vector6::Zero()};
  if (model != GpModel::wnoa) {
    gamma_1_[2] = first.dvarpi;
    gamma_2_[2] = J_inverse * second.dvarpi + 0.5 * bracket(eta, second.varpi);
  }
  fit_curve();
}

/// xi as a function of d with as few products as there are: its coefficients, the interval's own.
void GpInterval::fit_curve() {
  const Vector6 &p = gamma_2_[0], v0 = T_ * gamma_1_[1], v1 = T_ * gamma_2_[1];
  const Vector6 zero = Vector6::Zero();
  if (model_ == GpModel::wnoa) {
    curve_ = {zero, v0, 3 * p - 2 * v0 - v1, -2 * p + v0 + v1, zero, zero};
    return;
  }
  const Vector6 a0 = T_ * T_ * gamma_1_[2], a1 = T_ * T_ * gamma_2_[2];
  if (model_ == GpModel::wnoj) {
    curve_ = {zero,
              v0,
              0.5 * a0,
              10 * p - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1,
              -15 * p + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
              6 * p - 3 * v0 - 3 * v1 + 0.5 * (a1 - a0)};
    return;
  }
  for (const double rate : groups_.rates) singer_.emplace_back(rate, T_);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const SingerCurve& curve = singer_[groups_.group_of_axis[static_cast<std::size_t>(k)]];
    const auto c = curve.fit({0, v0[k], a0[k]}, {p[k], v1[k], a1[k]});
    for (std::size_t j = 0; j < 6; ++j) curve_[j][k] = c[j];
  }
}

Vector6 GpInterval::xi(double d) const {
  const double r = d / T_;
  const auto& c = curve_;
  if (model_ == GpModel::wnoa) return r * (c[1] + r * (c[2] + r * c[3]));
  if (model_ == GpModel::wnoj) return r * (c[1] + r * (c[2] + r * (c[3] + r * (c[4] + r * c[5]))));
  const double s = r - 0.5;
  Vector6 out = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
  std::array<double, 6> C, S;
  for (std::size_t g = 0; g < singer_.size(); ++g) singer_[g].basis(s, C[g], S[g]);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t g = groups_.group_of_axis[k];
    const auto i = static_cast<Eigen::Index>(k);
    out[i] += C[g] * c[4][i] + S[g] * c[5][i];
  }
  return out;
}

SE3 GpInterval::pose(double d) const {
  return moved(T_first_, xi(d));
}

GpInterval::Weights GpInterval::weights(double d) const {
  std::array<GpWeights, 6> of_group;
  for (std::size_t g = 0; g < axes_.size(); ++g) of_group[g] = axes_[g].weights(d);
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 6; ++k) {
        const GpWeights& from = of_group[groups_.group_of_axis[k]];
        w.Lambda[i][j][static_cast<Eigen::Index>(k)] = from.Lambda[i][j];
        w.Psi[i][j][static_cast<Eigen::Index>(k)] = from.Psi[i][j];
      }
    }
  }
  return w;
}

GpLocal GpInterval::local(double d, const Weights& w) const {
  GpLocal out;
  out.row[0] = xi(d);
  for (std::size_t i = 1; i < 4; ++i) out.row[i] = weighted(w.Lambda[i], gamma_1_, w.Psi[i], gamma_2_);
  return out;
}

GpKnot state_of(GpModel model, const SE3& T_first, const GpLocal& g) {
  const auto& [xi, eta, zeta, unused] = g.row;
  const Matrix6 Jr = se3::right_jacobian(xi);
  GpKnot out;
  out.T_world_body = moved(T_first, xi);
  out.varpi = Jr * eta;
  out.dvarpi = model == GpModel::wnoa ? Vector6(Jr * zeta + se3::right_jacobian_rate(xi, eta))
                                      : Vector6(Jr * (zeta - 0.5 * bracket(eta, out.varpi)));
  return out;
}

GpKnot GpInterval::state(double d) const {
  return state_of(model_, T_first_, local(d, weights(d)));
}

std::array<Vector6, 3> GpInterval::rate(double d) const {
  const auto [xi, eta, zeta, dzeta] = local(d, weights(d)).row;
  const Matrix6 Jr = se3::right_jacobian(xi);
  const Vector6 varpi = Jr * eta;
  Matrix6 by_xi, by_w;
  const Vector6 dvarpi = Jr * zeta + se3::right_jacobian_rate(xi, eta, &by_xi, &by_w);
  if (model_ == GpModel::wnoa) {
    return {varpi, dvarpi, Jr * dzeta + se3::right_jacobian_derivative(xi, zeta) * eta + by_xi * eta + by_w * zeta};
  }
  const Vector6 q = zeta - 0.5 * bracket(eta, varpi);
  const Vector6 dq = dzeta - 0.5 * (bracket(zeta, varpi) + bracket(eta, dvarpi));
  return {varpi, dvarpi, Jr * dq + se3::right_jacobian_derivative(xi, q) * eta};
}

GpIntervalJacobian::GpIntervalJacobian(const GpInterval& interval, const GpKnot& second)
    : order_(gp_order(interval.model())) {
  const Vector6 &xi = interval.gamma_2()[0], &eta = interval.gamma_2()[1];
  J_inverse_ = se3::right_jacobian_inverse(xi);
  by_T2_[0] = J_inverse_;
  by_T1_[0] = -se3::left_jacobian_inverse(xi);
  const Matrix6 eta_by_xi = se3::right_jacobian_inverse_derivative(xi, second.varpi);
  by_T2_[1] = eta_by_xi * by_T2_[0];
  by_T1_[1] = eta_by_xi * by_T1_[0];
  if (order_ < 3) return;
  // d(1/2 curly(eta) varpi) = 1/2 curly(eta) d(varpi) - 1/2 curly(varpi) d(eta).
  const Matrix6 half_varpi = 0.5 * se3::curly_hat(second.varpi);
  const Matrix6 zeta_by_xi = se3::right_jacobian_inverse_derivative(xi, second.dvarpi) - half_varpi * eta_by_xi;
  by_T2_[2] = zeta_by_xi * by_T2_[0];
  by_T1_[2] = zeta_by_xi * by_T1_[0];
  zeta_by_varpi2_ = 0.5 * se3::curly_hat(eta) - half_varpi * J_inverse_;
}

GpJacobian GpIntervalJacobian::gamma_2() const {
  const int n = order_, second = 6 * n;
  GpJacobian J = GpJacobian::Zero(6 * n, 12 * n);
  for (int i = 0; i < n; ++i) {
    J.block<6, 6>(6 * i, 0) = by_T1_[static_cast<std::size_t>(i)];
    J.block<6, 6>(6 * i, second) = by_T2_[static_cast<std::size_t>(i)];
    if (i > 0) J.block<6, 6>(6 * i, second + 6 * i) = J_inverse_;
  }
  if (n == 3) J.block<6, 6>(12, second + 6) = zeta_by_varpi2_;
  return J;
}

namespace {

/// All 6x6 matrices here are [[A, B], [0, C]]: half of a product's terms are zero.
Matrix6 times(const Matrix6& a, const Matrix6& b) {
  Matrix6 out;
  out.topLeftCorner<3, 3>() = a.topLeftCorner<3, 3>().lazyProduct(b.topLeftCorner<3, 3>());
  out.topRightCorner<3, 3>() = a.topLeftCorner<3, 3>().lazyProduct(b.topRightCorner<3, 3>()) +
                               a.topRightCorner<3, 3>().lazyProduct(b.bottomRightCorner<3, 3>());
  out.bottomLeftCorner<3, 3>().setZero();
  out.bottomRightCorner<3, 3>() = a.bottomRightCorner<3, 3>().lazyProduct(b.bottomRightCorner<3, 3>());
  return out;
}

/// The state's rows by gamma's: pose by d(xi), varpi by d(xi) and d(eta), varpi' by all three.
struct StateChain {
  Matrix6 Jr;  ///< of every row by its own
  Matrix6 varpi_by_xi;
  Matrix6 dvarpi_by_xi, dvarpi_by_eta;  ///< with varpi's own dependence folded in
};

/// Also the state itself, without its pose and up to `upto` (its velocity in any case).
StateChain chain_of(GpModel model, const GpLocal& g, Derivative upto, GpKnot& state) {
  const auto& [xi, eta, zeta, unused] = g.row;
  StateChain c;
  c.Jr = se3::right_jacobian(xi);
  state.varpi = c.Jr * eta;
  state.dvarpi.setZero();
  if (upto == Derivative::pose) return c;
  c.varpi_by_xi = se3::right_jacobian_derivative(xi, eta);
  if (upto == Derivative::velocity) return c;
  if (model == GpModel::wnoa) {
    Matrix6 by_xi;
    state.dvarpi = c.Jr * zeta + se3::right_jacobian_rate(xi, eta, &by_xi, &c.dvarpi_by_eta);
    c.dvarpi_by_xi = se3::right_jacobian_derivative(xi, zeta) + by_xi;
    return c;
  }
  // varpi' = Jr q, q = zeta - 1/2 curly(eta) varpi: dq = d(zeta) + 1/2 curly(varpi) d(eta) - 1/2 curly(eta) d(varpi).
  const Vector6 q = zeta - 0.5 * bracket(eta, state.varpi);
  state.dvarpi = c.Jr * q;
  const Matrix6 half_eta = 0.5 * times(c.Jr, se3::curly_hat(eta));
  c.dvarpi_by_xi = se3::right_jacobian_derivative(xi, q) - times(half_eta, c.varpi_by_xi);
  c.dvarpi_by_eta = 0.5 * times(c.Jr, se3::curly_hat(state.varpi)) - times(half_eta, c.Jr);
  return c;
}

}  // namespace

GpJacobian state_by_gamma(GpModel model, const GpLocal& g, Derivative upto) {
  GpKnot unused;
  const StateChain c = chain_of(model, g, upto, unused);
  const int rows = static_cast<int>(upto) + 1;
  GpJacobian J = GpJacobian::Zero(6 * rows, 6 * rows);
  for (int i = 0; i < rows; ++i) J.block<6, 6>(6 * i, 6 * i) = c.Jr;
  if (rows > 1) J.block<6, 6>(6, 0) = c.varpi_by_xi;
  if (rows > 2) {
    J.block<6, 6>(12, 0) = c.dvarpi_by_xi;
    J.block<6, 6>(12, 6) = c.dvarpi_by_eta;
  }
  return J;
}

GpJacobian GpIntervalJacobian::state(const GpInterval& interval, double d, Derivative upto, GpKnot& state) const {
  const int n = order_, second = 6 * n, rows = static_cast<int>(upto) + 1;
  const GpInterval::Weights w = interval.weights(d);
  const GpLocal g = interval.local(d, w);
  const StateChain c = chain_of(interval.model(), g, upto, state);
  const SE3 step = se3::exp(g.row[0]);
  state.T_world_body = interval.pose(d);
  GpJacobian J(6 * rows, 12 * n);
  // Columns of six one after the other: what moves there moves gamma's rows by `by`, and those the state's.
  const auto fill = [&](int column, const std::array<Matrix6, 3>& by) {
    J.block<6, 6>(0, column) = times(c.Jr, by[0]);
    if (rows > 1) J.block<6, 6>(6, column) = times(c.Jr, by[1]) + times(c.varpi_by_xi, by[0]);
    if (rows > 2) {
      J.block<6, 6>(12, column) = times(c.Jr, by[2]) + times(c.dvarpi_by_eta, by[1]) + times(c.dvarpi_by_xi, by[0]);
    }
  };
  const auto scaled = [&](const std::array<Matrix6, 3>& of_gamma_2, std::size_t from) {
    std::array<Matrix6, 3> by;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
      by[i] = w.Psi[i][from].asDiagonal() * of_gamma_2[from];
      for (std::size_t j = from + 1; j < static_cast<std::size_t>(n); ++j) {
        by[i] += w.Psi[i][j].asDiagonal() * of_gamma_2[j];
      }
    }
    return by;
  };
  fill(0, scaled(by_T1_, 0));
  J.topLeftCorner<6, 6>() += se3::adjoint(step.inverse());
  fill(second, scaled(by_T2_, 0));
  fill(second + 6, scaled({Matrix6(), J_inverse_, zeta_by_varpi2_}, 1));
  if (n == 3) fill(second + 12, scaled({Matrix6(), Matrix6(), J_inverse_}, 2));
  for (int j = 1; j < n; ++j) {
    std::array<Matrix6, 3> by;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
      by[i] = w.Lambda[i][static_cast<std::size_t>(j)].asDiagonal();
    }
    fill(6 * j, by);
  }
  return J;
}

}  // namespace tarmac::core
