#include <ceres/ceres.h>

#include <stdexcept>

#include "estimators/blocks/ceres_loss.h"
#include "estimators/blocks/point_to_plane.h"
#include "estimators/ct_icp/elastic_problem.h"

namespace tarmac::estimators {
namespace {

using core::Row6;
using core::SE3;
using core::Vector6;
using RowMajor76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;

/// A pose as Ceres keeps it: quaternion x y z w, then translation.
constexpr int kPoseSize = 7;

void store(const SE3& T, double* x) {
  const Eigen::Vector4d q = core::se3::quat_xyzw(T);
  for (int k = 0; k < 4; ++k) x[k] = q[k];
  for (int k = 0; k < 3; ++k) x[4 + k] = T.translation()[k];
}

SE3 load(const double* x) {
  SE3 T = SE3::Identity();
  T.linear() = Eigen::Quaterniond(x[3], x[0], x[1], x[2]).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(x + 4);
  return T;
}

/// T <- T Exp(xi). Ceres multiplies a cost's Jacobian by the seven stored numbers with the derivative of Plus. Here
/// costs give their Jacobian by xi at once, in the first six of seven columns, and that derivative is [I; 0]: the
/// product is right, and neither factor is used by itself.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    store(load(x) * core::se3::exp(Eigen::Map<const Vector6>(delta)), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<RowMajor76>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6> out(y_minus_x);
    out = core::se3::log(load(x).inverse() * load(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

/// The parameters that Ceres moves, and the motion that they stand for.
class MotionState final : public ceres::EvaluationCallback {
 public:
  explicit MotionState(const core::Segment& motion) : motion_(motion), x_(kPoseSize * motion.poses.size()) {
    for (std::size_t b = 0; b < motion.poses.size(); ++b) store(motion.poses[b], parameters(b));
    update();
  }
  void PrepareForEvaluation(bool, bool new_evaluation_point) override {
    if (new_evaluation_point) update();
  }
  double* parameters(std::size_t block) { return x_.data() + kPoseSize * block; }
  std::size_t blocks() const { return motion_.poses.size(); }
  const core::Segment& motion() const { return motion_; }
  const SegmentSampler& sampler() const { return sampler_; }
  void update() {
    for (std::size_t b = 0; b < blocks(); ++b) motion_.poses[b] = load(parameters(b));
    sampler_ = SegmentSampler(motion_);
  }

 private:
  core::Segment motion_;
  std::vector<double> x_;
  SegmentSampler sampler_;
};

void write_jacobian(double* out, double factor, const Row6& row) {
  if (out == nullptr) return;
  Eigen::Map<Row6> six(out);
  six = factor * row;
  out[6] = 0;
}

class DataCost final : public ceres::CostFunction {
 public:
  DataCost(const MotionState& state, const Keypoint& keypoint, const Association& association)
      : state_(state), keypoint_(keypoint), association_(association) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(state.blocks(), kPoseSize);
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const PointToPlane plane{keypoint_.p_body, association_.q_map, association_.n_map};
    if (jacobians == nullptr) {
      residuals[0] = association_.weight * plane(state_.sampler().pose(keypoint_.alpha));
      return true;
    }
    std::array<core::BlockJacobian, 2> chain;
    Row6 J;
    residuals[0] = association_.weight * plane(state_.sampler().pose(keypoint_.alpha, chain), J);
    for (std::size_t b = 0; b < state_.blocks(); ++b) {
      write_jacobian(jacobians[b], association_.weight, J * chain[b].jacobian);
    }
    return true;
  }

 private:
  const MotionState& state_;
  const Keypoint& keypoint_;
  const Association& association_;
};

class PriorCost final : public ceres::CostFunction {
 public:
  PriorCost(const MotionState& state, const Regularisers& regularisers, int residuals, int rows)
      : state_(state), regularisers_(regularisers), residuals_(residuals) {
    set_num_residuals(rows);
    mutable_parameter_block_sizes()->assign(2, kPoseSize);
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const std::vector<PriorRow> rows = prior_rows(regularisers_, residuals_, state_.motion());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double root = std::sqrt(rows[i].weight);
      residuals[i] = root * rows[i].value;
      if (jacobians == nullptr) continue;
      if (jacobians[0] != nullptr) write_jacobian(jacobians[0] + kPoseSize * i, root, rows[i].by_begin);
      if (jacobians[1] != nullptr) write_jacobian(jacobians[1] + kPoseSize * i, root, rows[i].by_end);
    }
    return true;
  }

 private:
  const MotionState& state_;
  const Regularisers& regularisers_;
  int residuals_;
};

ceres::Problem::Options problem_options(MotionState& state) {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &state;
  return options;
}

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.max_solver_time_in_seconds = 1e9;
  options.num_threads = 1;
  options.linear_solver_type = ceres::DENSE_QR;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.logging_type = ceres::SILENT;
  // Costs end within 1e-6 of each other much earlier than poses do.
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  return options;
}

void add_data(const ElasticProblem& problem, MotionState& state, ceres::LossFunction* loss, ceres::Problem& out) {
  std::vector<double*> parameters;
  for (std::size_t b = 0; b < state.blocks(); ++b) parameters.push_back(state.parameters(b));
  for (std::size_t k = 0; k < problem.keypoints.size(); ++k) {
    if (!problem.associations[k].used) continue;
    out.AddResidualBlock(new DataCost(state, problem.keypoints[k], problem.associations[k]), loss, parameters);
  }
}

}  // namespace

bool solve_with_ceres(const ElasticProblem& problem, int max_iterations, core::Segment& motion) {
  if (problem.regularisers != nullptr && problem.regularisers->quirk) {
    throw std::invalid_argument("the quirk's regularisers have no cost that Ceres could lower");
  }
  MotionState state(motion);
  const auto loss = ceres_loss(problem.loss);
  ceres::Problem ceres_problem(problem_options(state));
  for (std::size_t b = 0; b < state.blocks(); ++b) {
    ceres_problem.AddParameterBlock(state.parameters(b), kPoseSize, new PoseManifold);
  }
  add_data(problem, state, problem.loss.kind == Loss::standard ? nullptr : loss.get(), ceres_problem);
  const int residuals = ceres_problem.NumResiduals();
  if (problem.regularisers != nullptr && state.blocks() == 2) {
    const auto rows = static_cast<int>(prior_rows(*problem.regularisers, residuals, motion).size());
    if (rows > 0) {
      ceres_problem.AddResidualBlock(new PriorCost(state, *problem.regularisers, residuals, rows), nullptr,
                                     state.parameters(0), state.parameters(1));
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(max_iterations), &ceres_problem, &summary);
  state.update();
  for (const SE3& T : state.motion().poses) {
    if (!summary.IsSolutionUsable() || !core::se3::all_finite(T)) return false;
  }
  motion.poses = state.motion().poses;
  return true;
}

}  // namespace tarmac::estimators
