// Every residual of a window against numeric differentiation, by every unknown.
#include <gtest/gtest.h>

#include "estimators/window/breaks.h"
#include "estimators/window/point_to_distribution.h"
#include "estimators/window/smoothness_residual.h"
#include "tests/estimators/lively_window.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::Duration;
using core::Time;
using core::Vector6;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Item = WindowProblem::Item;

/// Deviations of about one, so that entries are of moderate size; every term that there is.
WindowModel whole_model() {
  WindowModel model;
  model.T_body_imu = lively_mounting();
  model.gyro_sigma_rad_s = 0.7;
  model.accel_sigma_m_s2 = 1.3;
  model.gyro_walk_rad_s2_rthz = 0.5;
  model.accel_walk_m_s3_rthz = 0.6;
  model.free_gravity = model.free_imu_offset = true;
  model.gravity_sigma_rad = 0.5;
  model.imu_offset_sigma_s = 0.3;
  model.smoothness_translation = 2;
  model.smoothness_rotation = 3;
  model.lidar_sigma_m = 0.5;
  return model;
}

/// A state away from all that it is told, so that no residual is zero.
Window whole_window(WindowModel model, Lively kind) {
  WindowState state;
  state.trajectory = lively(kind, 8, 1);
  for (const int ms : {-20, 130, 260})
    state.biases.push_back({kLivelyBegin + std::chrono::milliseconds(ms), Vector6::LinSpaced(6, -0.2, 0.001 * ms)});
  state.gravity_map = Vector3d(0.2, -0.1, -0.9).normalized();
  Window window(model, std::move(state));
  window.state().gravity_map = Vector3d(-0.1, 0.2, -1).normalized();
  window.state().imu_offset_s = 0.003'000'000'4;
  const auto truth = lively(kind, 8, 2);
  const Time end = truth->end();
  for (Time t = kLivelyBegin + Duration(5'000'017); t < end - Duration(5'000'000); t += Duration(10'000'000))
    window.add(ideal_reading(*truth, t, 0, model.T_body_imu, Vector3d(0, 0, -9.8), Vector6::Constant(0.1)));
  window.set_lidar(0, lively_factors(*truth, kLivelyBegin, end, 7, 3, 0.1, false, 1));
  window.set_lidar(1, lively_factors(*truth, kLivelyBegin, end, 7, 2, 0.1, true, 2));
  core::StateVector sigma = core::StateVector::LinSpaced(0.5, 1.5);
  sigma[4] = sigma[10] = 0;
  window.add_anchor(kLivelyBegin + Duration(123'456'789), truth->at(kLivelyBegin + Duration(100'000'000)), sigma);
  Vector6 bias_sigma = Vector6::LinSpaced(0.5, 1.5);
  bias_sigma[2] = 0;
  window.add_bias_anchor(1, Vector6::Ones(), bias_sigma);
  return window;
}

VectorXd stacked(const std::vector<Term>& terms) {
  VectorXd e(0);
  for (const Term& term : terms) {
    VectorXd longer(e.size() + term.e.size());
    longer << e, term.e;
    e = longer;
  }
  return e;
}

MatrixXd stacked_jacobian(const std::vector<Term>& terms, int band, int unknowns) {
  MatrixXd J = MatrixXd::Zero(stacked(terms).size(), unknowns);
  Eigen::Index at = 0;
  for (const Term& term : terms) {
    J.block(at, term.first, term.e.size(), term.J.cols()) = term.J;
    for (int b = 0; b < term.borders; ++b) {
      const Term::Border& border = term.border[static_cast<std::size_t>(b)];
      J.block(at, band + border.column, term.e.size(), border.J.cols()) += border.J;
    }
    at += term.e.size();
  }
  return J;
}

/// Residuals as a function of the state, against their Jacobian, by every unknown; a column's step is its own.
template <class Residuals>
void expect_exact(const Window& window, const WindowProblem& problem, const Residuals& residuals, double tolerance,
                  const std::string& what) {
  const int band = window.trajectory().parameters(), unknowns = band + problem.layout().size();
  const std::vector<Term> terms = residuals(window.state(), true);
  ASSERT_FALSE(terms.empty()) << what;
  const MatrixXd J = stacked_jacobian(terms, band, unknowns);
  EXPECT_LT((stacked(residuals(window.state(), false)) - stacked(terms)).norm(), 1e-9) << what;
  MatrixXd numeric = MatrixXd::Zero(J.rows(), J.cols());
  for (int j = 0; j < unknowns; ++j) {
    const double h = 1e-5;
    VectorXd step = VectorXd::Zero(unknowns);
    WindowState high(window.state()), low(window.state());
    step[j] = h;
    retract(high, problem.layout(), step);
    step[j] = -h;
    retract(low, problem.layout(), step);
    numeric.col(j) = (stacked(residuals(high, false)) - stacked(residuals(low, false))) / (2 * h);
  }
  for (int j = 0; j < unknowns; ++j) {
    EXPECT_LT((J.col(j) - numeric.col(j)).norm(), tolerance * std::max(1.0, J.norm()))
        << what << ", unknown " << j << " of " << band << " + " << unknowns - band << "\n"
        << J.col(j).transpose() << "\n"
        << numeric.col(j).transpose();
  }
}

class EveryTerm : public testing::TestWithParam<Lively> {};

TEST_P(EveryTerm, HasAnExactJacobian) {
  for (const bool omit_transport : {false, true}) {
    WindowModel model = whole_model();
    model.omit_transport = omit_transport;
    const Window window = whole_window(model, GetParam());
    const WindowProblem problem = window.problem();
    std::map<Item::Kind, int> seen;
    for (const Item& item : problem.items()) {
      // Of many alike some: readings in every interval and bias stretch.
      if (seen[item.kind]++ % (item.kind == Item::Kind::reading ? 7 : 1) != 0) continue;
      const auto residuals = [&](const WindowState& state, bool jacobians) {
        std::vector<Term> terms;
        problem.terms(state, item, jacobians, terms);
        return terms;
      };
      expect_exact(window, problem, residuals, 1e-6, "kind " + std::to_string(static_cast<int>(item.kind)));
    }
    const bool has_prior = window.trajectory().priors() > 0;
    EXPECT_EQ(seen.size(), has_prior ? 8U : 7U) << "all but increments, and priors where the model has them";
  }
}

TEST_P(EveryTerm, OfTheLidarHasAnExactJacobian) {
  const Window window = whole_window(whole_model(), GetParam());
  const WindowProblem problem = window.problem();
  ASSERT_EQ(problem.stamps().size(), 14U);
  for (const WindowProblem::Stamp& stamp : problem.stamps()) {
    const auto residuals = [&](const WindowState& state, bool) {
      std::vector<Term> terms;
      problem.lidar_terms(state, stamp, terms);
      return terms;
    };
    expect_exact(window, problem, residuals, 1e-6, "lidar");
  }
}

/// Samples are asked for at whole nanoseconds, which a step of 1e-5 s sees.
TEST_P(EveryTerm, OfVelocityIncrementsHasAnExactJacobian) {
  for (const bool omit_transport : {false, true}) {
    WindowModel model = whole_model();
    model.accel_as_increments = true;
    model.omit_transport = omit_transport;
    model.smoothness_translation = model.smoothness_rotation = 0;
    const Window window = whole_window(model, GetParam());
    const WindowProblem problem = window.problem();
    int increments = 0;
    for (const Item& item : problem.items()) {
      if (item.kind != Item::Kind::increment) continue;
      std::vector<Term> terms;
      problem.terms(window.state(), item, true, terms);
      if (terms.empty()) continue;  // beyond the last reading
      ++increments;
      const auto residuals = [&](const WindowState& state, bool) {
        std::vector<Term> of_state;
        problem.terms(state, item, true, of_state);
        return of_state;
      };
      expect_exact(window, problem, residuals, 2e-4, "increment");
    }
    EXPECT_GE(increments, 3);
  }
}

TEST_P(EveryTerm, AddsUpToTheGradientOfTheCost) {
  for (const Loss loss : {Loss::standard, Loss::cauchy, Loss::geman_mcclure}) {  // those without a kink
    WindowModel model = whole_model();
    model.lidar_loss = model.accel_loss = {loss, 0.8, 0};
    const Window window = whole_window(model, GetParam());
    const WindowProblem problem = window.problem();
    const VectorXd g = window.normal_equations().g();
    const auto cost_at = [&](int j, double move) {
      WindowState state(window.state());
      retract(state, problem.layout(), move * VectorXd::Unit(g.size(), j));
      return problem.cost(state, true);
    };
    for (int j = 0; j < g.size(); ++j) {
      // Of fourth order: accelerations turn a metre into hundreds, and robust losses bend within one.
      const double h = 2e-5;
      const double numeric =
          (8 * (cost_at(j, h) - cost_at(j, -h)) - (cost_at(j, 2 * h) - cost_at(j, -2 * h))) / (12 * h);
      EXPECT_NEAR(g[j], numeric, 1e-6 * g.cwiseAbs().maxCoeff()) << j;
    }
    EXPECT_EQ(problem.cost(window.state(), true), window.cost());
  }
}

TEST_P(EveryTerm, LidarSumsAreThoseOfTheSingleResiduals) {
  WindowModel model = whole_model();
  model.lidar_loss = {Loss::cauchy, 0.8, 0};
  const Window window = whole_window(model, GetParam());
  const WindowProblem problem = window.problem();
  BandedSystem lidar = problem.system(window.state());
  problem.assemble(window.state(), &lidar, nullptr);
  const int band = lidar.band();
  MatrixXd H = MatrixXd::Zero(lidar.size(), lidar.size());
  double cost = 0;
  for (const WindowProblem::Stamp& stamp : problem.stamps()) {
    std::vector<Term> terms;
    problem.lidar_terms(window.state(), stamp, terms);
    for (const Term& term : terms) {
      const MatrixXd J = stacked_jacobian({term}, band, lidar.size());
      H += term.rho().first * J.transpose() * J;
      cost += term.rho().rho / 2;
    }
  }
  EXPECT_LT((lidar.dense() - H).norm(), 1e-12 * H.norm());
  EXPECT_NEAR(cost, window.cost() - problem.cost(window.state(), false), 1e-12 * window.cost());
}

INSTANTIATE_TEST_SUITE_P(Models, EveryTerm,
                         testing::Values(Lively::spline_split, Lively::spline_se3, Lively::spline_split_6,
                                         Lively::gp_wnoa, Lively::gp_wnoj, Lively::gp_singer));

TEST(Breaks, AreTheKnotsWithinTheSpan) {
  for (const Lively kind : {Lively::spline_split, Lively::spline_se3, Lively::gp_wnoa}) {
    const auto trajectory = lively(kind, 9, 1);
    const std::vector<Time> found = breaks(*trajectory);
    const int intervals = trajectory->blocks() - trajectory->reach() + 1;
    ASSERT_EQ(found.size(), static_cast<std::size_t>(intervals) + 1);
    for (int i = 0; i < intervals; ++i)
      EXPECT_EQ(found[static_cast<std::size_t>(i)], kLivelyBegin + i * std::chrono::milliseconds(100));
    EXPECT_EQ(found.back(), trajectory->end());
  }
}

TEST(Smoothness, TwoSamplesIntegrateAnAccelerationThatRunsLinearly) {
  const auto acceleration = [](double u) { return Vector3d(1 - 3 * u, 2 * u, 0.5 + u); };
  double exact = 0;
  for (int i = 0; i < 100000; ++i) exact += acceleration((i + 0.5) / 100000).squaredNorm() / 100000;
  for (const int samples : {2, 3}) {
    double sum = 0;
    for (const QuadratureNode& node : quadrature(samples)) {
      core::Kinematics state;
      state.a_world = acceleration(node.place);
      sum += SmoothnessResidual{4, 0, 0.1 * node.share}(state).squaredNorm();
    }
    EXPECT_NEAR(sum, 0.1 * exact / 4, 1e-10);
  }
  EXPECT_THROW(quadrature(4), std::invalid_argument);
}

TEST(PointToDistribution, JacobianMatchesCentralDifferences) {
  const core::SE3 T = lively_mounting();
  PointToDistribution r;
  r.p_body = Vector3d(10, -20, 3);
  r.q_map = Vector3d(1, 2, 3);
  r.sqrt_information << 1, 0.2, 0.1, 0, 0.8, -0.3, 0, 0, 2;
  Eigen::Matrix<double, 3, 6> J;
  EXPECT_EQ(r(T, J), r(T));
  const auto moved_residual = [&](const Vector6& d) { return r(T * core::se3::exp(d)); };
  const auto numeric = tests::numeric_jacobian<3, 6>(moved_residual, Vector6(Vector6::Zero()));
  EXPECT_LT(tests::relative_difference(J, numeric), 1e-6);
}

}  // namespace
}  // namespace tarmac::estimators
