#include "core/gp_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/pose_numbers.h"

namespace tarmac::core {
namespace {

constexpr int kPoseNumbers = PoseNumbers::RowsAtCompileTime;

void check_knot(const GpKnot& knot, std::size_t i) {
  if (!se3::all_finite(knot.T_world_body) || !knot.varpi.allFinite() || !knot.dvarpi.allFinite()) {
    throw InputError(fmt::format("knot {} at {} ns is not finite", i, to_ns(knot.t)));
  }
}

void check_spacing(Time before, Time after) {
  if (after - before < kGpMinimumSpacing) {
    throw InputError(
        fmt::format("a knot at {} ns comes {} ns after its predecessor; knots of a Gaussian process must "
                    "ascend by 1 ms or more",
                    to_ns(after), (after - before).count()));
  }
}

}  // namespace

void world_rows(const GpKnot& s, const GpJacobian& body, StateJet& jet) {
  const Eigen::Index columns = body.cols();
  jet.J.resize(state_row::count, columns);
  jet.J.topRows<6>() = body.topRows<6>();
  if (body.rows() < 12) return;
  const Eigen::Matrix3d& R = s.T_world_body.linear();
  const Eigen::Vector3d nu = s.varpi.head<3>(), omega = s.varpi.tail<3>();
  // R nu under R Exp(phi): R (d(nu) - nu x phi... ), with hat(phi) nu = -hat(nu) phi.
  jet.J.middleRows<3>(state_row::velocity) = R * (body.middleRows<3>(6) - so3::hat(nu) * body.middleRows<3>(3));
  jet.J.middleRows<3>(state_row::omega) = body.middleRows<3>(9);
  if (body.rows() < 18) return;
  const Eigen::Vector3d a_body = s.dvarpi.head<3>() + omega.cross(nu);
  jet.J.middleRows<3>(state_row::acceleration) =
      R * (body.middleRows<3>(12) + so3::hat(omega) * body.middleRows<3>(6) - so3::hat(nu) * body.middleRows<3>(9) -
           so3::hat(a_body) * body.middleRows<3>(3));
  jet.J.middleRows<3>(state_row::alpha) = body.middleRows<3>(15);
}

GpTrajectory::GpTrajectory(GpPrior prior, std::vector<GpKnot> knots)
    : prior_(prior), groups_(group_axes(prior)), knots_(std::move(knots)) {
  prior_.check();
  if (knots_.empty()) throw InputError("a Gaussian process needs a knot to begin with");
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    check_knot(knots_[i], i);
    if (i > 0) check_spacing(knots_[i - 1].t, knots_[i].t);
    if (prior_.model == GpModel::wnoa) knots_[i].dvarpi.setZero();
  }
  refresh(0);
}

void GpTrajectory::refresh(std::size_t first) {
  intervals_.erase(intervals_.begin() + static_cast<std::ptrdiff_t>(std::min(first, intervals_.size())),
                   intervals_.end());
  jacobians_.erase(jacobians_.begin() + static_cast<std::ptrdiff_t>(intervals_.size()), jacobians_.end());
  for (std::size_t i = intervals_.size(); i + 1 < knots_.size(); ++i) {
    intervals_.emplace_back(prior_.model, groups_, knots_[i], knots_[i + 1]);
    jacobians_.emplace_back(intervals_.back(), knots_[i + 1]);
  }
}

void GpTrajectory::check_span(Time t) const {
  if (!covers(t)) {
    throw OutOfSpan(
        fmt::format("t = {} ns lies outside the knots' [{}, {}] ns", to_ns(t), to_ns(begin()), to_ns(end())));
  }
}

/// The interval whose first knot is at or before t; blocks() - 1 at the last knot.
std::size_t GpTrajectory::interval_at(Time t) const {
  const auto later =
      std::upper_bound(knots_.begin(), knots_.end(), t, [](Time time, const GpKnot& knot) { return time < knot.t; });
  return static_cast<std::size_t>(later - knots_.begin()) - 1;
}

SE3 GpTrajectory::pose(Time t) const {
  check_span(t);
  const std::size_t i = interval_at(t);
  return t == knots_[i].t ? knots_[i].T_world_body : intervals_[i].pose(since_knot(i, t));
}

void GpTrajectory::poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const {
  if (ascending.empty()) return;
  check_span(ascending.front());
  check_span(ascending.back());
  std::size_t k = interval_at(ascending.front());
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    const Time t = ascending[i];
    if (i > 0 && t == ascending[i - 1]) {
      T_world_body[i] = T_world_body[i - 1];
      continue;
    }
    while (k + 1 < knots_.size() && knots_[k + 1].t <= t) ++k;
    T_world_body[i] = t == knots_[k].t ? knots_[k].T_world_body : intervals_[k].pose(since_knot(k, t));
  }
}

Kinematics GpTrajectory::at(Time t) const {
  check_span(t);
  const std::size_t i = interval_at(t);
  if (t != knots_[i].t) return kinematics(intervals_[i].state(since_knot(i, t)));
  GpKnot knot = knots_[i];
  if (prior_.model == GpModel::wnoa && !intervals_.empty()) {
    const std::size_t k = std::min(i, intervals_.size() - 1);
    knot.dvarpi = intervals_[k].state(since_knot(k, t)).dvarpi;
  }
  return kinematics(knot);
}

void GpTrajectory::jet(Time t, Derivative upto, StateJet& jet) const {
  check_span(t);
  const std::size_t i = interval_at(t);
  const bool knot_alone =
      t == knots_[i].t && (prior_.model != GpModel::wnoa || upto != Derivative::acceleration || intervals_.empty());
  if (knot_alone) {
    jet.first = block_size() * static_cast<int>(i);
    jet.state = kinematics(knots_[i]);
    const int rows = std::min(state_row::filled(upto), block_size());
    GpJacobian J = GpJacobian::Zero(state_row::filled(upto), block_size());
    J.topLeftCorner(rows, rows).setIdentity();
    world_rows(knots_[i], J, jet);
    return;
  }
  const std::size_t k = std::min(i, intervals_.size() - 1);
  const double d = since_knot(k, t);
  jet.first = block_size() * static_cast<int>(k);
  GpKnot s;
  const GpJacobian J = jacobians_[k].state(intervals_[k], d, upto, s);
  jet.state = kinematics(s);
  if (t == knots_[i].t) jet.state = at(t);  // a knot is itself, bit for bit
  if (upto != Derivative::acceleration) jet.state.a_world.setZero();
  world_rows(s, J, jet);
}

StateVector GpTrajectory::rate(Time t, Derivative upto) const {
  check_span(t);
  StateVector out = StateVector::Zero();
  if (intervals_.empty()) {
    out.head<6>() = knots_.front().varpi;
    return out;
  }
  const std::size_t k = std::min(interval_at(t), intervals_.size() - 1);
  const double d = since_knot(k, t);
  const GpKnot s = intervals_[k].state(d);
  const auto [varpi, dvarpi, ddvarpi] = intervals_[k].rate(d);
  const Eigen::Matrix3d& R = s.T_world_body.linear();
  const Eigen::Vector3d nu = varpi.head<3>(), omega = varpi.tail<3>(), dnu = dvarpi.head<3>(),
                        domega = dvarpi.tail<3>();
  out.head<6>() = varpi;
  if (upto == Derivative::pose) return out;
  out.segment<3>(state_row::velocity) = R * (dnu + omega.cross(nu));
  out.segment<3>(state_row::omega) = domega;
  if (upto == Derivative::velocity) return out;
  // d/dt R (a_nu + omega x nu), a_nu the state's own derivative of nu (for wnoa the same as dnu).
  const Eigen::Vector3d a_nu = s.dvarpi.head<3>();
  out.segment<3>(state_row::acceleration) =
      R * (ddvarpi.head<3>() + domega.cross(nu) + omega.cross(dnu) + omega.cross(a_nu + omega.cross(nu)));
  out.segment<3>(state_row::alpha) = ddvarpi.tail<3>();
  return out;
}

void GpTrajectory::retract(const Eigen::Ref<const Eigen::VectorXd>& step) {
  const int size = block_size();
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    const auto d = step.segment(size * static_cast<int>(i), size);
    GpKnot& knot = knots_[i];
    knot.T_world_body = se3::normalized(knot.T_world_body * se3::exp(d.head<6>()));
    knot.varpi += d.segment<6>(6);
    if (size > 12) knot.dvarpi += d.segment<6>(12);
  }
  refresh(0);
}

Eigen::VectorXd GpTrajectory::value(int block) const {
  const GpKnot& knot = knots_[static_cast<std::size_t>(block)];
  Eigen::VectorXd out(kPoseNumbers + block_size() - 6);
  out.head<kPoseNumbers>() = numbers_of(knot.T_world_body);
  out.segment<6>(kPoseNumbers) = knot.varpi;
  if (block_size() > 12) out.tail<6>() = knot.dvarpi;
  return out;
}

/// T = T_base Exp(d): Exp(d) Exp(step) = Exp(d + Jr^-1(d) step).
void GpTrajectory::difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const {
  const int size = block_size();
  if (base.size() != kPoseNumbers + size - 6) throw std::invalid_argument("base is no value of such a block");
  const SE3 T_base = pose_of(base.head<kPoseNumbers>());
  const GpKnot& knot = knots_[static_cast<std::size_t>(block)];
  d.resize(size);
  d.head<6>() = se3::log(T_base.inverse() * knot.T_world_body);
  d.tail(size - 6) = value(block).tail(size - 6) - base.tail(size - 6);
  J.setIdentity(size, size);
  J.topLeftCorner<6, 6>() = se3::right_jacobian_inverse(d.head<6>());
}

void GpTrajectory::prior(int i, PriorJet& jet) const {
  const auto k = static_cast<std::size_t>(i);
  const GpInterval& interval = intervals_.at(k);
  const int n = prior_.order(), size = block_size();
  const Eigen::MatrixXd Phi = prior_.transition(interval.duration_s());
  Eigen::VectorXd gamma_1(size), gamma_2(size);
  for (int j = 0; j < n; ++j) {
    gamma_1.segment<6>(6 * j) = interval.gamma_1()[static_cast<std::size_t>(j)];
    gamma_2.segment<6>(6 * j) = interval.gamma_2()[static_cast<std::size_t>(j)];
  }
  jet.first = size * i;
  jet.e = gamma_2 - Phi * gamma_1;
  jet.J = jacobians_[k].gamma_2();
  // gamma_1's pose entry is 0 whatever T_1 is.
  jet.J.middleCols(6, size - 6) -= Phi.rightCols(size - 6);
  jet.information = prior_.information(interval.duration_s());
}

/// gamma = Phi(d) gamma_1: with it the prior's residual is zero.
GpLocal GpTrajectory::predicted(const GpKnot& from, double d) const {
  const Eigen::MatrixXd Phi = prior_.transition(d);
  Eigen::VectorXd gamma(block_size());
  gamma << Vector6::Zero(), from.varpi, from.dvarpi.head(block_size() - 12);
  gamma = (Phi * gamma).eval();
  GpLocal local;
  local.row.fill(Vector6::Zero());
  for (int j = 0; j < prior_.order(); ++j) local.row[static_cast<std::size_t>(j)] = gamma.segment<6>(6 * j);
  return local;
}

void GpTrajectory::extend(Time begin, Time end, std::span<const Time> knots) {
  if (begin < this->begin() || end < begin) {
    throw InputError(
        fmt::format("cannot grow to [{}, {}] ns: the first knot is at {} ns, and an end must not come before "
                    "its begin",
                    to_ns(begin), to_ns(end), to_ns(this->begin())));
  }
  std::vector<Time> times(knots.begin(), knots.end());
  if ((times.empty() ? this->end() : times.back()) < end) times.push_back(end);
  Time last = this->end();
  for (const Time t : times) {
    check_spacing(last, t);
    last = t;
  }
  const std::size_t first = intervals_.size();
  for (const Time t : times) {
    const GpKnot& from = knots_.back();
    GpKnot knot = state_of(prior_.model, from.T_world_body, predicted(from, to_s(t - from.t)));
    knot.t = t;
    knot.T_world_body = se3::normalized(knot.T_world_body);
    if (prior_.model == GpModel::wnoa) knot.dvarpi.setZero();
    knots_.push_back(knot);
  }
  refresh(first);
}

int GpTrajectory::first_block_at(Time t) const {
  return t < begin() ? 0 : static_cast<int>(interval_at(t));
}

void GpTrajectory::drop(int count) {
  if (count < 0 || count >= blocks()) throw std::invalid_argument("a trajectory keeps one knot at least");
  knots_.erase(knots_.begin(), knots_.begin() + count);
  intervals_.erase(intervals_.begin(), intervals_.begin() + count);
  jacobians_.erase(jacobians_.begin(), jacobians_.begin() + count);
}

GpKnot GpTrajectory::extrapolated(Time t) const {
  if (t < end()) throw OutOfSpan(fmt::format("t = {} ns lies before the last knot at {} ns", to_ns(t), to_ns(end())));
  GpKnot out = t == end()
                   ? knots_.back()
                   : state_of(prior_.model, knots_.back().T_world_body, predicted(knots_.back(), to_s(t - end())));
  out.t = t;
  return out;
}

}  // namespace tarmac::core
