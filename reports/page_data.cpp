#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "metrics/degeneracy/rule.h"
#include "reports/page.h"
#include "reports/page_comparisons.h"
#include "reports/page_json.h"
#include "reports/page_series.h"

namespace tarmac::reports {

namespace {

using nlohmann::json;

/// Series that belong to the truth: the same for every estimator of a run, so written once.
const std::set<std::string> kTruthSeries = {"path_true", "path_degenerate", "speed_vs_time", "yaw_rate_vs_time"};

bool is_of_truth(const std::string& series) {
  return kTruthSeries.contains(series) || series.starts_with("oracle_");
}

json thinned(const std::vector<double>& values, std::size_t step) {
  json list = json::array();
  for (std::size_t i = 0; i < values.size(); i += step) list.push_back(page_number(values[i]));
  return list;
}

/// Writes series; every distinct x once.
class SeriesWriter {
 public:
  explicit SeriesWriter(std::size_t max_samples) : max_samples_(max_samples) {}

  /// {x_label, y_label, first, step, x: number of its grid, y, low?, high?}
  json write(const metrics::Series& series) {
    const std::size_t step = std::max<std::size_t>(1, (series.x.size() + max_samples_ - 1) / max_samples_);
    const json grid = thinned(series.x, step);
    const auto [entry, is_new] = number_of_.try_emplace(grid.dump(), grids_.size());
    if (is_new) grids_.push_back(grid);
    json out = {{"x_label", series.x_label}, {"y_label", series.y_label},   {"step", step}, {"first", 0},
                {"x", entry->second},        {"y", thinned(series.y, step)}};
    if (!series.low.empty() && !series.high.empty()) {
      out["low"] = thinned(series.low, step);
      out["high"] = thinned(series.high, step);
    }
    return out;
  }

  const json& grids() const { return grids_; }

 private:
  std::size_t max_samples_;
  std::map<std::string, std::size_t> number_of_;  ///< by the grid's text
  json grids_ = json::array();
};

json to_json(const metrics::PairedComparison& c) {
  const bool few = c.difference == metrics::Difference::too_few;
  return {{"metric", c.metric},
          {"a", c.a},
          {"b", c.b},
          {"pairs", c.pairs},
          {"a_lower", c.a_lower},
          {"ratio", page_number(c.ratio)},
          {"low", few ? json() : page_number(c.low)},
          {"high", few ? json() : page_number(c.high)},
          {"p", page_number(c.p)},
          {"difference", metrics::name_of(c.difference)}};
}

json to_json(const metrics::Finding& finding) {
  json evidence = json::array();
  for (const auto& entry : finding.evidence) {
    evidence.push_back({{"name", entry.name},
                        {"unit", entry.unit},
                        {"value", entry.value ? page_number(*entry.value) : json()},
                        {"low", entry.low ? page_number(*entry.low) : json()},
                        {"high", entry.high ? page_number(*entry.high) : json()}});
  }
  return {{"topic", finding.topic},
          {"verdict", metrics::name_of(finding.verdict)},
          {"words", finding.words},
          {"evidence", evidence}};
}

json comparison_table(const std::vector<ReportRun>& runs) {
  json list = json::array();
  for (const auto& c : comparisons(runs)) list.push_back(to_json(c));
  return list;
}

json to_json(const metrics::Row& row) {
  json out = {{"estimate", row.estimate}, {"metric", row.metric}, {"unit", row.unit}, {"status", row.status}};
  out["value"] = row.value ? page_number(*row.value) : json();
  if (row.ci_low && row.ci_high) {
    out["low"] = page_number(*row.ci_low);
    out["high"] = page_number(*row.ci_high);
  }
  return out;
}

/// Where a reader finds the log: below the folder that the report was made from, never an absolute path.
std::string log_of(const ReportInput& input, const ReportRun& run, const std::string& estimator) {
  const std::filesystem::path inside = std::filesystem::path(estimator) / "log.txt";
  return (input.runs.size() > 1 ? run.folder.filename() / inside : inside).generic_string();
}

struct Collected {
  json runs = json::array(), truth = json::object();
  std::vector<std::string> estimators;
  std::vector<std::uint64_t> seeds;
  std::set<std::string> metrics;
};

template <class T>
void remember(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

/// How many a written series had before it was thinned, or a few more.
std::size_t samples(const json& series) {
  return series["y"].size() * series["step"].get<std::size_t>();
}

void collect(const ReportInput& input, const ReportRun& run, const metrics::Evaluation& evaluation,
             SeriesWriter& writer, Collected& into) {
  remember(into.estimators, evaluation.estimator);
  remember(into.seeds, evaluation.seed);
  json rows = json::array(), series = json::object(), findings = json::array();
  for (const auto& finding : evaluation.findings) findings.push_back(to_json(finding));
  for (const auto& row : evaluation.rows) {
    rows.push_back(to_json(row));
    into.metrics.insert(row.metric);
  }
  json& truth = into.truth[std::to_string(evaluation.seed)];
  if (truth.is_null()) truth = json::object();
  for (const auto& entry : evaluation.series) {
    const bool of_truth = is_of_truth(entry.name);
    // A method that failed early may know less of the truth than another.
    if (of_truth && truth.contains(entry.name) && samples(truth[entry.name]) >= entry.y.size()) continue;
    (of_truth ? truth : series)[entry.name] = writer.write(entry);
  }
  into.runs.push_back({{"estimator", evaluation.estimator},
                       {"seed", evaluation.seed},
                       {"status", evaluation.status},
                       {"message", evaluation.message},
                       {"coverage", page_number(evaluation.coverage)},
                       {"rows", rows},
                       {"series", series},
                       {"findings", findings},
                       {"log", log_of(input, run, evaluation.estimator)}});
}

json to_json(const Picture& picture) {
  return {{"src", fmt::format("data:{};base64,{}", picture.media_type, base64(picture.bytes))},
          {"width_px", picture.width_px},
          {"height_px", picture.height_px}};
}

json color_ramp() {
  json colors = json::array();
  constexpr int kSteps = 24;
  for (int k = 0; k <= kSteps; ++k) {
    const Eigen::Vector3f color = 255 * error_color(double(k) / kSteps);
    colors.push_back(
        fmt::format("#{:02x}{:02x}{:02x}", std::lround(color.x()), std::lround(color.y()), std::lround(color.z())));
  }
  return colors;
}

json to_json(const Pictures& pictures) {
  json out = {{"note", pictures.note}, {"maps", json::array()}};
  if (pictures.overview) out["overview"] = to_json(*pictures.overview);
  if (pictures.top) {
    out["top"] = to_json(*pictures.top);
    out["top"]["min_m"] = {pictures.top_view.min_m.x(), pictures.top_view.min_m.y()};
    out["top"]["max_m"] = {pictures.top_view.max_m.x(), pictures.top_view.max_m.y()};
  }
  for (const auto& map : pictures.maps) {
    out["maps"].push_back(to_json(map.picture));
    out["maps"].back()["estimator"] = map.estimator;
    out["maps"].back()["seed"] = map.seed;
  }
  out["scale"] = {{"low_m", pictures.scale.low_m}, {"high_m", pictures.scale.high_m}, {"colors", color_ramp()}};
  return out;
}

/// The command that makes the report's runs again: the first that a provenance names.
std::string command_of(const std::vector<ReportRun>& runs) {
  for (const auto& run : runs) {
    const json content = json::parse(run.provenance_json, nullptr, /*allow_exceptions=*/false);
    if (!content.is_object() || !content.contains("command")) continue;
    const json& command = content["command"];
    if (command.is_string()) return command.get<std::string>();
    std::string text;
    for (const auto& word : command) {
      text += (text.empty() ? "" : " ") + (word.is_string() ? word.get<std::string>() : word.dump());
    }
    return text;
  }
  return "";
}

}  // namespace

std::string page_data(const ReportInput& input, const Pictures& pictures) {
  Collected collected;
  SeriesWriter writer(longest_series(input.runs));
  json provenance = json::array();
  for (const auto& run : input.runs) {
    for (const auto& evaluation : run.evaluations) collect(input, run, evaluation, writer, collected);
    if (run.provenance_json.empty()) continue;
    const std::string folder = input.runs.size() > 1 ? run.folder.filename().string() : "";
    provenance.push_back({{"folder", folder}, {"text", run.provenance_json}});
  }
  std::sort(collected.seeds.begin(), collected.seeds.end());
  return inside_script({{"title", input.title},
                        {"picture_time_s", core::to_s(input.picture_time)},
                        {"estimators", collected.estimators},
                        {"seeds", collected.seeds},
                        {"metrics", metric_table(collected.metrics)},
                        {"runs", collected.runs},
                        {"comparisons", comparison_table(input.runs)},
                        {"truth", collected.truth},
                        {"oracle_thresholds",
                         {{"6dof", metrics::DegeneracyRule::pose().degenerate_below},
                          {"12dof_difference", metrics::DegeneracyRule::difference().degenerate_below}}},
                        {"grids", writer.grids()},
                        {"pictures", to_json(pictures)},
                        {"command", command_of(input.runs)},
                        {"provenance", provenance}});
}

}  // namespace tarmac::reports
