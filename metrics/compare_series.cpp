#include "metrics/compare_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "metrics/paired_logs.h"
#include "metrics/statistics.h"

namespace tarmac::metrics {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-9;

bool same_grid(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= 1e-6)) return false;
  return true;
}

/// y at x by a straight line between neighbours; NaN outside and beside a gap. x of the series ascends.
double value_at(const Series& s, double x) {
  const auto after = std::lower_bound(s.x.begin(), s.x.end(), x - 1e-6);
  if (after == s.x.end()) return kNaN;
  const auto i = static_cast<std::size_t>(after - s.x.begin());
  if (std::abs(s.x[i] - x) <= 1e-6) return s.y[i];
  if (i == 0) return kNaN;
  const double share = (x - s.x[i - 1]) / (s.x[i] - s.x[i - 1]);
  return s.y[i - 1] + share * (s.y[i] - s.y[i - 1]);
}

std::vector<double> medians(std::span<const SeriesPair> pairs, const Series* SeriesPair::*side,
                            const std::vector<double>& grid) {
  std::vector<double> out;
  out.reserve(grid.size());
  for (const double x : grid) {
    std::vector<double> values;
    for (const SeriesPair& pair : pairs)
      if (const double y = value_at(*(pair.*side), x); std::isfinite(y)) values.push_back(y);
    out.push_back(values.empty() ? kNaN : quantile(std::move(values), 0.5));
  }
  return out;
}

/// Blocks of one length from `begin`; what is left at the end, when it is less than half a block, belongs to the last.
struct Blocks {
  double begin = 0, length = 1;
  std::size_t count = 0;
  double end = 0;

  double from(std::size_t k) const { return begin + static_cast<double>(k) * length; }
  double to(std::size_t k) const { return k + 1 == count ? end : from(k + 1); }
  std::size_t of(double x) const {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, (x - begin) / length)));
  }
};

Blocks blocks_over(std::span<const SeriesPair> pairs, double length) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const SeriesPair& pair : pairs) {
    for (const Series* s : {pair.a, pair.b}) {
      if (s->x.empty()) continue;
      low = std::min(low, s->x.front());
      high = std::max(high, s->x.back());
    }
  }
  Blocks blocks;
  if (!(low <= high)) return blocks;
  // Whole blocks on the axis, "3 to 4 s"; the first sweep of a drive ends a little after 0.
  blocks.length = length;
  blocks.begin = length * std::floor(low / length);
  blocks.count = std::max<std::size_t>(1, static_cast<std::size_t>(std::floor((high - blocks.begin) / length + 0.5)));
  blocks.end = std::max(high, blocks.from(blocks.count - 1));
  return blocks;
}

/// Mean of B - A in each block; NaN where one of them has no sample.
std::vector<double> block_differences(const SeriesPair& pair, const Blocks& blocks) {
  std::vector<double> sum_a(blocks.count, 0), sum_b(blocks.count, 0);
  std::vector<std::size_t> n_a(blocks.count, 0), n_b(blocks.count, 0);
  const bool together = same_grid(pair.a->x, pair.b->x);
  const auto add = [&](const Series& s, const Series& other, std::vector<double>& sum, std::vector<std::size_t>& n) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!std::isfinite(s.y[i]) || (together && !std::isfinite(other.y[i]))) continue;
      sum[blocks.of(s.x[i])] += s.y[i];
      ++n[blocks.of(s.x[i])];
    }
  };
  add(*pair.a, *pair.b, sum_a, n_a);
  add(*pair.b, *pair.a, sum_b, n_b);
  std::vector<double> out(blocks.count, kNaN);
  for (std::size_t k = 0; k < blocks.count; ++k) {
    if (n_a[k] > 0 && n_b[k] > 0)
      out[k] = sum_b[k] / static_cast<double>(n_b[k]) - sum_a[k] / static_cast<double>(n_a[k]);
  }
  return out;
}

struct Interval {
  double centre = kNaN, low = kNaN, high = kNaN;
};

Interval student(const std::vector<double>& values, double level) {
  if (values.size() < kLeastPairs) return {};
  const LogSummary summary = summarise(values);
  const double half = summary.error * student_quantile(summary.n, 1 - level / 2);
  return {summary.mean, summary.mean - half, summary.mean + half};
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values)
    if (std::isfinite(v)) most = std::max(most, std::abs(v));
  return most;
}

void find_stretches(const Blocks& blocks, double rounding, SeriesComparison& c) {
  int side_before = 0;
  std::size_t first = 0;
  for (std::size_t k = 0; k < blocks.count; ++k) {
    const bool real = std::abs(c.difference[k]) > rounding;
    const int side = real && c.low[k] > 0 ? 1 : real && c.high[k] < 0 ? -1 : 0;
    if (side != 0 && side != side_before) {
      first = k;
      c.stretches.push_back({blocks.from(k), blocks.to(k), 0});
    }
    if (side != 0) {
      SeriesComparison::Stretch& stretch = c.stretches.back();
      stretch.to = blocks.to(k);
      const double n = static_cast<double>(k - first);
      stretch.difference = (stretch.difference * n + c.difference[k]) / (n + 1);
    }
    side_before = side;
  }
}

}  // namespace

SeriesComparison compare_series(std::span<const SeriesPair> pairs, double block_length, double significance) {
  if (pairs.empty()) throw std::invalid_argument("compare_series: no pairs");
  for (const SeriesPair& pair : pairs)
    if (!pair.a || !pair.b) throw std::invalid_argument("compare_series: one of a pair is missing");
  SeriesComparison c;
  c.name = pairs.front().a->name;
  c.x_label = pairs.front().a->x_label;
  c.y_label = pairs.front().a->y_label;
  c.pairs = pairs.size();
  c.block_length = block_length;
  c.x = pairs.front().a->x;
  c.a = medians(pairs, &SeriesPair::a, c.x);
  c.b = medians(pairs, &SeriesPair::b, c.x);

  const Blocks blocks = blocks_over(pairs, block_length);
  c.level = significance / static_cast<double>(std::max<std::size_t>(1, blocks.count));
  std::vector<std::vector<double>> of_pairs;
  for (const SeriesPair& pair : pairs) of_pairs.push_back(block_differences(pair, blocks));
  for (std::size_t k = 0; k < blocks.count; ++k) {
    std::vector<double> values;
    for (const auto& differences : of_pairs)
      if (std::isfinite(differences[k])) values.push_back(differences[k]);
    const Interval interval = student(values, c.level);
    c.block_x.push_back(0.5 * (blocks.from(k) + blocks.to(k)));
    c.difference.push_back(interval.centre);
    c.low.push_back(interval.low);
    c.high.push_back(interval.high);
  }
  find_stretches(blocks, kRounding * std::max(largest(c.a), largest(c.b)), c);
  return c;
}

}  // namespace tarmac::metrics
