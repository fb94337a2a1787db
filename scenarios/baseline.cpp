#include "scenarios/baseline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/config.h"
#include "core/error.h"
#include "core/files.h"

namespace tarmac::scenarios {
namespace {

constexpr int kFormat = 1;

/// YAML's single quotes: any text on one line comes back as it was.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    out += c;
    if (c == '\'') out += c;
  }
  return out + "'";
}

std::uint64_t seed_of(const core::ConfigNode& node, const std::string& key) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), seed);
  if (error != std::errc() || end != key.data() + key.size())
    node.fail(fmt::format("'{}' is no seed; expected {{seed: value, ...}}", key));
  return seed;
}

std::optional<double> value_of(const core::ConfigNode& values, const std::string& key) {
  const std::string text = values.child(key).scalar(key.c_str());
  if (text == "n/a") return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    values.fail(fmt::format("seed {}: '{}' is no number; expected one, or n/a", key, text));
  return value;
}

void read_recordings(const core::ConfigNode& node, Baseline& baseline) {
  for (const core::ConfigNode& entry : node.items()) {
    entry.allow_only({"case", "hashes"});
    auto& hashes = baseline.recordings[entry.child("case").scalar("case")];
    for (const std::string& key : entry.child("hashes").keys())
      hashes[seed_of(entry, key)] = entry.child("hashes").child(key).scalar(key.c_str());
  }
}

void read_values(const core::ConfigNode& node, Baseline& baseline) {
  for (const core::ConfigNode& entry : node.items()) {
    entry.allow_only({"case", "scenario", "estimator", "estimate", "metric", "values"});
    const auto word = [&](const char* key) { return entry.child(key).scalar(key); };
    const BaselineKey key{word("case"), word("estimator"), word("metric"), word("estimate")};
    baseline.scenario_of[key.case_name] = word("scenario");
    if (baseline.values.count(key)) entry.fail("stands twice");
    auto& values = baseline.values[key];
    for (const std::string& seed : entry.child("values").keys())
      values[seed_of(entry, seed)] = value_of(entry.child("values"), seed);
  }
}

/// Of one cell: its recording and its values.
void add_cell(const CellResult& result, const std::vector<std::string>& metrics, Baseline& baseline) {
  const Cell& cell = result.cell;
  if (!result.outcome.recording_hash.empty())
    baseline.recordings[cell.case_name][cell.seed] = result.outcome.recording_hash;
  if (result.outcome.status != "ok") return;
  for (const std::string& metric : metrics)
    for (const char* estimate : {"causal", "final"}) {
      const MetricValue* value = find_value(result, metric, estimate);
      if (!value) continue;
      const bool number = value->value && std::isfinite(*value->value);
      baseline.values[{cell.case_name, cell.estimator, metric, estimate}][cell.seed] =
          number ? value->value : std::nullopt;
    }
}

BaselineChange change_of(const BaselineKey& key, const std::map<std::uint64_t, std::optional<double>>* before,
                         const std::map<std::uint64_t, std::optional<double>>* after) {
  BaselineChange change;
  change.key = key;
  change.kind = !before  ? BaselineChange::Kind::added
                : !after ? BaselineChange::Kind::gone
                         : BaselineChange::Kind::changed;
  if (before) change.before = median_of(numbers_of(*before)), change.seeds_before = before->size();
  if (after) change.after = median_of(numbers_of(*after)), change.seeds_after = after->size();
  if (change.before && change.after && *change.before > 0)
    change.change_percent = 100 * (*change.after / *change.before - 1);
  return change;
}

}  // namespace

Baseline load_baseline(const std::filesystem::path& file) {
  const core::ConfigNode node = core::ConfigNode::load(file.string());
  node.allow_only({"format", "sweeps", "build", "recordings", "values"});
  if (node.child("format").scalar("format") != std::to_string(kFormat))
    node.fail_at(
        "format",
        fmt::format("this program reads format {}; write the file anew with `tarmac baseline update`", kFormat));
  Baseline baseline;
  baseline.file = file.string();
  baseline.build = node.child("build").scalar("build");
  for (const core::ConfigNode& sweep : node.child("sweeps").items()) baseline.sweeps.push_back(sweep.scalar("sweeps"));
  read_recordings(node.child("recordings"), baseline);
  read_values(node.child("values"), baseline);
  return baseline;
}

std::string baseline_text(const Baseline& baseline) {
  std::vector<std::string> sweeps;
  for (const std::string& sweep : baseline.sweeps) sweeps.push_back(quoted(sweep));
  std::string text = fmt::format(
      "# Written by `tarmac baseline update`: values by seed that a gate holds a sweep's results to. Not edited by "
      "hand.\n"
      "format: {}\nsweeps: [{}]\nbuild: {}\n",
      kFormat, fmt::join(sweeps, ", "), quoted(baseline.build));
  text += baseline.recordings.empty() ? "recordings: []\n" : "recordings:\n";
  for (const auto& [case_name, hashes] : baseline.recordings) {
    std::vector<std::string> entries;
    for (const auto& [seed, hash] : hashes) entries.push_back(fmt::format("{}: {}", seed, quoted(hash)));
    text += fmt::format("  - {{case: {}, hashes: {{{}}}}}\n", quoted(case_name), fmt::join(entries, ", "));
  }
  text += baseline.values.empty() ? "values: []\n" : "values:\n";
  for (const auto& [key, values] : baseline.values) {
    std::vector<std::string> entries;
    for (const auto& [seed, value] : values)
      entries.push_back(fmt::format("{}: {}", seed, value ? fmt::format("{:.17g}", *value) : "n/a"));
    const auto scenario = baseline.scenario_of.find(key.case_name);
    text += fmt::format("  - {{case: {}, scenario: {}, estimator: {}, estimate: {}, metric: {}, values: {{{}}}}}\n",
                        quoted(key.case_name), quoted(scenario == baseline.scenario_of.end() ? "" : scenario->second),
                        quoted(key.estimator), key.estimate, key.metric, fmt::join(entries, ", "));
  }
  return text;
}

void save_baseline(const std::filesystem::path& file, const Baseline& baseline) {
  core::write_file(file, baseline_text(baseline));
}

Baseline make_baseline(std::span<const CellResult> results, const std::vector<std::string>& metrics) {
  Baseline baseline;
  std::set<std::tuple<std::string, std::string, std::uint64_t>> seen;
  for (const CellResult& result : results) {
    const Cell& cell = result.cell;
    if (!seen.emplace(cell.case_name, cell.estimator, cell.seed).second)
      throw core::InputError(fmt::format("case '{}', {}, seed {} comes twice: give each sweep's folder once",
                                         cell.case_name, cell.estimator, cell.seed));
    baseline.scenario_of[cell.case_name] = cell.scenario;
    add_cell(result, metrics, baseline);
  }
  return baseline;
}

BaselineDifference difference_of(const Baseline& before, const Baseline& after) {
  BaselineDifference difference;
  std::set<BaselineKey> keys;
  for (const Baseline* baseline : {&before, &after})
    for (const auto& [key, values] : baseline->values) keys.insert(key);
  for (const BaselineKey& key : keys) {
    const auto old = before.values.find(key), now = after.values.find(key);
    const auto* old_values = old == before.values.end() ? nullptr : &old->second;
    const auto* new_values = now == after.values.end() ? nullptr : &now->second;
    if (old_values && new_values && *old_values == *new_values)
      ++difference.unchanged;
    else
      difference.changes.push_back(change_of(key, old_values, new_values));
  }
  for (const auto& [case_name, hashes] : before.recordings) {
    const auto other = after.recordings.find(case_name);
    if (other == after.recordings.end()) continue;
    for (const auto& [seed, hash] : hashes)
      if (const auto found = other->second.find(seed); found != other->second.end()) {
        ++difference.recordings_shared;
        if (found->second != hash) ++difference.recordings_changed;
      }
  }
  return difference;
}

std::optional<double> median_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::vector<double> numbers_of(const std::map<std::uint64_t, std::optional<double>>& values) {
  std::vector<double> numbers;
  for (const auto& [seed, value] : values)
    if (value) numbers.push_back(*value);
  return numbers;
}

}  // namespace tarmac::scenarios
