// What each residual beside the LiDAR's says at a state.
#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "estimators/window/accelerometer_residual.h"
#include "estimators/window/gravity_direction.h"
#include "estimators/window/gyro_residual.h"
#include "estimators/window/smoothness_residual.h"
#include "estimators/window/velocity_increment.h"
#include "estimators/window/window_problem.h"

namespace tarmac::estimators {
namespace {

namespace row = core::state_row;
using core::Derivative;
using core::StateJet;
using core::StateVector;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A reading stands for the time within this of it, where it has no neighbour nearer.
constexpr core::Duration kReach{20'000'000};

/// The state's Jacobian by the parameters, rows of `upto`, chained into the term.
template <int Rows>
void chain(const StateJacobian<Rows>& by_state, const StateJet& jet, Derivative upto, Term& term) {
  const int filled = row::filled(upto);
  term.first = jet.first;
  term.J.noalias() = by_state.leftCols(filled) * jet.J.topRows(filled);
}

/// Adds columns from `first` on, growing the term's run where they lie beside it.
void add_columns(int first, const Eigen::Ref<const Eigen::MatrixXd>& J, Term& term) {
  const Index old_count = term.J.cols();
  if (old_count == 0) {
    term.first = first;
    term.J = J;
    return;
  }
  const int low = std::min(first, term.first);
  const auto high = std::max(first + J.cols(), term.first + old_count);
  if (high - low > StateJet::kMaxColumns) throw std::logic_error("a residual reaches further than a trajectory's run");
  if (low != term.first || high != term.first + old_count) {
    const Term::Band old = term.J;
    term.J.setZero(old.rows(), high - low);
    term.J.middleCols(term.first - low, old_count) = old;
    term.first = low;
  }
  term.J.middleCols(first - low, J.cols()) += J;
}

StateVector filled_rate(const core::ParametricTrajectory& trajectory, core::Time t, Derivative upto) {
  StateVector rate = trajectory.rate(t, upto);
  rate.tail(row::count - row::filled(upto)).setZero();
  return rate;
}

}  // namespace

void WindowProblem::terms(const WindowState& state, const Item& item, bool jacobians, std::vector<Term>& out) const {
  out.clear();
  switch (item.kind) {
    case Item::Kind::reading:
      return reading_terms(state, item, jacobians, out);
    case Item::Kind::increment:
      return increment_term(state, item, out);
    case Item::Kind::smoothness:
      return smoothness_term(state, item, jacobians, out);
    case Item::Kind::anchor:
      return anchor_term(state, item, out);
    case Item::Kind::model_prior:
      return model_prior_term(state, item, out);
    default:
      return border_term(state, item, out);
  }
}

void WindowProblem::add_bias(const WindowState& state, core::Time stamp, int axis, const Matrix3d& by_bias,
                             Term& term) const {
  if (layout_.biases == 0) return;
  const BiasPlace place = bias_place(state.biases, stamp);
  term.add_border(6 * place.knot + axis, 3) = (1 - place.share) * by_bias;
  if (place.share > 0) term.add_border(6 * (place.knot + 1) + axis, 3) = place.share * by_bias;
}

/// The reading's time is stamp - offset, which is rounded to nanoseconds; the rest is made up for by the state's rate,
/// so that the cost is smooth in the offset.
void WindowProblem::reading_terms(const WindowState& state, const Item& item, bool jacobians,
                                  std::vector<Term>& out) const {
  const ImuReading& reading = data_->readings[static_cast<std::size_t>(item.index)];
  const core::ParametricTrajectory& trajectory = *state.trajectory;
  const core::Duration offset = core::duration_from_s(state.imu_offset_s);
  const core::Time t = reading.t - offset;
  if (!trajectory.covers(t)) return;
  const bool accelerometer = model_->accel_sigma_m_s2 > 0 && !model_->accel_as_increments;
  const Derivative upto = accelerometer ? Derivative::acceleration : Derivative::velocity;
  StateJet jet;
  if (jacobians) {
    trajectory.jet(t, upto, jet);
  } else {
    jet.state = trajectory.at(t);
  }
  StateVector rate = StateVector::Zero();
  if (layout_.offset >= 0) {
    rate = filled_rate(trajectory, t, upto);
    jet.state = moved(jet.state, rate * (core::to_s(offset) - state.imu_offset_s));
  }
  const core::Vector6 bias = bias_at(state.biases, reading.t);
  const auto finish = [&](const StateJacobian<3>& by_state, int axis, double sigma, Term& term) {
    chain(by_state, jet, upto, term);
    add_bias(state, reading.t, axis, Matrix3d::Identity() / sigma, term);
    if (layout_.offset >= 0) term.add_border(layout_.offset, 1) = -by_state * rate;
  };
  StateJacobian<3> by_state;
  if (model_->gyro_sigma_rad_s > 0) {
    Term& term = out.emplace_back();
    term.clear(3);
    const GyroResidual gyro{reading.gyro_rad_s, model_->T_body_imu.linear()};
    term.e = gyro(jet.state, bias.head<3>(), by_state) / model_->gyro_sigma_rad_s;
    by_state /= model_->gyro_sigma_rad_s;
    if (jacobians) finish(by_state, 0, model_->gyro_sigma_rad_s, term);
  }
  if (!accelerometer) return;
  Term& term = out.emplace_back();
  term.clear(3);
  term.loss = &model_->accel_loss;
  const AccelerometerResidual accel{reading.accel_m_s2, model_->T_body_imu, model_->omit_transport};
  const double sigma = model_->accel_sigma_m_s2;
  Matrix3d by_gravity;
  term.e = accel(jet.state, model_->gravity_m_s2 * state.gravity_map, bias.tail<3>(), by_state, by_gravity) / sigma;
  by_state /= sigma;
  if (!jacobians) return;
  finish(by_state, 3, sigma, term);
  if (layout_.gravity >= 0) {
    term.add_border(layout_.gravity, 2) =
        by_gravity * (model_->gravity_m_s2 / sigma) * gravity_direction::tangent(state.gravity_map);
  }
}

/// The stretch ends a nanosecond before the next piece begins, so that all of it depends on one run of blocks.
void WindowProblem::increment_term(const WindowState& state, const Item& item, std::vector<Term>& out) const {
  const auto i = static_cast<std::size_t>(item.index);
  const core::Time t1 = breaks_[i], t2 = breaks_[i + 1] - core::Duration(1);
  const core::ParametricTrajectory& trajectory = *state.trajectory;
  if (t2 <= t1 || !trajectory.covers(t1) || !trajectory.covers(t2)) return;
  const auto samples = increment_samples(data_->readings, state.imu_offset_s, t1, t2, kReach);
  if (samples.empty()) return;
  double squares = 0, squares_by_offset = 0;  // of the shares; the first and the last change with the offset
  for (const IncrementSample& sample : samples) {
    squares += sample.dt_s * sample.dt_s;
    squares_by_offset += 2 * sample.dt_s * sample.dt_by_offset;
  }
  const double sigma = model_->accel_sigma_m_s2 * std::sqrt(squares);
  const VelocityIncrement increment{model_->T_body_imu, model_->gravity_m_s2 * state.gravity_map,
                                    model_->omit_transport};

  Term& term = out.emplace_back();
  term.clear(3);
  term.loss = &model_->accel_loss;
  StateJet jet;
  StateJacobian<3> by_state;
  for (const auto& [t, sign] : {std::pair{t1, -1.0}, std::pair{t2, 1.0}}) {
    trajectory.jet(t, Derivative::velocity, jet);
    term.e += sign / sigma * increment.velocity(jet.state, by_state);
    add_columns(jet.first, sign / sigma * by_state.leftCols<12>() * jet.J.topRows<12>(), term);
  }
  const core::Time middle = t1 + (t2 - t1) / 2;
  const Vector3d bias = bias_at(state.biases, middle).tail<3>();
  Matrix3d by_bias = Matrix3d::Zero(), by_gravity = Matrix3d::Zero();
  Vector3d by_offset = Vector3d::Zero();
  for (const IncrementSample& sample : samples) {
    trajectory.jet(sample.at, Derivative::velocity, jet);
    const VelocityIncrement::Rate rate = increment.rate(jet.state, sample.accel_m_s2, bias);
    const double share = sample.dt_s / sigma;
    term.e -= share * rate.m_s2;
    add_columns(jet.first, -share * rate.by_phi * jet.J.middleRows<3>(row::pose + 3), term);
    by_bias -= share * rate.by_bias;
    by_gravity -= share * rate.by_gravity;
    by_offset -= sample.dt_by_offset / sigma * rate.m_s2;
    if (!sample.kept_at_end) by_offset += share * rate.by_phi * jet.state.omega_body;
  }
  add_bias(state, middle, 3, by_bias, term);
  if (layout_.gravity >= 0) {
    term.add_border(layout_.gravity, 2) =
        by_gravity * model_->gravity_m_s2 * gravity_direction::tangent(state.gravity_map);
  }
  if (layout_.offset >= 0) {
    by_offset -= squares_by_offset / (2 * squares) * term.e;
    term.add_border(layout_.offset, 1) = by_offset;
  }
}

void WindowProblem::smoothness_term(const WindowState& state, const Item& item, bool jacobians,
                                    std::vector<Term>& out) const {
  const SmoothnessResidual residual{model_->smoothness_translation, model_->smoothness_rotation, item.weight_s};
  Term& term = out.emplace_back();
  term.clear(6);
  if (!jacobians) {
    term.e = residual(state.trajectory->at(item.t));
    return;
  }
  StateJet jet;
  StateJacobian<6> by_state;
  state.trajectory->jet(item.t, Derivative::acceleration, jet);
  term.e = residual(jet.state, by_state);
  chain(by_state, jet, Derivative::acceleration, term);
}

void WindowProblem::anchor_term(const WindowState& state, const Item& item, std::vector<Term>& out) const {
  const StateAnchor& anchor = data_->anchors[static_cast<std::size_t>(item.index)];
  const core::ParametricTrajectory& trajectory = *state.trajectory;
  const Derivative upto = trajectory.has();
  StateJet jet;
  trajectory.jet(item.t, upto, jet);
  StateVector scale = StateVector::Zero();  // rows that the model does not have say nothing
  for (int i = 0; i < row::filled(upto); ++i) scale[i] = anchor.sigma[i] > 0 ? 1 / anchor.sigma[i] : 0.0;
  const StateVector d = difference(anchor.mean, jet.state);
  StateJacobian<18> by_state = StateJacobian<18>::Identity();
  by_state.topLeftCorner<6, 6>() = core::se3::right_jacobian_inverse(d.head<6>());
  Term& term = out.emplace_back();
  term.clear(row::count);
  term.e = scale.asDiagonal() * d;
  chain(StateJacobian<18>(scale.asDiagonal() * by_state), jet, upto, term);
}

void WindowProblem::model_prior_term(const WindowState& state, const Item& item, std::vector<Term>& out) const {
  core::PriorJet prior;
  state.trajectory->prior(item.index, prior);
  const Eigen::LLT<Eigen::MatrixXd> llt(prior.information);
  Term& term = out.emplace_back();
  term.clear(static_cast<int>(prior.e.size()));
  if (llt.info() != Eigen::Success) {  // whoever solves sees it and keeps the state
    term.e.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  term.e = llt.matrixU() * prior.e;
  term.first = prior.first;
  term.J = llt.matrixU() * prior.J;
}

void WindowProblem::border_term(const WindowState& state, const Item& item, std::vector<Term>& out) const {
  const auto index = static_cast<std::size_t>(item.index);
  Term& term = out.emplace_back();
  if (item.kind == Item::Kind::bias_walk) {
    const BiasKnot &a = state.biases[index], &b = state.biases[index + 1];
    const double root_s = std::sqrt(core::to_s(b.t - a.t));
    core::Vector6 scale;
    for (int i = 0; i < 6; ++i) {
      const double walk = i < 3 ? model_->gyro_walk_rad_s2_rthz : model_->accel_walk_m_s3_rthz;
      scale[i] = walk > 0 ? 1 / (walk * root_s) : 0.0;
    }
    term.clear(6);
    term.e = scale.cwiseProduct(b.gyro_accel - a.gyro_accel);
    term.add_border(6 * item.index, 6).diagonal() = -scale;
    term.add_border(6 * item.index + 6, 6).diagonal() = scale;
  } else if (item.kind == Item::Kind::bias_anchor) {
    const BiasAnchor& anchor = data_->bias_anchors[index];
    const core::Vector6 scale = anchor.sigma.unaryExpr([](double sigma) { return sigma > 0 ? 1 / sigma : 0.0; });
    term.clear(6);
    term.e = scale.cwiseProduct(state.biases[static_cast<std::size_t>(anchor.knot)].gyro_accel - anchor.mean);
    term.add_border(6 * anchor.knot, 6).diagonal() = scale;
  } else if (item.kind == Item::Kind::gravity_prior) {
    Eigen::Matrix2d J;
    term.clear(2);
    term.e = gravity_direction::difference(data_->gravity_start, state.gravity_map, J) / model_->gravity_sigma_rad;
    term.add_border(layout_.gravity, 2) = J / model_->gravity_sigma_rad;
  } else {
    term.clear(1);
    term.e[0] = state.imu_offset_s / model_->imu_offset_sigma_s;
    term.add_border(layout_.offset, 1).setConstant(1 / model_->imu_offset_sigma_s);
  }
}

}  // namespace tarmac::estimators
