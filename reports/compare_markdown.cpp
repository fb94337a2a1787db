#include "reports/compare_markdown.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "reports/markdown.h"

namespace tarmac::reports {

namespace {

constexpr std::size_t kMostRows = 60;  ///< of a folded table: a comment has a largest size

/// Three significant digits, no exponent between 0.0001 and a million.
std::string number(double value) {
  const double size = std::abs(value);
  if (value == 0) return "0";
  if (!(size >= 1e-4 && size < 1e6)) return fmt::format("{:.2e}", value);
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(size))));
  return fmt::format("{:.{}f}", value, decimals);
}

std::string number(const std::optional<double>& value) {
  return value ? number(*value) : "n/a";
}

std::string percent(double ratio) {
  if (ratio >= 10) return fmt::format("× {:.3g}", ratio);
  const double change = 100 * (ratio - 1);
  return fmt::format("{:+.{}f} %", change, std::abs(change) < 10 ? 1 : 0);
}

std::string p_value(double p) {
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.2g}", p);
}

std::string table(const std::vector<const CompareRow*>& rows) {
  std::string text =
      "| | where | metric | A | B | change | 95 % interval of B / A | better on | adjusted p |\n"
      "|---|---|---|---:|---:|---:|---:|---:|---:|\n";
  for (std::size_t k = 0; k < std::min(rows.size(), kMostRows); ++k) {
    const CompareRow& row = *rows[k];
    const auto& c = row.comparison;
    const bool known = c.difference != metrics::Difference::too_few;
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} of {} | {} |\n", words_of(row),
                        markdown_cell(row.where()), markdown_cell(row.metric), number(row.a_median),
                        number(row.b_median), c.pairs ? percent(c.ratio) : "n/a",
                        known ? fmt::format("{} to {}", number(c.low), number(c.high)) : "n/a", row.b_better, row.seeds,
                        known ? p_value(c.p_adjusted) : "n/a");
  }
  if (rows.size() > kMostRows) text += fmt::format("\nand {} more\n", rows.size() - kMostRows);
  return text;
}

std::string folded(const std::string& title, const std::string& content) {
  return fmt::format("<details><summary>{}</summary>\n\n{}\n</details>\n\n", title, content);
}

std::string not_compared(const CompareInput& input) {
  std::map<std::string, std::size_t> counts;
  std::string list;
  std::size_t lines = 0;
  for (const CompareMissing& line : input.missing) {
    counts[line.kind] += line.count;
    if (++lines <= kMostRows)
      list += fmt::format("- {}: {}{}\n", line.kind, markdown_cell(line.what),
                          line.detail.empty() ? "" : ": " + markdown_cell(line.detail));
  }
  if (lines > kMostRows) list += fmt::format("- and {} more lines\n", lines - kMostRows);
  std::string title = "Not compared: ";
  std::string separator;
  for (const auto& [kind, count] : counts) {
    title += fmt::format("{}{} {}", separator, count, kind);
    separator = ", ";
  }
  return folded(title, list);
}

}  // namespace

std::string compare_markdown(const CompareInput& input, const std::string& link) {
  const CompareSummary summary = summary_of(input);
  std::string text =
      fmt::format("### tarmac compare: {} against {}\n\n", markdown_cell(input.b.label), markdown_cell(input.a.label));
  text += fmt::format("**{}**\n\n", markdown_cell(summary.sentence));
  if (!summary.note.empty()) text += markdown_cell(summary.note) + "\n\n";
  if (!link.empty()) text += fmt::format("The page: {}\n\n", markdown_cell(link));
  const auto significant = significant_rows(input), others = other_rows(input);
  if (!significant.empty()) text += table(significant) + "\n";
  if (!others.empty()) text += folded(fmt::format("Not significant ({})", others.size()), table(others));
  std::vector<const CompareRow*> costs, rest;
  for (const CompareRow& row : input.rows) {
    if (row.cost)
      costs.push_back(&row);
    else if (row.verdict == CompareVerdict::too_few || row.verdict == CompareVerdict::no_ratio)
      rest.push_back(&row);
  }
  if (!rest.empty()) text += folded(fmt::format("Too few seeds, or no ratio ({})", rest.size()), table(rest));
  if (!costs.empty())
    text +=
        folded(fmt::format("Cost ({}): depends on the machine and on what else it did", costs.size()), table(costs));
  if (!input.missing.empty()) text += not_compared(input);
  return text;
}

}  // namespace tarmac::reports
