#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "reports/page.h"
#include "reports/page_comparisons.h"

namespace tarmac::reports {

namespace {

constexpr const char* kMetric = "end_error_percent";

struct Score {
  std::string estimator;
  std::vector<double> values;  ///< one a run that has one, ascending
  double low = 0, high = 0;    ///< range over runs; of a single run its confidence interval
  double median() const {
    const std::size_t n = values.size();
    return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  }
};

/// Causal where there is one: the headline; batch methods have `final` only.
const metrics::Row* headline_row(const metrics::Evaluation& evaluation) {
  const metrics::Row* const causal = evaluation.row(kMetric);
  return causal && causal->value ? causal : evaluation.row(kMetric, "final");
}

std::vector<Score> scores(const std::vector<ReportRun>& runs) {
  std::map<std::string, Score> by_name;
  for (const auto& run : runs) {
    for (const auto& evaluation : run.evaluations) {
      const metrics::Row* const row = headline_row(evaluation);
      if (!row || !row->value || evaluation.status != "ok") continue;
      Score& score = by_name[evaluation.estimator];
      score.estimator = evaluation.estimator;
      score.values.push_back(*row->value);
      score.low = row->ci_low.value_or(*row->value);
      score.high = row->ci_high.value_or(*row->value);
    }
  }
  std::vector<Score> list;
  for (auto& [name, score] : by_name) {
    std::sort(score.values.begin(), score.values.end());
    if (score.values.size() > 1) {
      score.low = score.values.front();
      score.high = score.values.back();
    }
    list.push_back(std::move(score));
  }
  std::sort(list.begin(), list.end(), [](const Score& a, const Score& b) { return a.median() < b.median(); });
  return list;
}

std::string percent(double value) {
  return fmt::format("{:.{}f} %", value, value < 0.1 ? 3 : value < 10 ? 2 : 1);
}

/// "kiss-icp failed in 2 of 5 runs; x and y failed"
std::string failures(const std::vector<ReportRun>& runs) {
  std::map<std::string, std::pair<int, int>> failed_of;
  for (const auto& run : runs) {
    for (const auto& evaluation : run.evaluations) {
      auto& [failed, all] = failed_of[evaluation.estimator];
      failed += evaluation.status != "ok";
      ++all;
    }
  }
  std::string text;
  for (const auto& [name, counts] : failed_of) {
    const auto [failed, all] = counts;
    if (failed == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", name,
                        failed == all ? "gave no result" : fmt::format("gave no result in {} of {} runs", failed, all));
  }
  return text.empty() ? "" : text + ".";
}

std::string spread(const Score& score) {
  if (score.values.size() < 2) return "";
  return fmt::format(" (median of {} seeds, {} to {})", score.values.size(), percent(score.low), percent(score.high));
}

/// Where no ratio is defined, since a value is 0, ranges have to do.
std::string by_ranges(const Score& best, const Score& second) {
  return best.high < second.low
             ? fmt::format("The ranges over the seeds do not overlap: {}'s worst run is better than {}'s best.",
                           best.estimator, second.estimator)
             : fmt::format(
                   "The ranges over the seeds overlap ({}: {} to {}), so these runs do not settle which of the "
                   "two is better.",
                   second.estimator, percent(second.low), percent(second.high));
}

std::string interval(const metrics::PairedComparison& c) {
  return fmt::format("95 % interval {:.2g} to {:.2g}, lower on {} of {} seeds", c.low, c.high, c.a_lower, c.pairs);
}

std::string how_sure(const Score& best, const Score& second, const metrics::PairedComparison& c) {
  switch (c.difference) {
    case metrics::Difference::lower:
      return fmt::format("The difference is more than chance: seed by seed {} has {:.2g} times {}'s end error ({}).",
                         best.estimator, c.ratio, second.estimator, interval(c));
    case metrics::Difference::higher:  // the median says one thing, the mean ratio the other
      return fmt::format("Seed by seed it is the other way round: {} has {:.2g} times {}'s end error ({}).",
                         best.estimator, c.ratio, second.estimator, interval(c));
    case metrics::Difference::not_significant:
      return fmt::format("Seed by seed the ratio of the two is {:.2g} ({}){}: these runs do not settle which is better.",
                         c.ratio, interval(c), c.low > 1 || c.high < 1 ? ", one of several pairs compared" : "");
    case metrics::Difference::too_few:
      break;
  }
  const std::size_t seeds = std::min(best.values.size(), second.values.size());
  if (seeds < 2) {
    return "This is one seed: a single drive says little about small differences. Run several to see the spread.";
  }
  if (seeds > 2) return by_ranges(best, second);
  return "Two seeds are too few to tell a difference from chance: run five.";
}

/// Paths but none of them true: a recording from outside.
bool without_truth(const std::vector<ReportRun>& runs) {
  bool estimated = false;
  for (const auto& run : runs) {
    for (const auto& evaluation : run.evaluations) {
      if (evaluation.find("path_true")) return false;
      estimated = estimated || evaluation.find("path_estimate");
    }
  }
  return estimated;
}

struct PathEnd {
  std::string estimator;
  Eigen::Vector2d end_m;  ///< from where the path began, in the method's own frame
  double length_m = 0;
};

std::optional<PathEnd> path_end(const metrics::Evaluation& evaluation) {
  const metrics::Series* const path = evaluation.find("path_estimate");
  if (!path || evaluation.status != "ok") return std::nullopt;
  std::vector<Eigen::Vector2d> places;
  for (std::size_t i = 0; i < path->x.size(); ++i) {
    if (std::isfinite(path->x[i]) && std::isfinite(path->y[i])) places.emplace_back(path->x[i], path->y[i]);
  }
  if (places.empty()) return std::nullopt;
  PathEnd end{evaluation.estimator, places.back() - places.front(), 0};
  for (std::size_t i = 1; i < places.size(); ++i) end.length_m += (places[i] - places[i - 1]).norm();
  return end;
}

std::string length(double metres) {
  return metres < 1 ? fmt::format("{:.{}f} cm", 100 * metres, metres < 0.1 ? 1 : 0) : fmt::format("{:.1f} m", metres);
}

/// How far the methods are from each other: all that can be said where nobody knows the truth.
std::string agreement(const ReportRun& run) {
  std::vector<PathEnd> ends;
  for (const auto& evaluation : run.evaluations) {
    if (const auto end = path_end(evaluation)) ends.push_back(*end);
  }
  if (ends.empty()) return "";
  if (ends.size() == 1) return fmt::format("{} covers {}.", ends[0].estimator, length(ends[0].length_m));
  const PathEnd *a = &ends[0], *b = &ends[1];
  for (const PathEnd& one : ends) {
    for (const PathEnd& other : ends) {
      if ((one.end_m - other.end_m).norm() > (a->end_m - b->end_m).norm()) a = &one, b = &other;
    }
  }
  return fmt::format("{}{} and {} end {} apart, after paths of {} and {}; that they agree would not make them right.",
                     ends.size() > 2 ? "Farthest from each other, " : "", a->estimator, b->estimator,
                     length((a->end_m - b->end_m).norm()), length(a->length_m), length(b->length_m));
}

std::string join(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + " " + b;
}

}  // namespace

Verdict verdict(const std::vector<ReportRun>& runs) {
  const std::vector<Score> list = scores(runs);
  const std::string failed = failures(runs);
  if (list.empty() && without_truth(runs)) {
    return {"Nobody knows the true motion of this recording, so no error is stated. " + agreement(runs.front()),
            failed};
  }
  if (list.empty()) return {"No estimator has an end error to compare.", failed};
  const Score& best = list.front();
  if (list.size() == 1) {
    return {fmt::format("{} ends {} of the distance driven away from the truth{}.", best.estimator,
                        percent(best.median()), spread(best)),
            failed};
  }
  const Score& second = list[1];
  const metrics::PairedComparison c = comparison_of(runs, best.estimator, second.estimator, kMetric);
  const std::string note = join(how_sure(best, second, c), failed);
  if (c.difference == metrics::Difference::not_significant) {
    return {fmt::format("{} and {} do not differ significantly in end error: {} and {} of the distance driven (medians "
                        "of {} seeds).",
                        best.estimator, second.estimator, percent(best.median()), percent(second.median()), c.pairs),
            note};
  }
  const double times = second.median() / best.median();
  // A replay of the truth ends at 0: nothing is a finite number of times worse than that.
  const std::string next = best.median() > 0 && times < 1000 && times >= 1.05
                               ? fmt::format("{:.{}f} times less than {} with {}", times, times < 10 ? 1 : 0,
                                             second.estimator, percent(second.median()))
                               : fmt::format("{} follows with {}", second.estimator, percent(second.median()));
  return {fmt::format("{} has the lowest end error: {} of the distance driven{}, {}.", best.estimator,
                      percent(best.median()), spread(best), next),
          note};
}

}  // namespace tarmac::reports
