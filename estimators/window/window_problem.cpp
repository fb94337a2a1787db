#include "estimators/window/window_problem.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <limits>

#include "estimators/window/breaks.h"
#include "estimators/window/smoothness_residual.h"

namespace tarmac::estimators {
namespace {

/// Residuals of one chunk are summed in their order, chunks in theirs: the sum does not depend on threads.
constexpr std::size_t kChunk = 64;
/// Further than this outside the span a reading is not left out but ends the step: an offset does not move that far.
constexpr core::Duration kMostOutside{20'000'000};

std::size_t chunks(std::size_t n) {
  return (n + kChunk - 1) / kChunk;
}

template <class Body>
void for_each_chunk(std::size_t n, const Body& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks(n), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk)
          body(chunk, kChunk * chunk, std::min(n, kChunk * (chunk + 1)));
      },
      tbb::simple_partitioner());
}

double sum_in_order(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

core::Duration outside(const core::Trajectory& trajectory, core::Time t) {
  return std::max(trajectory.begin() - t, t - trajectory.end());
}

}  // namespace

WindowProblem::WindowProblem(const WindowModel& model, const WindowData& data, const WindowState& state)
    : model_(&model), data_(&data), layout_(state, model.free_gravity, model.free_imu_offset) {
  list_readings(state);
  list_between_knots(state);
  list_priors(state);
  list_lidar(state);
}

void WindowProblem::list_readings(const WindowState& state) {
  const bool accelerometer = model_->accel_sigma_m_s2 > 0 && !model_->accel_as_increments;
  if (!(model_->gyro_sigma_rad_s > 0) && !accelerometer) return;
  const core::Duration offset = core::duration_from_s(state.imu_offset_s);
  for (std::size_t i = data_->spent; i < data_->readings.size(); ++i) {
    const core::Time t = data_->readings[i].t - offset;
    if (state.trajectory->covers(t)) items_.push_back({Item::Kind::reading, static_cast<int>(i), t, 0});
  }
}

void WindowProblem::list_between_knots(const WindowState& state) {
  const bool increments = model_->accel_as_increments && model_->accel_sigma_m_s2 > 0;
  const bool smoothness = model_->smoothness_translation > 0 || model_->smoothness_rotation > 0;
  if (!increments && !smoothness) return;
  breaks_ = breaks(*state.trajectory);
  for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
    if (increments) items_.push_back({Item::Kind::increment, static_cast<int>(i), breaks_[i], 0});
    if (!smoothness) continue;
    const core::Duration length = breaks_[i + 1] - breaks_[i];
    for (const QuadratureNode& node : quadrature(model_->smoothness_samples)) {
      const core::Time t = breaks_[i] + core::duration_from_s(node.place * core::to_s(length));
      if (!state.trajectory->covers(t)) continue;
      items_.push_back({Item::Kind::smoothness, static_cast<int>(i), t, node.share * core::to_s(length)});
    }
  }
}

void WindowProblem::list_priors(const WindowState& state) {
  const auto list = [this](Item::Kind kind, int n) {
    for (int i = 0; i < n; ++i) items_.push_back({kind, i, core::Time(), 0});
  };
  for (std::size_t i = 0; i < data_->anchors.size(); ++i) {
    const core::Time t = data_->anchors[i].t;
    if (state.trajectory->covers(t)) {
      items_.push_back({Item::Kind::anchor, static_cast<int>(i), t, 0});
    } else {
      ++uncovered_;
    }
  }
  list(Item::Kind::model_prior, state.trajectory->priors());
  if (model_->gyro_walk_rad_s2_rthz > 0 || model_->accel_walk_m_s3_rthz > 0)
    list(Item::Kind::bias_walk, layout_.biases - 1);
  list(Item::Kind::bias_anchor, static_cast<int>(data_->bias_anchors.size()));
  if (layout_.gravity >= 0 && model_->gravity_sigma_rad > 0) list(Item::Kind::gravity_prior, 1);
  if (layout_.offset >= 0 && model_->imu_offset_sigma_s > 0) list(Item::Kind::offset_prior, 1);
}

void WindowProblem::list_lidar(const WindowState& state) {
  for (const auto& [sweep, factors] : data_->lidar) {
    for (std::size_t i = 0; i < factors.stamps.size(); ++i) {
      if (state.trajectory->covers(factors.stamps[i])) {
        stamps_.push_back({&factors, i, factors.stamps[i]});
      } else {
        ++uncovered_;
      }
    }
  }
}

void WindowProblem::keep(const std::function<bool(const Item&)>& item, const std::function<bool(const Stamp&)>& stamp) {
  std::erase_if(items_, [&](const Item& i) { return !item(i); });
  std::erase_if(stamps_, [&](const Stamp& s) { return !stamp(s); });
}

int WindowProblem::half_bandwidth(const WindowState& state) const {
  return state.trajectory->reach() * state.trajectory->block_size() - 1;
}

BandedSystem WindowProblem::system(const WindowState& state) const {
  return {state.trajectory->parameters(), half_bandwidth(state), layout_.size()};
}

int WindowProblem::left_out(const WindowState& state) const {
  const core::Duration offset = core::duration_from_s(state.imu_offset_s);
  int n = 0;
  for (const Item& item : items_) {
    if (item.kind != Item::Kind::reading) continue;
    if (!state.trajectory->covers(data_->readings[static_cast<std::size_t>(item.index)].t - offset)) ++n;
  }
  return n;
}

double WindowProblem::cost(const WindowState& state, bool lidar) const {
  const core::Duration offset = core::duration_from_s(state.imu_offset_s);
  std::vector<double> sums(chunks(items_.size()), 0.0);
  for_each_chunk(items_.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<Term> terms_of_item;
    for (std::size_t i = begin; i < end; ++i) {
      if (items_[i].kind == Item::Kind::reading) {
        const core::Time t = data_->readings[static_cast<std::size_t>(items_[i].index)].t - offset;
        if (outside(*state.trajectory, t) > kMostOutside) sums[chunk] = std::numeric_limits<double>::infinity();
      }
      terms(state, items_[i], false, terms_of_item);
      for (const Term& term : terms_of_item) sums[chunk] += term.rho().rho / 2;
    }
  });
  const double rest = sum_in_order(sums) + data_->prior.cost(state);
  if (!lidar) return rest;

  std::vector<double> lidar_sums(chunks(stamps_.size()), 0.0);
  for_each_chunk(stamps_.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<core::Time> times;
    std::vector<core::SE3> poses;
    for (std::size_t from = begin; from < end;) {  // runs of ascending stamps: sweeps of several LiDARs overlap
      std::size_t to = from + 1;
      while (to < end && stamps_[to].t >= stamps_[to - 1].t) ++to;
      times.clear();
      for (std::size_t i = from; i < to; ++i) times.push_back(stamps_[i].t);
      poses.resize(times.size());
      state.trajectory->poses(times, poses);
      for (std::size_t i = from; i < to; ++i)
        lidar_sums[chunk] += stamp_cost(*stamps_[i].factors, stamps_[i].index, poses[i - from]);
      from = to;
    }
  });
  return rest + sum_in_order(lidar_sums);
}

void WindowProblem::assemble(const WindowState& state, BandedSystem* lidar, BandedSystem* rest) const {
  if (rest != nullptr) {
    std::vector<LocalSum> sums(chunks(items_.size()));
    for_each_chunk(items_.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      std::vector<Term> terms_of_item;
      for (std::size_t i = begin; i < end; ++i) {
        terms(state, items_[i], true, terms_of_item);
        for (const Term& term : terms_of_item) sums[chunk].add(term);
      }
    });
    for (const LocalSum& sum : sums) sum.add_to(*rest);
    data_->prior.add_to(state, layout_, *rest);
  }
  if (lidar == nullptr) return;
  std::vector<LocalSum> sums(chunks(stamps_.size()));
  for_each_chunk(stamps_.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    core::StateJet jet;
    for (std::size_t i = begin; i < end; ++i) stamp_sum(state, stamps_[i], jet, sums[chunk]);
  });
  for (const LocalSum& sum : sums) sum.add_to(*lidar);
}

}  // namespace tarmac::estimators
