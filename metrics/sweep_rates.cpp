#include "metrics/sweep_rates.h"

#include <optional>
#include <vector>

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr int kParts = 8;

/// The motion that the estimate gives over the whole sweep in one segment with more than two poses.
const Segment* motion_inside(const PiecewiseTrajectory& trajectory, const SweepResult& sweep) {
  const Segment* segment = trajectory.find(sweep.begin);
  if (!segment || segment->t1 < sweep.end) return nullptr;
  const bool sampled = segment->model == SegmentModel::sampled_slerp || segment->model == SegmentModel::sampled_screw;
  if (!sampled) return nullptr;
  int nodes = 0;
  for (const Time t : segment->times) nodes += t > sweep.begin && t < sweep.end;
  return nodes >= kParts / 2 ? segment : nullptr;
}

SweepRates rates_inside(const Segment& motion, const SweepResult& sweep) {
  SweepRates rates{.begin = sweep.begin, .end = sweep.end, .inside = true};
  const Duration span = sweep.end - sweep.begin;
  SE3 last = motion.pose(sweep.begin);
  double sum = 0;
  for (int k = 0; k < kParts; ++k) {
    const SE3 next = motion.pose(sweep.begin + span * (k + 1) / kParts);
    const Vector6 twist = se3::log(last.inverse() * next) * (kParts / to_s(span));
    const double s = (k + 0.5) / kParts - 0.5;
    rates.twist += twist / kParts;
    rates.change += s * twist;
    sum += s * s;
    last = next;
  }
  rates.change /= sum;
  return rates;
}

std::optional<Vector6> mean_twist(const SweepResult* from, const SweepResult* to) {
  if (!from || !to || from->status != SweepStatus::ok || to->status != SweepStatus::ok) return std::nullopt;
  const double dt = to_s(to->reference - from->reference);
  // A lost sweep or two between them still leaves a mean; a long hole does not.
  if (!(dt > 0) || dt > 3.5 * to_s(to->end - to->begin)) return std::nullopt;
  return se3::log(from->T_map_body.inverse() * to->T_map_body) / dt;
}

}  // namespace

std::map<std::int64_t, SweepRates> sweep_rates(const Estimate& estimate) {
  std::map<std::int64_t, SweepRates> all;
  const std::vector<SweepResult>& sweeps = estimate.sweeps;
  const auto at = [&](std::size_t k) { return k < sweeps.size() ? &sweeps[k] : nullptr; };
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const SweepResult& sweep = sweeps[k];
    if (sweep.status != SweepStatus::ok || sweep.end <= sweep.begin) continue;
    if (const Segment* motion = motion_inside(estimate.headline(), sweep)) {
      all.emplace(sweep.index, rates_inside(*motion, sweep));
      continue;
    }
    if (k < 2) continue;
    const auto before = mean_twist(at(k - 2), at(k - 1)), here = mean_twist(at(k - 1), at(k)),
               after = mean_twist(at(k), at(k + 1));
    if (!before || !here || !after) continue;
    const double between_s = to_s(sweeps[k + 1].reference - sweeps[k - 1].reference);
    const double share = to_s(sweep.end - sweep.begin) / between_s;
    all.emplace(sweep.index, SweepRates{sweep.begin, sweep.end, *here, share * (*after - *before), false});
  }
  return all;
}

}  // namespace tarmac::metrics
