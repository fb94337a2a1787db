#include "metrics/stamps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr std::size_t kSweeps = 24;  // more do not tell more

/// Indices of the finite points by stamp, and by firing order among equal ones.
std::vector<std::size_t> by_stamp(const LidarSweep& sweep) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sweep.size(); ++i)
    if (sweep.point(i).allFinite()) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sweep.t_ns[a] < sweep.t_ns[b]; });
  return order;
}

/// Calls visit(first, last) for each run [first, last) of equal stamps in `order`.
template <class Visit>
void for_each_stamp(const LidarSweep& sweep, const std::vector<std::size_t>& order, const Visit& visit) {
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last < order.size() && sweep.t_ns[order[last]] == sweep.t_ns[order[first]]) ++last;
    visit(first, last);
    first = last;
  }
}

/// How far one channel turned among points with one stamp: no other than the first point's, since channels of one
/// firing may look in different directions.
double turned_rad(const LidarSweep& sweep, const std::vector<std::size_t>& order, std::size_t first, std::size_t last) {
  const auto azimuth = [&](std::size_t i) { return std::atan2(sweep.y_m[i], sweep.x_m[i]); };
  for (std::size_t k = last; k-- > first + 1;)
    if (sweep.ring[order[k]] == sweep.ring[order[first]])
      return std::remainder(azimuth(order[k]) - azimuth(order[first]), 2 * std::numbers::pi);
  return 0;
}

StampFacts facts_of(const LidarSweep& sweep) {
  StampFacts facts;
  const std::vector<std::size_t> order = by_stamp(sweep);
  const double duration_s = to_s(sweep.end - sweep.begin);
  if (order.size() < 2 || !(duration_s > 0)) return facts;
  facts.sweeps = 1;
  facts.span_share = 1e-9 * (double{1} * sweep.t_ns[order.back()] - sweep.t_ns[order.front()]) / duration_s;
  std::vector<double> gaps_s;
  double turned = 0;
  std::int32_t before = 0;
  for_each_stamp(sweep, order, [&](std::size_t first, std::size_t last) {
    const std::int32_t t_ns = sweep.t_ns[order[first]];
    if (first > 0) gaps_s.push_back(1e-9 * (double{1} * t_ns - before));
    before = t_ns;
    turned += turned_rad(sweep, order, first, last);
  });
  facts.distinct = static_cast<double>(gaps_s.size() + 1);
  facts.gap_s = gaps_s.empty() ? 0 : quantile(gaps_s, 0.5);
  facts.turn_share = std::abs(turned) / (2 * std::numbers::pi);  // all stamps together turn once
  std::size_t down = 0, steps = 0;
  for (std::size_t i = 1; i < sweep.size(); ++i) {
    steps += sweep.t_ns[i] != sweep.t_ns[i - 1];
    down += sweep.t_ns[i] < sweep.t_ns[i - 1];
  }
  facts.descending_share = steps ? static_cast<double>(down) / static_cast<double>(steps) : 0;
  return facts;
}

}  // namespace

StampFacts stamp_facts(const SweepSource& sweeps) {
  std::vector<StampFacts> all;
  const std::size_t n = std::min(sweeps.count, kSweeps);
  for (std::size_t k = 0; k < n; ++k) {
    const StampFacts facts = facts_of(sweeps.sweep(k * sweeps.count / n));
    if (facts.sweeps) all.push_back(facts);
  }
  const auto median = [&](double StampFacts::*field) {
    std::vector<double> values;
    for (const StampFacts& facts : all) values.push_back(facts.*field);
    return values.empty() ? 0.0 : quantile(values, 0.5);
  };
  return {all.size(),
          median(&StampFacts::span_share),
          median(&StampFacts::distinct),
          median(&StampFacts::gap_s),
          median(&StampFacts::descending_share),
          median(&StampFacts::turn_share)};
}

std::vector<float> place_within_stamp(const LidarSweep& sweep) {
  const std::vector<std::size_t> order = by_stamp(sweep);
  std::vector<float> place(sweep.size(), 0.5F);
  for_each_stamp(sweep, order, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      place[order[k]] = (static_cast<float>(k - first) + 0.5F) / static_cast<float>(last - first);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sweep.size(); ++i)
    if (sweep.point(i).allFinite()) place[kept++] = place[i];
  place.resize(kept);
  return place;
}

}  // namespace tarmac::metrics
