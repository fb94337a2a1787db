#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/page.h"

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

std::string how_sure(const Score& best, const Score& second) {
  if (best.values.size() < 2 || second.values.size() < 2) {
    return "This is one seed: a single drive says little about small differences. Run several to see the spread.";
  }
  if (best.high < second.low) {
    return fmt::format("The ranges over the seeds do not overlap: {}'s worst run is better than {}'s best.",
                       best.estimator, second.estimator);
  }
  return fmt::format(
      "The ranges over the seeds overlap ({}: {} to {}), so these runs do not settle which of the two is "
      "better.",
      second.estimator, percent(second.low), percent(second.high));
}

std::string join(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + " " + b;
}

}  // namespace

Verdict verdict(const std::vector<ReportRun>& runs) {
  const std::vector<Score> list = scores(runs);
  const std::string failed = failures(runs);
  if (list.empty()) return {"No estimator has an end error to compare.", failed};
  const Score& best = list.front();
  if (list.size() == 1) {
    return {fmt::format("{} ends {} of the distance driven away from the truth{}.", best.estimator,
                        percent(best.median()), spread(best)),
            failed};
  }
  const Score& second = list[1];
  const double times = second.median() / best.median();
  // A replay of the truth ends at 0: nothing is a finite number of times worse than that.
  const std::string next = best.median() > 0 && times < 1000 && times >= 1.05
                               ? fmt::format("{:.{}f} times less than {} with {}", times, times < 10 ? 1 : 0,
                                             second.estimator, percent(second.median()))
                               : fmt::format("{} follows with {}", second.estimator, percent(second.median()));
  return {fmt::format("{} has the lowest end error: {} of the distance driven{}, {}.", best.estimator,
                      percent(best.median()), spread(best), next),
          join(how_sure(best, second), failed)};
}

}  // namespace tarmac::reports
