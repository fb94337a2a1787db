#include "tools/gates/rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "metrics/statistics.h"

namespace tarmac::tools {
namespace {

using reports::GateReportRow;
using reports::GateVerdict;
using scenarios::GateStatistic;

/// Bounds are held up to rounding: 0.5 * 1.1 is not above 0.55.
constexpr double kRounding = 1e-12;

void fail(GateReportRow& row, std::string reason) {
  row.verdict = GateVerdict::fail;
  row.reason = std::move(reason);
}

/// Seeds named, at most five.
std::string seed_list(const std::vector<std::uint64_t>& seeds) {
  const std::size_t shown = std::min<std::size_t>(seeds.size(), 5);
  std::string text = fmt::format("seed{} {}", seeds.size() == 1 ? "" : "s",
                                 fmt::join(seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  return seeds.size() > shown ? text + fmt::format(" and {} more", seeds.size() - shown) : text;
}

std::vector<std::uint64_t> seeds_without_value(const SeedValues& values) {
  std::vector<std::uint64_t> seeds;
  for (const auto& [seed, value] : values)
    if (!value) seeds.push_back(seed);
  return seeds;
}

/// Says what is wrong with the two sides before any number is compared; empty: nothing. A seed of the baseline that the
/// sweep has not, or whose number is n/a now, is a failure: what is lost is not as good as it was.
std::string lost_since(const TargetValues& values, const SeedValues* baseline) {
  if (!baseline) return "the baseline has no such row: write it with `tarmac baseline update`";
  std::vector<std::uint64_t> gone, not_available;
  for (const auto& [seed, before] : *baseline) {
    const auto now = values.values.find(seed);
    if (values.allowed.contains(seed)) continue;
    if (now == values.values.end())
      gone.push_back(seed);
    else if (before && !now->second)
      not_available.push_back(seed);
  }
  if (!not_available.empty()) return fmt::format("{}: a number in the baseline and n/a now", seed_list(not_available));
  if (!gone.empty()) return fmt::format("{}: in the baseline and not in this sweep", seed_list(gone));
  return "";
}

/// Both sides' numbers, of the seeds where both have one.
struct Pairs {
  std::vector<double> now, before;
};

Pairs pair_up(const SeedValues& now, const SeedValues& before) {
  Pairs pairs;
  for (const auto& [seed, value] : now)
    if (const auto old = before.find(seed); old != before.end() && value && old->second) {
      pairs.now.push_back(*value);
      pairs.before.push_back(*old->second);
    }
  return pairs;
}

/// As `tarmac compare` does it: what has a sign is the better the nearer it is to 0, so sizes are compared.
void compare_sizes(metrics::Better better, Pairs& pairs, GateReportRow& row) {
  const auto has_negative = [](const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v < 0; });
  };
  if (better != metrics::Better::lower || !(has_negative(pairs.now) || has_negative(pairs.before))) return;
  for (double& v : pairs.now) v = std::abs(v);
  for (double& v : pairs.before) v = std::abs(v);
  row.rule += " (absolute values)";
}

double statistic_of(GateStatistic of, const std::vector<double>& values, bool for_max) {
  if (of == GateStatistic::mean) return metrics::mean(values);
  if (of == GateStatistic::median) return *scenarios::median_of(values);
  return for_max ? *std::max_element(values.begin(), values.end()) : *std::min_element(values.begin(), values.end());
}

const char* words_of(GateStatistic of) {
  return of == GateStatistic::mean ? "mean" : of == GateStatistic::median ? "median" : "every seed";
}

/// A worsening ratio as a change of the metric itself, in percent.
double change_percent(double worsening_ratio, bool lower_is_better) {
  return 100 * (lower_is_better ? worsening_ratio - 1 : 1 / worsening_ratio - 1);
}

void fill_paired(const metrics::NonInferiority& r, bool lower_is_better, GateReportRow& row) {
  row.pairs = r.pairs;
  row.change_percent = change_percent(r.ratio, lower_is_better);
  const double low = change_percent(r.ci_low, lower_is_better), high = change_percent(r.ci_high, lower_is_better);
  if (std::isfinite(low) && std::isfinite(high)) {
    row.change_low_percent = std::min(low, high);
    row.change_high_percent = std::max(low, high);
  }
  row.p = r.p;
}

}  // namespace

std::string words_of(const scenarios::GateRow& row) {
  if (row.absolute) {
    std::string text = words_of(row.absolute->of);
    if (row.absolute->min) text += fmt::format(" at least {:g}", *row.absolute->min);
    if (row.absolute->min && row.absolute->max) text += " and";
    if (row.absolute->max) text += fmt::format(" at most {:g}", *row.absolute->max);
    return text;
  }
  if (row.relative) {
    std::string text = "median against the baseline's:";
    if (row.relative->max_increase_percent)
      text += fmt::format(" at most +{:g} %", *row.relative->max_increase_percent);
    if (row.relative->max_decrease_percent)
      text += fmt::format(" at most -{:g} %", *row.relative->max_decrease_percent);
    return text;
  }
  return fmt::format("no worse than the baseline, seed by seed (margin {:g} %)", row.non_inferior->margin_percent);
}

void judge_absolute(const scenarios::AbsoluteRule& rule, const TargetValues& values, GateReportRow& row) {
  if (const auto without = seeds_without_value(values.values); !without.empty())
    return fail(row, fmt::format("{}: n/a: a bound holds numbers only", seed_list(without)));
  const std::vector<double> numbers = scenarios::numbers_of(values.values);
  if (numbers.empty()) return fail(row, "no seed has a value");
  row.pairs = numbers.size();
  row.value = statistic_of(rule.of, numbers, rule.max.has_value());
  if (rule.max) {
    const double value = statistic_of(rule.of, numbers, true);
    if (value > *rule.max) {
      row.value = value;
      return fail(row, fmt::format("{:.4g} is above {:g}", value, *rule.max));
    }
  }
  if (rule.min) {
    const double value = statistic_of(rule.of, numbers, false);
    if (value < *rule.min) {
      row.value = value;
      return fail(row, fmt::format("{:.4g} is below {:g}", value, *rule.min));
    }
  }
}

void judge_relative(const scenarios::RelativeRule& rule, const TargetValues& values, const SeedValues* baseline,
                    metrics::Better better, GateReportRow& row) {
  if (std::string lost = lost_since(values, baseline); !lost.empty()) return fail(row, std::move(lost));
  Pairs pairs = pair_up(values.values, *baseline);
  compare_sizes(better, pairs, row);
  const auto& [now, before] = pairs;
  if (now.empty()) return fail(row, "no seed has a number on both sides: nothing was compared");
  row.pairs = now.size();
  row.value = scenarios::median_of(now);
  row.baseline = scenarios::median_of(before);
  if (*row.value == *row.baseline) {
    row.change_percent = 0;
    return;
  }
  if (*row.baseline <= 0)
    return fail(row, fmt::format("the baseline's median is {:g}: a percentage of it says nothing; hold the row to max "
                                 "or min",
                                 *row.baseline));
  const double ratio = *row.value / *row.baseline;
  row.change_percent = 100 * (ratio - 1);
  if (rule.max_increase_percent && ratio > 1 + *rule.max_increase_percent / 100 + kRounding)
    return fail(row, fmt::format("{:+.2f} % is more than +{:g} %", *row.change_percent, *rule.max_increase_percent));
  if (rule.max_decrease_percent && ratio < 1 - *rule.max_decrease_percent / 100 - kRounding)
    return fail(row, fmt::format("{:+.2f} % is more than -{:g} %", *row.change_percent, *rule.max_decrease_percent));
}

PairedRow test_paired(const scenarios::NonInferiorRule& rule, const TargetValues& values, const SeedValues* baseline,
                      double alpha, metrics::Better better, GateReportRow& row) {
  const bool lower_is_better = better == metrics::Better::lower;
  PairedRow paired;
  if (std::string lost = lost_since(values, baseline); !lost.empty()) {
    fail(row, std::move(lost));
    return paired;
  }
  Pairs pairs = pair_up(values.values, *baseline);
  compare_sizes(better, pairs, row);
  const auto& [now, before] = pairs;
  row.pairs = now.size();
  if (now.size() < std::max<std::size_t>(rule.min_pairs, 2)) {
    fail(row, fmt::format("{} pairs of seeds, and at least {} are wanted: run more seeds, or write the baseline anew "
                          "with them",
                          now.size(), std::max<std::size_t>(rule.min_pairs, 2)));
    return paired;
  }
  row.value = scenarios::median_of(now);
  row.baseline = scenarios::median_of(before);
  paired.result = metrics::test_non_inferiority(now, before, {rule.margin_percent / 100, alpha, 0.8, lower_is_better});
  const metrics::NonInferiority& r = paired.result;
  if (r.worse > 0) {
    fail(row, fmt::format("{} of {} seeds have no ratio (a value at or below 0) and are worse than they were", r.worse,
                          now.size()));
  } else if (r.better > 0) {
    row.verdict = GateVerdict::inconclusive;
    row.reason = fmt::format("{} of {} seeds have no ratio (a value at or below 0); none of these is worse", r.better,
                             now.size());
  } else {
    paired.tested = true;
    fill_paired(r, lower_is_better, row);
  }
  return paired;
}

void judge_paired(const scenarios::NonInferiorRule& rule, const PairedRow& paired, double alpha, double strictest_alpha,
                  double p_adjusted, bool lower_is_better, GateReportRow& row) {
  const metrics::NonInferiority& r = paired.result;
  const double margin = rule.margin_percent / 100;
  row.p_adjusted = p_adjusted;
  const double detectable =
      metrics::minimum_detectable_change(r.pairs, r.log_sd, {margin, strictest_alpha, 0.8, lower_is_better});
  row.detectable_percent = 100 * detectable;
  if (p_adjusted < alpha) {
    fail(row,
         fmt::format("worse by {:.1f} % over {} pairs (95 % interval {}), p = {} after adjustment, level {:g}",
                     100 * (r.ratio - 1), r.pairs, reports::interval_text(row), reports::p_text(p_adjusted), alpha));
  } else if (r.verdict == metrics::NonInferiorityVerdict::pass) {
    row.verdict = GateVerdict::pass;
    row.reason = r.log_sd == 0 && r.log_mean == 0 ? "the same on every seed" : "shown to be no worse";
  } else {
    row.verdict = GateVerdict::inconclusive;
    row.reason = fmt::format(
        "neither shown worse nor shown not to be; a worsening by {:.1f} % would have been red in "
        "80 % of such comparisons ({} pairs)",
        row.detectable_percent.value(), r.pairs);
  }
}

}  // namespace tarmac::tools
