#include "core/spline_fit.h"

#include <fmt/format.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tarmac::core {
namespace {

/// Normal equations of neighbouring blocks: for each interval, a dense square over its control points.
class NormalEquations {
 public:
  NormalEquations(int blocks, int order)
      : columns_(6 * order),
        squares_(static_cast<std::size_t>(blocks - order + 1)),
        g_(Eigen::VectorXd::Zero(6 * blocks)) {
    for (auto& square : squares_) square = Eigen::MatrixXd::Zero(columns_, columns_);
  }

  template <class Jacobian, class Residual>
  void add(int first, const Jacobian& J, const Residual& e, double weight) {
    squares_[static_cast<std::size_t>(first / 6)].noalias() += weight * J.transpose() * J;
    g_.segment(first, columns_).noalias() += weight * J.transpose() * e;
  }

  /// -H^-1 g; empty where H is not positive definite to working precision.
  Eigen::VectorXd step() const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(squares_.size() * static_cast<std::size_t>(columns_ * columns_));
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      const int first = 6 * static_cast<int>(i);
      for (int c = 0; c < columns_; ++c) {
        for (int r = c; r < columns_; ++r) entries.emplace_back(first + r, first + c, squares_[i](r, c));
      }
    }
    Eigen::SparseMatrix<double> H(g_.size(), g_.size());
    H.setFromTriplets(entries.begin(), entries.end());
    // In order of time as it stands: the band has no better one.
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> ldlt(H);
    if (ldlt.info() != Eigen::Success) return {};
    const Eigen::VectorXd D = ldlt.vectorD();
    if (!(D.minCoeff() > 1e-14 * D.maxCoeff())) return {};
    return -ldlt.solve(g_);
  }

 private:
  int columns_;
  std::vector<Eigen::MatrixXd> squares_;
  Eigen::VectorXd g_;
};

/// (p difference in the measured axes, Log(R_measured^T R)), with its Jacobian.
void add_pose(const SplineTrajectory& spline, Time t, const SE3& measured, StateJet& jet, NormalEquations& equations) {
  spline.jet(t, Derivative::pose, jet);
  const Eigen::Matrix3d R = measured.linear().transpose() * jet.state.T_world_body.linear();
  Vector6 e;
  e << measured.linear().transpose() * (jet.state.T_world_body.translation() - measured.translation()), so3::log(R);
  Eigen::MatrixXd J(6, jet.columns());
  J.topRows<3>() = R * jet.J.middleRows<3>(state_row::pose);
  J.bottomRows<3>() = so3::right_jacobian_inverse(e.tail<3>()) * jet.J.middleRows<3>(state_row::pose + 3);
  equations.add(jet.first, J, e, 1);
}

/// Gauss-Legendre quadrature with four nodes an interval: exact for |a|^2 of split splines, a polynomial of degree
/// 2 (order - 3).
void add_smoothness(const SplineTrajectory& spline, double weight, StateJet& jet, NormalEquations& equations) {
  static constexpr double kNode[] = {0.33998104358485626, 0.8611363115940526};
  static constexpr double kWeight[] = {0.6521451548625461, 0.34785484513745385};
  const auto& knots = spline.knots();
  const auto k = static_cast<std::size_t>(spline.order());
  for (std::size_t i = k - 1; i < spline.control_points().size(); ++i) {
    const Duration width = knots[i + 1] - knots[i];
    for (const int n : {0, 1}) {
      for (const double side : {-1.0, 1.0}) {
        const double u = 0.5 + 0.5 * side * kNode[n];
        const Time t = std::min(knots[i] + Duration(std::llround(u * static_cast<double>(width.count()))),
                                knots[i + 1] - Duration(1));
        spline.jet(t, Derivative::acceleration, jet);
        Vector6 e;
        e << jet.state.a_world, jet.state.alpha_body;
        equations.add(jet.first, jet.J.middleRows<6>(state_row::acceleration), e,
                      weight * 0.5 * kWeight[n] * to_s(width));
      }
    }
  }
}

void check(std::span<const Time> times, std::span<const SE3> poses, const SplineTrajectory& spline) {
  if (times.empty() || times.size() != poses.size()) {
    throw InputError(
        fmt::format("a spline is fitted to as many poses as times, at least one; there are {} poses and {} "
                    "times",
                    poses.size(), times.size()));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0 && times[i] <= times[i - 1]) {
      throw InputError(fmt::format("pose {} at {} ns does not come after the one before at {} ns", i, to_ns(times[i]),
                                   to_ns(times[i - 1])));
    }
    if (!spline.covers(times[i])) {
      throw InputError(fmt::format("pose {} at {} ns lies outside the knots' span [{}, {}] ns", i, to_ns(times[i]),
                                   to_ns(spline.begin()), to_ns(spline.end())));
    }
    if (!se3::all_finite(poses[i])) throw InputError(fmt::format("pose {} is not finite", i));
  }
}

/// Control points on the sampled motion itself, at the times about which they act.
std::vector<SE3> start_at(int order, const std::vector<Time>& knots, std::span<const Time> times,
                          std::span<const SE3> poses) {
  const Segment sampled =
      Segment::sampled(SegmentModel::sampled_slerp, {times.begin(), times.end()}, {poses.begin(), poses.end()});
  std::vector<SE3> control;
  for (int i = 0; i + order < static_cast<int>(knots.size()); ++i) {
    const double after_ns = greville_ns_after(knots.front(), knots, order, i);
    const Time t = knots.front() + Duration(std::llround(after_ns));
    control.push_back(sampled.pose(std::clamp(t, times.front(), times.back())));
  }
  return control;
}

}  // namespace

SplineTrajectory fit_spline(SplineKind kind, int order, std::vector<Time> knots, std::span<const Time> times,
                            std::span<const SE3> T_world_body, const SplineFitSettings& settings) {
  check(times, T_world_body, SplineTrajectory::at_rest(kind, order, SE3::Identity(), knots));
  SplineTrajectory spline(kind, order, start_at(order, knots, times, T_world_body), knots);
  StateJet jet;
  for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
    NormalEquations equations(spline.blocks(), order);
    for (std::size_t i = 0; i < times.size(); ++i) add_pose(spline, times[i], T_world_body[i], jet, equations);
    if (settings.smoothness > 0) add_smoothness(spline, settings.smoothness, jet, equations);
    const Eigen::VectorXd step = equations.step();
    if (step.size() == 0 || !step.allFinite()) {
      throw InputError(
          fmt::format("{} poses do not determine {} control points: take more poses, fewer knots, or a "
                      "smoothness above {}",
                      times.size(), spline.blocks(), settings.smoothness));
    }
    spline.retract(step);
    if (step.cwiseAbs().maxCoeff() < settings.tolerance) break;
  }
  return spline;
}

}  // namespace tarmac::core
