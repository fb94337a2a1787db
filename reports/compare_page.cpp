#include "reports/compare_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/page.h"
#include "reports/page_json.h"
#include "reports/web_bundle.h"

namespace tarmac::reports {

namespace {

using nlohmann::json;

json optional_number(const std::optional<double>& value) {
  return value ? page_number(*value) : json();
}

const char* name_of(metrics::Better better) {
  switch (better) {
    case metrics::Better::lower:
      return "lower";
    case metrics::Better::higher:
      return "higher";
    case metrics::Better::neither:
      return "neither";
  }
  return "neither";
}

json to_json(const CompareSide& side) {
  return {{"label", side.label},
          {"folder", side.folder},
          {"estimator", side.estimator},
          {"build", side.build},
          {"runs", side.cells}};
}

json to_json(const CompareRow& row) {
  const metrics::PairedComparison& c = row.comparison;
  const bool known = c.difference != metrics::Difference::too_few;
  return {{"case", row.case_name},
          {"a", row.estimator_a},
          {"b", row.estimator_b},
          {"metric", row.metric},
          {"unit", row.unit},
          {"estimate", row.estimate},
          {"cost", row.cost},
          {"magnitude", row.magnitude},
          {"better", name_of(row.better)},
          {"seeds", row.seeds},
          {"b_better", row.b_better},
          {"a_median", optional_number(row.a_median)},
          {"b_median", optional_number(row.b_median)},
          {"pairs", c.pairs},
          {"ratio", c.pairs > 0 ? page_number(c.ratio) : json()},
          {"low", known ? page_number(c.low) : json()},
          {"high", known ? page_number(c.high) : json()},
          {"p", known ? page_number(c.p) : json()},
          {"p_adjusted", known ? page_number(c.p_adjusted) : json()},
          {"verdict", reports::name_of(row.verdict)},
          {"words", words_of(row)}};
}

json to_json(const metrics::SeriesComparison& series) {
  json stretches = json::array();
  for (const auto& stretch : series.stretches)
    stretches.push_back({{"from", page_number(stretch.from)},
                         {"to", page_number(stretch.to)},
                         {"difference", page_number(stretch.difference)}});
  return {{"name", series.name},
          {"x_label", series.x_label},
          {"y_label", series.y_label},
          {"pairs", series.pairs},
          {"x", page_numbers(series.x)},
          {"a", page_numbers(series.a)},
          {"b", page_numbers(series.b)},
          {"block_x", page_numbers(series.block_x)},
          {"difference", page_numbers(series.difference)},
          {"low", page_numbers(series.low)},
          {"high", page_numbers(series.high)},
          {"block_length", page_number(series.block_length)},
          {"level", page_number(series.level)},
          {"stretches", stretches}};
}

json to_json(const CompareDrive& drive) {
  json series = json::array();
  for (const auto& one : drive.series) series.push_back(to_json(one));
  json path;
  if (!drive.path_t_s.empty())
    path = {{"seed", drive.path_seed},
            {"t", page_numbers(drive.path_t_s)},
            {"x", page_numbers(drive.path_x_m)},
            {"y", page_numbers(drive.path_y_m)}};
  return {{"case", drive.case_name},
          {"a", drive.estimator_a},
          {"b", drive.estimator_b},
          {"seeds", drive.seeds},
          {"located", drive.located},
          {"series", series},
          {"path", path}};
}

std::string title_of(const CompareInput& input) {
  return fmt::format("{} against {}", input.b.label, input.a.label);
}

std::string header(const CompareInput& input) {
  const CompareSummary summary = summary_of(input);
  constexpr const char* kNoScript =
      "<noscript><p class=\"note\">The tables and lines of this page are drawn by the script inside it, which your "
      "browser has switched off. `tarmac compare` prints the same figures.</p></noscript>\n";
  std::string html =
      "<header>\n<div class=\"plate\"><span class=\"wordmark\">Tarmac</span><div id=\"theme\"></div></div>\n";
  html += fmt::format("<h1>{}</h1>\n<p class=\"verdict\">{}</p>\n", escape_html(title_of(input)),
                      escape_html(summary.sentence));
  html += fmt::format("<p class=\"verdict-note\">{}</p>\n", escape_html(summary.note));
  if (input.different_recordings > 0)
    html += fmt::format("<p class=\"note\">{}</p>\n", escape_html(summary.recordings));
  return html + kNoScript + "<div id=\"sides\"></div>\n</header>\n";
}

}  // namespace

std::string compare_page_data(const CompareInput& input) {
  const CompareSummary summary = summary_of(input);
  json rows = json::array(), drives = json::array(), missing = json::array(), provenance = json::array();
  std::set<std::string> metrics;
  for (const CompareRow& row : input.rows) {
    rows.push_back(to_json(row));
    metrics.insert(row.metric);
  }
  for (const CompareDrive& drive : input.drives) drives.push_back(to_json(drive));
  for (const CompareMissing& line : input.missing)
    missing.push_back({{"kind", line.kind}, {"what", line.what}, {"detail", line.detail}, {"count", line.count}});
  for (const CompareSide* side : {&input.a, &input.b})
    provenance.push_back({{"folder", side->label}, {"text", side->provenance_json}});
  return inside_script({{"a", to_json(input.a)},
                        {"b", to_json(input.b)},
                        {"metrics", metric_table(metrics)},
                        {"rows", rows},
                        {"drives", drives},
                        {"drives_left_out", input.drives_left_out},
                        {"missing", missing},
                        {"tested", summary.tested},
                        {"recordings",
                         {{"same", input.same_recordings},
                          {"different", input.different_recordings},
                          {"unknown", input.unknown_recordings},
                          {"words", summary.recordings}}},
                        {"command", input.command},
                        {"provenance", provenance}});
}

std::string assemble_compare_page(const CompareInput& input) {
  std::string body = header(input);
  body += "<div id=\"legend\"><nav aria-label=\"Contents\"></nav><div class=\"bar\"></div></div>\n<main>\n";
  for (const char* id : {"changes", "drive", "rows", "cost", "missing", "provenance"})
    body += fmt::format("<section id=\"{}\"></section>\n", id);
  body += "</main>\n";
  return frame_page(title_of(input), compare_style(), body, compare_page_data(input), compare_script());
}

}  // namespace tarmac::reports
