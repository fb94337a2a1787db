#include "tools/compare/results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "metrics/paired_logs.h"

namespace tarmac::tools {
namespace {

using Json = nlohmann::ordered_json;
using reports::CompareRow;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

void print_json(const reports::CompareInput& input) {
  Json rows = Json::array();
  for (const CompareRow& row : input.rows) {
    const auto& c = row.comparison;
    const bool known = c.pairs >= metrics::kLeastPairs;
    rows.push_back({{"scenario", row.case_name},
                    {"estimator_a", row.estimator_a},
                    {"estimator_b", row.estimator_b},
                    {"metric", row.metric},
                    {"unit", row.unit},
                    {"estimate", row.estimate},
                    {"a_median", number(row.a_median)},
                    {"b_median", number(row.b_median)},
                    {"ratio", c.pairs ? number(c.ratio) : Json(nullptr)},
                    {"ci_low", known ? number(c.low) : Json(nullptr)},
                    {"ci_high", known ? number(c.high) : Json(nullptr)},
                    {"seeds", row.seeds},
                    {"pairs", c.pairs},
                    {"b_better", row.b_better},
                    {"p", known ? number(c.p) : Json(nullptr)},
                    {"p_adjusted", known ? number(c.p_adjusted) : Json(nullptr)},
                    {"machine_dependent", row.cost},
                    {"status", name_of(row.verdict)}});
  }
  fmt::print("{}\n", rows.dump(2));
}

}  // namespace

void print_comparison(const reports::CompareInput& input, bool json) {
  if (json) {
    print_json(input);
    return;
  }
  const reports::CompareSummary summary = reports::summary_of(input);
  fmt::print("{}\n{}\n", summary.sentence, summary.note);
  const auto rows = reports::significant_rows(input);
  std::size_t where = 8;
  for (const CompareRow* row : rows) where = std::max(where, row->where().size());
  constexpr std::size_t kMost = 30;
  if (!rows.empty())
    fmt::print("\n{:<{}}  {:<36} {:>10} {:>10}  {:>8}  {:<20} {:>8}\n", "where", where, "metric", "A", "B", "B / A",
               "95 % interval", "verdict");
  for (std::size_t k = 0; k < std::min(rows.size(), kMost); ++k) {
    const CompareRow& row = *rows[k];
    fmt::print("{:<{}}  {:<36} {:>10.4g} {:>10.4g}  {:>8.3g}  {:<20} {:>8}\n", row.where(), where, row.metric,
               *row.a_median, *row.b_median, row.comparison.ratio,
               fmt::format("{:.3g} to {:.3g}", row.comparison.low, row.comparison.high), name_of(row.verdict));
  }
  if (rows.size() > kMost) fmt::print("and {} more\n", rows.size() - kMost);
  std::size_t missing = 0;
  for (const auto& line : input.missing) missing += line.count;
  if (missing) fmt::print("\nnot compared:\n");
  for (const auto& line : input.missing) fmt::print("  {}: {}: {}\n", line.kind, line.what, line.detail);
}

}  // namespace tarmac::tools
