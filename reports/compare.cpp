#include "reports/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tarmac::reports {

namespace {

std::string plural(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

/// "12 worse and 3 better"
std::string directions(const CompareSummary& s) {
  std::vector<std::string> parts;
  if (s.worse) parts.push_back(fmt::format("{} worse", s.worse));
  if (s.better) parts.push_back(fmt::format("{} better", s.better));
  if (s.different) parts.push_back(fmt::format("{} different", s.different));
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

std::string largest_change(const CompareRow& row) {
  const auto& c = row.comparison;
  return fmt::format("What changed most is {} ({}): {:.3g} times A's, 95 % interval {:.3g} to {:.3g} over {} seeds.",
                     row.metric, row.where(), c.ratio, c.low, c.high, c.pairs);
}

std::string verdict_sentence(const CompareInput& input, const CompareSummary& s) {
  const std::string &a = input.a.label, &b = input.b.label;
  const std::size_t significant = s.better + s.worse + s.different;
  if (significant > 0) {
    return fmt::format("{} (B) against {} (A): {} of {}. {}", b, a, directions(s), plural(s.tested, "comparison"),
                       largest_change(*significant_rows(input).front()));
  }
  if (s.tested > 0) {
    return fmt::format("{} (B) and {} (A) do not differ significantly: no difference in {} is more than chance.", b, a,
                       plural(s.tested, "comparison"));
  }
  if (s.identical > 0) {
    // Where a few seeds differ nothing may be said of the whole.
    if (s.too_few + s.no_ratio > 0)
      return fmt::format("{} (B) and {} (A) have the same numbers on every seed in {}; {} more cannot be judged.", b, a,
                         plural(s.identical, "comparison"), s.too_few + s.no_ratio);
    return fmt::format("{} (B) and {} (A) are identical: the same numbers on every seed in {}.", b, a,
                       plural(s.identical, "comparison"));
  }
  if (s.too_few + s.no_ratio > 0) {
    return fmt::format(
        "{} (B) and {} (A) cannot be told apart or not: {}, each with fewer than 3 seeds that have a value on both "
        "sides.",
        b, a, plural(s.too_few + s.no_ratio, "comparison"));
  }
  return fmt::format("{} (B) and {} (A) have no result in common that could be compared.", b, a);
}

/// A method that crashes has no errors to compare, and must not look unchanged.
std::string failures(const CompareInput& input) {
  std::size_t in_a = 0, in_b = 0;
  for (const CompareMissing& line : input.missing) {
    if (line.kind == kNoResultInA) in_a += line.count;
    if (line.kind == kNoResultInB) in_b += line.count;
  }
  std::string text;
  if (in_b) text += fmt::format(" B gave no result in {} that A finished.", plural(in_b, "run"));
  if (in_a) text += fmt::format(" A gave no result in {} that B finished.", plural(in_a, "run"));
  return text;
}

std::string recordings_sentence(const CompareInput& input) {
  const std::size_t all = input.same_recordings + input.different_recordings + input.unknown_recordings;
  if (all == 0) return "";
  if (input.different_recordings > 0) {
    std::string which;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, input.different.size()); ++i)
      which += (i ? ", " : "") + input.different[i];
    if (input.different.size() > 3) which += ", ...";
    return fmt::format(
        "The recordings differ on {} of {} drives ({}): a difference may be the simulator's or the scenario's.",
        input.different_recordings, all, which);
  }
  if (input.unknown_recordings > 0)
    return fmt::format("Whether the recordings are the same is not known for {} of {} drives.",
                       input.unknown_recordings, all);
  return fmt::format("Both ran on the same recordings ({}).", plural(all, "drive"));
}

std::string note_of(const CompareInput& input, const CompareSummary& s) {
  std::vector<std::string> parts;
  if (s.tested > 0) {
    parts.push_back(fmt::format(
        "A comparison is one metric of one method on one case, over seeds in pairs; the {} are judged together (Holm's "
        "rule), so that the chance of any false claim among them is 5 % at most.",
        s.tested));
  }
  if (s.identical > 0 && s.tested > 0)
    parts.push_back(fmt::format("{} more {} identical.", s.identical, s.identical == 1 ? "is" : "are"));
  if (s.too_few > 0 && s.tested + s.identical > 0)
    parts.push_back(fmt::format("{} {} fewer than 3 seeds.", s.too_few, s.too_few == 1 ? "has" : "have"));
  if (s.no_ratio > 0 && s.tested + s.identical > 0)
    parts.push_back(fmt::format("{} {} no ratio, since a value is 0 or changes sign.", s.no_ratio,
                                s.no_ratio == 1 ? "has" : "have"));
  if (!s.recordings.empty()) parts.push_back(s.recordings);
  std::size_t missing = 0;
  for (const CompareMissing& line : input.missing) missing += line.count;
  if (missing > 0)
    parts.push_back(fmt::format("What could not be compared is listed ({}).", plural(input.missing.size(), "line")));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : " ") + part;
  return text;
}

std::vector<const CompareRow*> rows_by_change(const CompareInput& input, bool significant) {
  std::vector<const CompareRow*> rows;
  for (const CompareRow& row : input.rows) {
    const bool wanted = significant ? row.significant() : row.verdict == CompareVerdict::no_difference;
    if (!row.cost && wanted) rows.push_back(&row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const CompareRow* x, const CompareRow* y) {
    return std::abs(std::log(x->comparison.ratio)) > std::abs(std::log(y->comparison.ratio));
  });
  return rows;
}

}  // namespace

const char* name_of(CompareVerdict verdict) {
  switch (verdict) {
    case CompareVerdict::better:
      return "better";
    case CompareVerdict::worse:
      return "worse";
    case CompareVerdict::different:
      return "different";
    case CompareVerdict::no_difference:
      return "no_difference";
    case CompareVerdict::identical:
      return "identical";
    case CompareVerdict::too_few:
      return "too_few";
    case CompareVerdict::no_ratio:
      return "no_ratio";
  }
  return "unknown";
}

std::string words_of(const CompareRow& row) {
  switch (row.verdict) {
    case CompareVerdict::better:
      return "better";
    case CompareVerdict::worse:
      return "worse";
    case CompareVerdict::different:
      return row.comparison.ratio < 1 ? "lower" : "higher";
    case CompareVerdict::no_difference:
      return row.comparison.p < 0.05 ? "not settled" : "not significant";
    case CompareVerdict::identical:
      return "identical";
    case CompareVerdict::too_few:
      return fmt::format("too few seeds ({})", row.seeds);
    case CompareVerdict::no_ratio:
      return "no ratio";
  }
  return "";
}

std::string CompareRow::where() const {
  return estimator_a == estimator_b ? fmt::format("{}, {}", case_name, estimator_a)
                                    : fmt::format("{}, {} → {}", case_name, estimator_a, estimator_b);
}

std::vector<const CompareRow*> significant_rows(const CompareInput& input) {
  return rows_by_change(input, true);
}

std::vector<const CompareRow*> other_rows(const CompareInput& input) {
  return rows_by_change(input, false);
}

CompareSummary summary_of(const CompareInput& input) {
  CompareSummary s;
  for (const CompareRow& row : input.rows) {
    if (row.cost) continue;
    s.tested += row.significant() || row.verdict == CompareVerdict::no_difference;
    s.better += row.verdict == CompareVerdict::better;
    s.worse += row.verdict == CompareVerdict::worse;
    s.different += row.verdict == CompareVerdict::different;
    s.no_difference += row.verdict == CompareVerdict::no_difference;
    s.identical += row.verdict == CompareVerdict::identical;
    s.too_few += row.verdict == CompareVerdict::too_few;
    s.no_ratio += row.verdict == CompareVerdict::no_ratio;
  }
  s.recordings = recordings_sentence(input);
  s.sentence = verdict_sentence(input, s) + failures(input);
  s.note = note_of(input, s);
  return s;
}

}  // namespace tarmac::reports
