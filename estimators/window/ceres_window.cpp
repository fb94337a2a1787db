#include "estimators/window/ceres_window.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <cmath>
#include <set>

#include "core/symmetric_eigen.h"
#include "estimators/blocks/ceres_loss.h"
#include "estimators/window/gravity_direction.h"

namespace tarmac::estimators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Unknowns in blocks, as increments d from a base, and the state that they make. Residuals know their Jacobians by a
/// further step s of that state: those by d follow by the inverse of dd/ds.
class Increments final : public ceres::EvaluationCallback {
 public:
  Increments(const WindowState& base, const BorderLayout& layout) : base_(base), state_(base), layout_(layout) {
    const int blocks = base.trajectory->blocks(), size = base.trajectory->block_size();
    const auto add = [this](int first, int count) {
      firsts_.push_back(first);
      sizes_.push_back(count);
    };
    for (int b = 0; b < blocks; ++b) {
      add(size * b, size);
      values_.push_back(base.trajectory->value(b));
    }
    const int band = base.trajectory->parameters();
    for (int k = 0; k < layout.biases; ++k) add(band + 6 * k, 6);
    if (layout.gravity >= 0) add(band + layout.gravity, 2);
    if (layout.offset >= 0) add(band + layout.offset, 1);
    d_.setZero(band + layout.size());
    inverses_.resize(firsts_.size());
    update();
  }

  void PrepareForEvaluation(bool, bool new_point) override {
    if (new_point) update();
  }
  void update() {
    state_ = base_;
    finite_ = d_.allFinite();
    if (!finite_) return;
    retract(state_, layout_, d_);
    ++version_;
    VectorXd unused;
    MatrixXd J;
    for (std::size_t b = 0; b < values_.size(); ++b) {
      state_.trajectory->difference(static_cast<int>(b), values_[b], unused, J);
      inverses_[b] = J.inverse();
    }
    for (std::size_t b = values_.size(); b < firsts_.size(); ++b) inverses_[b].setIdentity(sizes_[b], sizes_[b]);
    if (layout_.gravity >= 0) {
      Eigen::Matrix2d by_step;
      gravity_direction::difference(base_.gravity_map, state_.gravity_map, by_step);
      inverses_[values_.size() + static_cast<std::size_t>(layout_.biases)] = by_step.inverse();
    }
  }

  bool finite() const { return finite_; }
  std::uint64_t version() const { return version_; }
  const WindowState& state() const { return state_; }
  std::size_t blocks() const { return firsts_.size(); }
  int first(std::size_t block) const { return firsts_[block]; }
  int size(std::size_t block) const { return sizes_[block]; }
  double* parameters(std::size_t block) { return d_.data() + firsts_[block]; }
  const MatrixXd& step_by_increment(std::size_t block) const { return inverses_[block]; }
  std::size_t block_of(int scalar) const {
    const auto after = std::upper_bound(firsts_.begin(), firsts_.end(), scalar);
    return static_cast<std::size_t>(after - firsts_.begin()) - 1;
  }
  int band() const { return base_.trajectory->parameters(); }

 private:
  const WindowState base_;
  WindowState state_;
  BorderLayout layout_;
  std::vector<int> firsts_, sizes_;
  std::vector<VectorXd> values_;
  VectorXd d_;
  std::vector<MatrixXd> inverses_;
  bool finite_ = true;
  std::uint64_t version_ = 0;
};

/// Residuals of an item or a stamp, kept until another one is asked for: those that share one are asked one after the
/// other.
class Source {
 public:
  Source(const WindowProblem& problem, const Increments& increments) : problem_(problem), increments_(increments) {}
  /// `index`: items, then stamps.
  const std::vector<Term>& terms(std::size_t index) {
    if (index != index_ || version_ != increments_.version()) {
      const std::size_t items = problem_.items().size();
      if (index < items) {
        problem_.terms(increments_.state(), problem_.items()[index], true, terms_);
      } else {
        problem_.lidar_terms(increments_.state(), problem_.stamps()[index - items], terms_);
      }
      index_ = index;
      version_ = increments_.version();
    }
    return terms_;
  }

 private:
  const WindowProblem& problem_;
  const Increments& increments_;
  std::vector<Term> terms_;
  std::size_t index_ = static_cast<std::size_t>(-1);
  std::uint64_t version_ = 0;
};

class TermCost final : public ceres::CostFunction {
 public:
  TermCost(Source& source, const Increments& increments, std::size_t index, std::size_t which, int rows,
           const std::vector<std::size_t>& blocks)
      : source_(source), increments_(increments), index_(index), which_(which), blocks_(blocks) {
    set_num_residuals(rows);
    for (const std::size_t block : blocks) mutable_parameter_block_sizes()->push_back(increments.size(block));
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (!increments_.finite()) return false;
    Eigen::Map<VectorXd> e(residuals, num_residuals());
    e.setZero();
    for (std::size_t b = 0; jacobians != nullptr && b < blocks_.size(); ++b) {
      if (jacobians[b] != nullptr) std::fill_n(jacobians[b], num_residuals() * increments_.size(blocks_[b]), 0.0);
    }
    const std::vector<Term>& terms = source_.terms(index_);
    if (which_ >= terms.size()) return true;  // a reading outside the span
    const Term& term = terms[which_];
    e = term.e;
    if (!e.allFinite()) return false;
    if (jacobians != nullptr) write(term, jacobians);
    return true;
  }

 private:
  void write(const Term& term, double** jacobians) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      const int first = increments_.first(blocks_[b]), size = increments_.size(blocks_[b]);
      MatrixXd by_step = MatrixXd::Zero(num_residuals(), size);
      const auto copy = [&](int column, const auto& J) {  // the columns that fall into this block
        const int low = std::max(first, column),
                  high = std::min<int>(first + size, column + static_cast<int>(J.cols()));
        if (low < high) by_step.middleCols(low - first, high - low) += J.middleCols(low - column, high - low);
      };
      copy(term.first, term.J);
      for (int k = 0; k < term.borders; ++k) {
        const Term::Border& border = term.border[static_cast<std::size_t>(k)];
        copy(increments_.band() + border.column, border.J);
      }
      Eigen::Map<RowMajor>(jacobians[b], num_residuals(), size) = by_step * increments_.step_by_increment(blocks_[b]);
    }
  }

  Source& source_;
  const Increments& increments_;
  std::size_t index_, which_;
  std::vector<std::size_t> blocks_;
};

/// The marginal prior as a square: with H = V D V^T, e = D^1/2 V^T d + D^-1/2 V^T g where D is not zero.
class MarginalCost final : public ceres::CostFunction {
 public:
  MarginalCost(const MarginalPrior& prior, const Increments& increments, const std::vector<int>& scalars,
               const std::vector<std::size_t>& blocks)
      : prior_(prior), increments_(increments), scalars_(scalars), blocks_(blocks) {
    const core::SymmetricEigen eigen(prior.information().H);
    const double least = 1e-15 * eigen.eigenvalues().maxCoeff();
    const auto rank = static_cast<Index>((eigen.eigenvalues().array() > least).count());
    const auto values = eigen.eigenvalues().tail(rank);
    const auto vectors = eigen.eigenvectors().rightCols(rank);
    root_ = values.cwiseSqrt().asDiagonal() * vectors.transpose();
    offset_ = values.cwiseSqrt().cwiseInverse().asDiagonal() * vectors.transpose() * prior.information().g;
    set_num_residuals(static_cast<int>(rank));
    for (const std::size_t block : blocks) mutable_parameter_block_sizes()->push_back(increments.size(block));
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (!increments_.finite()) return false;
    VectorXd d;
    MatrixXd J;
    prior_.difference(increments_.state(), d, J);
    Eigen::Map<VectorXd>(residuals, num_residuals()) = root_ * d + offset_;
    if (jacobians == nullptr) return true;
    const MatrixXd by_step = root_ * J;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      const int first = increments_.first(blocks_[b]), size = increments_.size(blocks_[b]);
      MatrixXd own = MatrixXd::Zero(num_residuals(), size);
      for (std::size_t i = 0; i < scalars_.size(); ++i) {
        const int column = scalars_[i] - first;
        if (column >= 0 && column < size) own.col(column) = by_step.col(static_cast<Index>(i));
      }
      Eigen::Map<RowMajor>(jacobians[b], num_residuals(), size) = own * increments_.step_by_increment(blocks_[b]);
    }
    return true;
  }

 private:
  const MarginalPrior& prior_;
  const Increments& increments_;
  std::vector<int> scalars_;
  std::vector<std::size_t> blocks_;
  MatrixXd root_;
  VectorXd offset_;
};

/// Blocks that a term looks at; with a margin where a free offset may move it to the neighbours.
std::vector<std::size_t> blocks_of(const Term& term, const Increments& increments, bool margin) {
  std::set<std::size_t> blocks;
  if (term.J.cols() > 0) {
    const std::size_t last_of_band = increments.block_of(increments.band() - 1);
    std::size_t low = increments.block_of(term.first);
    std::size_t high = increments.block_of(term.first + static_cast<int>(term.J.cols()) - 1);
    if (margin && low > 0) --low;
    if (margin && high < last_of_band) ++high;
    for (std::size_t b = low; b <= high; ++b) blocks.insert(b);
  }
  for (int k = 0; k < term.borders; ++k)
    blocks.insert(increments.block_of(increments.band() + term.border[static_cast<std::size_t>(k)].column));
  return {blocks.begin(), blocks.end()};
}

void add_terms(const WindowProblem& problem, Increments& increments, Source& source, ceres::LossFunction* accel_loss,
               ceres::LossFunction* lidar_loss, ceres::Problem& out) {
  const std::size_t items = problem.items().size();
  for (std::size_t index = 0; index < items + problem.stamps().size(); ++index) {
    const std::vector<Term>& terms = source.terms(index);
    for (std::size_t which = 0; which < terms.size(); ++which) {
      const Term& term = terms[which];
      const bool reading = index < items && problem.items()[index].kind == WindowProblem::Item::Kind::reading;
      const auto blocks = blocks_of(term, increments, reading && problem.layout().offset >= 0);
      std::vector<double*> parameters;
      for (const std::size_t block : blocks) parameters.push_back(increments.parameters(block));
      ceres::LossFunction* loss = nullptr;
      if (term.loss != nullptr && term.loss->kind != Loss::standard) loss = index < items ? accel_loss : lidar_loss;
      out.AddResidualBlock(new TermCost(source, increments, index, which, static_cast<int>(term.e.size()), blocks),
                           loss, parameters);
    }
  }
}

void add_marginal_prior(const WindowProblem& problem, Increments& increments, ceres::Problem& out) {
  const MarginalPrior& prior = problem.prior();
  if (prior.empty()) return;
  std::vector<int> scalars;
  const int band = prior.blocks() * increments.state().trajectory->block_size();
  for (int i = 0; i < band; ++i) scalars.push_back(i);
  for (const int column : prior.border_columns(problem.layout())) scalars.push_back(increments.band() + column);
  std::set<std::size_t> unique;
  for (const int scalar : scalars) unique.insert(increments.block_of(scalar));
  const std::vector<std::size_t> blocks(unique.begin(), unique.end());
  std::vector<double*> parameters;
  for (const std::size_t block : blocks) parameters.push_back(increments.parameters(block));
  out.AddResidualBlock(new MarginalCost(prior, increments, scalars, blocks), nullptr, parameters);
}

ceres::Solver::Options solver_options(const SolveSettings& settings, CeresDamping damping) {
  ceres::Solver::Options options;
  options.max_num_iterations = settings.max_iterations;
  options.max_solver_time_in_seconds = 1e9;
  options.num_threads = 1;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = settings.relative_decrease;
  options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.initial_trust_region_radius = 1 / settings.initial_lambda;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  for (const auto library : {ceres::SUITE_SPARSE, ceres::EIGEN_SPARSE}) {
    if (!ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) continue;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = library;
    break;
  }
  if (damping == CeresDamping::identity) {
    options.jacobi_scaling = false;
    options.min_lm_diagonal = options.max_lm_diagonal = 1;
  }
  return options;
}

}  // namespace

SolveReport solve_with_ceres(Window& window, const SolveSettings& settings, CeresDamping damping) {
  check(window.model(), window.trajectory());
  if (window.model().sum_stamp_residuals) throw std::invalid_argument("Ceres has no step of summed residuals");
  WindowProblem problem = window.problem();
  if (!settings.lidar)
    problem.keep([](const auto&) { return true; }, [](const WindowProblem::Stamp&) { return false; });
  Increments increments(window.state(), problem.layout());
  Source source(problem, increments);
  const auto accel_loss = ceres_loss(window.model().accel_loss), lidar_loss = ceres_loss(window.model().lidar_loss);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.evaluation_callback = &increments;
  ceres::Problem ceres_problem(problem_options);
  for (std::size_t b = 0; b < increments.blocks(); ++b)
    ceres_problem.AddParameterBlock(increments.parameters(b), increments.size(b));
  add_terms(problem, increments, source, accel_loss.get(), lidar_loss.get(), ceres_problem);
  add_marginal_prior(problem, increments, ceres_problem);

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(settings, damping), &ceres_problem, &summary);
  increments.update();
  SolveReport report;
  report.iterations = static_cast<int>(summary.iterations.size()) - 1;
  report.initial_cost = summary.initial_cost;
  report.ok = summary.IsSolutionUsable() && increments.finite();
  report.final_cost = report.ok ? summary.final_cost : report.initial_cost;
  if (report.ok) window.state() = increments.state();
  report.left_out = problem.left_out(window.state());
  report.uncovered = problem.uncovered();
  return report;
}

}  // namespace tarmac::estimators
