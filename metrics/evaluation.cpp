#include "metrics/evaluation.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/chunk_file.h"
#include "core/error.h"
#include "core/files.h"
#include "metrics/registry.h"

namespace tarmac::metrics {

using namespace core;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kFormat = 2;  // 2: findings
constexpr const char* kMain = "evaluation.json";
constexpr const char* kCost = "cost.json";
constexpr const char* kMap = "map_sample.bin";
constexpr const char* kDegeneracy = "degeneracy.csv";

bool is_cost(const Row& row) {
  const MetricEntry* entry = find_metric(row.metric);
  return entry && std::string(entry->family) == "cost";
}
bool is_cost(const Series& series) {
  return series.name == "sweep_time_vs_time";
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}
Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

std::optional<double> optional_number(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional<double>(json.get<double>());
}
std::vector<double> number_list(const Json& json) {
  std::vector<double> values;
  for (const Json& item : json)
    values.push_back(optional_number(item).value_or(std::numeric_limits<double>::quiet_NaN()));
  return values;
}

Json to_json(const Row& row) {
  return {{"estimate", row.estimate}, {"metric", row.metric},         {"value", number(row.value)},
          {"unit", row.unit},         {"ci_low", number(row.ci_low)}, {"ci_high", number(row.ci_high)},
          {"status", row.status}};
}
Row row_from(const Json& json) {
  Row row;
  row.estimate = json.at("estimate");
  row.metric = json.at("metric");
  row.value = optional_number(json.at("value"));
  row.unit = json.at("unit");
  row.ci_low = optional_number(json.at("ci_low"));
  row.ci_high = optional_number(json.at("ci_high"));
  row.status = json.at("status");
  return row;
}

Json to_json(const Series& s) {
  return {{"name", s.name},    {"x_label", s.x_label},  {"y_label", s.y_label},   {"x", numbers(s.x)},
          {"y", numbers(s.y)}, {"low", numbers(s.low)}, {"high", numbers(s.high)}};
}
Series series_from(const Json& json) {
  return {
      json.at("name"),           json.at("x_label"),          json.at("y_label"),          number_list(json.at("x")),
      number_list(json.at("y")), number_list(json.at("low")), number_list(json.at("high"))};
}

Json to_json(const Finding& f) {
  Json evidence = Json::array();
  for (const Finding::Number& n : f.evidence)
    evidence.push_back({{"name", n.name},
                        {"value", number(n.value)},
                        {"unit", n.unit},
                        {"low", number(n.low)},
                        {"high", number(n.high)}});
  return {{"topic", f.topic}, {"verdict", name_of(f.verdict)}, {"words", f.words}, {"evidence", std::move(evidence)}};
}
Finding finding_from(const Json& json) {
  Finding f;
  f.topic = json.at("topic");
  const std::string verdict = json.at("verdict");
  using Verdict = Finding::Verdict;
  for (const Verdict known : {Verdict::found, Verdict::nothing_found, Verdict::cannot_be_told})
    if (verdict == name_of(known)) f.verdict = known;
  f.words = json.at("words");
  for (const Json& n : json.at("evidence"))
    f.evidence.push_back({n.at("name"), optional_number(n.at("value")), n.at("unit"), optional_number(n.at("low")),
                          optional_number(n.at("high"))});
  return f;
}

/// The rows and series of one of the two files.
Json part(const Evaluation& e, bool cost) {
  Json json{{"format", kFormat}};
  if (!cost) {
    json["scenario"] = e.scenario;
    json["seed"] = e.seed;
    json["estimator"] = e.estimator;
    json["status"] = e.status;
    json["message"] = e.message;
    json["coverage"] = number(e.coverage);
  }
  json["rows"] = Json::array();
  for (const Row& row : e.rows)
    if (is_cost(row) == cost) json["rows"].push_back(to_json(row));
  json["series"] = Json::array();
  for (const Series& series : e.series)
    if (is_cost(series) == cost) json["series"].push_back(to_json(series));
  if (!cost) {
    json["findings"] = Json::array();
    for (const Finding& finding : e.findings) json["findings"].push_back(to_json(finding));
  }
  return json;
}

/// A crashed program's last words need not be UTF-8: what is not is replaced.
std::string text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Calls `use` with the parsed file; whatever is missing or of a wrong type becomes DamagedFile.
template <class Use>
void with_json(const std::filesystem::path& file, const Use& use) {
  try {
    const Json json = Json::parse(read_file(file));
    if (json.at("format") != kFormat)
      throw DamagedFile(fmt::format("{}: format {}, this program reads {}; evaluate again", file.string(),
                                    json.at("format").dump(), kFormat));
    use(json);
  } catch (const nlohmann::json::exception& e) {
    throw DamagedFile(fmt::format("{}: not a whole evaluation ({}); evaluate again", file.string(), e.what()));
  }
}

void read_rows_and_series(const Json& json, Evaluation& e) {
  for (const Json& row : json.at("rows")) e.rows.push_back(row_from(row));
  for (const Json& series : json.at("series")) e.series.push_back(series_from(series));
}

void save_map(const std::filesystem::path& file, const MapSample& map) {
  const std::filesystem::path temporary = file.string() + ".partial";
  ChunkData data;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> column;
    for (const Eigen::Vector3f& p : map.p_world_m) column.push_back(p[axis]);
    data.add(std::span<const float>(column));
  }
  data.add(std::span<const float>(map.error_m));
  data.add(std::span<const std::uint8_t>(map.moving));
  ChunkWriter writer(temporary);
  writer.append(Time{}, data);
  writer.finish();
  std::filesystem::rename(temporary, file);
}

MapSample load_map(const std::filesystem::path& file) {
  const ChunkReader reader(file);
  if (reader.size() != 1)
    throw DamagedFile(
        fmt::format("{}: {} chunks where a map sample has 1; evaluate again", file.string(), reader.size()));
  const ChunkData data = reader.read(0);
  const std::vector<float> x = data.column<float>(0), y = data.column<float>(1), z = data.column<float>(2);
  MapSample map;
  map.error_m = data.column<float>(3);
  map.moving = data.column<std::uint8_t>(4);
  if (y.size() != x.size() || z.size() != x.size() || map.error_m.size() != x.size() || map.moving.size() != x.size())
    throw DamagedFile(fmt::format("{}: columns of unequal length; evaluate again", file.string()));
  for (std::size_t i = 0; i < x.size(); ++i) map.p_world_m.emplace_back(x[i], y[i], z[i]);
  return map;
}

}  // namespace

const char* name_of(Finding::Verdict verdict) {
  switch (verdict) {
    case Finding::Verdict::found:
      return "found";
    case Finding::Verdict::nothing_found:
      return "nothing found";
    default:
      return "cannot be told";
  }
}

const Row* Evaluation::row(const std::string& metric, const std::string& estimate) const {
  for (const Row& row : rows)
    if (row.metric == metric && row.estimate == estimate) return &row;
  return nullptr;
}

const Series* Evaluation::find(const std::string& name) const {
  for (const Series& s : series)
    if (s.name == name) return &s;
  return nullptr;
}

void save_evaluation(const std::filesystem::path& folder, const Evaluation& evaluation) {
  std::filesystem::create_directories(folder);
  if (evaluation.map.p_world_m.empty())
    std::filesystem::remove(folder / kMap);
  else
    save_map(folder / kMap, evaluation.map);
  if (evaluation.degeneracy_csv.empty())
    std::filesystem::remove(folder / kDegeneracy);
  else
    write_file(folder / kDegeneracy, evaluation.degeneracy_csv);
  write_file(folder / kCost, text(part(evaluation, true)));
  write_file(folder / kMain, text(part(evaluation, false)));
}

Evaluation load_evaluation(const std::filesystem::path& folder) {
  Evaluation e;
  with_json(folder / kMain, [&](const Json& json) {
    e.scenario = json.at("scenario");
    e.seed = json.at("seed");
    e.estimator = json.at("estimator");
    e.status = json.at("status");
    e.message = json.at("message");
    e.coverage = optional_number(json.at("coverage")).value_or(0);
    read_rows_and_series(json, e);
    for (const Json& finding : json.at("findings")) e.findings.push_back(finding_from(finding));
  });
  if (std::filesystem::exists(folder / kCost))
    with_json(folder / kCost, [&](const Json& json) { read_rows_and_series(json, e); });
  if (std::filesystem::exists(folder / kMap)) e.map = load_map(folder / kMap);
  return e;
}

}  // namespace tarmac::metrics
