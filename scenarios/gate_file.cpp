#include "scenarios/gate_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "core/error.h"

namespace tarmac::scenarios {
namespace {

struct TopLevel {
  GateFile& gate;
  std::string& baseline;
  void visit(core::OptionVisitor& v) {
    v("name", gate.name, "kebab-case name, the same as the file's");
    v("why", gate.why, "what the gate is there to prevent");
    v("sweep", gate.sweep, "name of the sweep whose results it judges; without it, any");
    v("baseline", baseline, "file that `tarmac baseline update` wrote; relative to this file's folder");
    v("alpha", gate.alpha, "chance of a false red by a non_inferior row", {.above = 0, .below = 0.5});
    v("holm", gate.holm, "alpha is for all non_inferior rows together, by Holm's rule; false: for each");
    v("report_only_until", gate.report_only_until, "day (YYYY-MM-DD) up to which reds are shown and do not fail");
  }
};

/// The numbers and words of a row; which of them stand in the file is asked of the node.
struct RowFields {
  double max = 0, min = 0;
  std::string of = "median", estimate, report_only_until;
  std::vector<std::string> allow;
  void visit(core::OptionVisitor& v) {
    v("max", max, "the value may not be above");
    v("min", min, "the value may not be below");
    v.choice("of", of, {"median", "mean", "every"}, "which value over seeds max and min are for");
    v.choice("estimate", estimate, {"", "causal", "final"}, "which estimate; without it, the headline");
    v("report_only_until", report_only_until, "day (YYYY-MM-DD) up to which a red is shown and does not fail");
    v("allow", allow, "outcomes that do not fail the row: not_initialised");
  }
};

struct RelativeFields {
  double increase = 0, decrease = 0;
  void visit(core::OptionVisitor& v) {
    v("max_increase_percent", increase, "the median may not be above the baseline's by more", {.at_least = 0});
    v("max_decrease_percent", decrease, "the median may not be below the baseline's by more",
      {.at_least = 0, .at_most = 100});
  }
};

struct NonInferiorFields {
  double margin = 0;
  int min_pairs = 3;
  void visit(core::OptionVisitor& v) {
    v("margin_percent", margin, "worsening of the ratio that is no regression yet", {.at_least = 0});
    v("min_pairs", min_pairs, "fewer pairs of seeds fail the row: it would say nothing", {.at_least = 2});
  }
};

/// A word or a list of words, none empty.
std::vector<std::string> words_of(const core::ConfigNode& row, const char* key) {
  const core::ConfigNode node = row.child(key);
  if (!node.present()) row.fail_at(key, "is missing; expected a name, a pattern such as 'quick-*', or a list of them");
  std::vector<std::string> words;
  if (node.is_list())
    for (const core::ConfigNode& item : node.items()) words.push_back(item.scalar(key));
  else
    words.push_back(node.scalar(key));
  if (words.empty()) node.fail("is empty; expected at least one name");
  for (const std::string& word : words)
    if (word.empty()) node.fail("a name is empty");
  return words;
}

bool is_day(const std::string& text) {
  int year = 0, month = 0, day = 0, length = 0;
  if (text.size() != 10 || std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &length) != 3) return false;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  return length == 10 && year >= 1000 && month > 0 && day > 0 && date.ok();
}

void check_day(const core::ConfigNode& node, const std::string& day) {
  if (!day.empty() && !is_day(day))
    node.fail_at("report_only_until", fmt::format("'{}' is no day; expected one such as 2026-12-31", day));
}

std::optional<double> if_present(const core::ConfigNode& node, const char* key, double value) {
  return node.child(key).present() ? std::optional(value) : std::nullopt;
}

AbsoluteRule absolute_rule(const core::ConfigNode& row, const RowFields& fields) {
  AbsoluteRule rule{if_present(row, "max", fields.max), if_present(row, "min", fields.min), GateStatistic::median};
  if (fields.of == "mean") rule.of = GateStatistic::mean;
  if (fields.of == "every") rule.of = GateStatistic::every;
  if (rule.max && rule.min && *rule.min > *rule.max) row.fail_at("min", "is above max: no value could pass");
  return rule;
}

RelativeRule relative_rule(const core::ConfigNode& node) {
  RelativeFields fields;
  node.read(fields);
  const RelativeRule rule{if_present(node, "max_increase_percent", fields.increase),
                          if_present(node, "max_decrease_percent", fields.decrease)};
  if (!rule.max_increase_percent && !rule.max_decrease_percent)
    node.fail("expected max_increase_percent or max_decrease_percent");
  return rule;
}

NonInferiorRule non_inferior_rule(const core::ConfigNode& node) {
  NonInferiorFields fields;
  node.read(fields);
  return {fields.margin, static_cast<std::size_t>(fields.min_pairs)};
}

void read_rule(const core::ConfigNode& node, const RowFields& fields, GateRow& row) {
  const bool absolute = node.child("max").present() || node.child("min").present();
  const bool relative = node.child("relative").present(), paired = node.child("non_inferior").present();
  if (absolute + relative + paired != 1)
    node.fail(fmt::format("a row holds its values to one thing: max and/or min, or relative, or non_inferior; {}",
                          absolute + relative + paired == 0 ? "this one has none" : "write a row for each"));
  if (!absolute && node.child("of").present()) node.fail_at("of", "belongs to max and min");
  if (absolute) row.absolute = absolute_rule(node, fields);
  if (relative) row.relative = relative_rule(node.child("relative"));
  if (paired) row.non_inferior = non_inferior_rule(node.child("non_inferior"));
}

GateRow read_row(const core::ConfigNode& node, const GateFile& gate) {
  if (!node.is_block()) node.fail("a row is a block: {case: ..., estimator: ..., metric: ..., max: ...}");
  RowFields fields;
  node.read(fields, {"case", "scenario", "estimator", "metric", "relative", "non_inferior"});
  GateRow row;
  row.node = node;
  row.by_scenario = node.child("scenario").present();
  if (row.by_scenario && node.child("case").present()) node.fail_at("scenario", "give case or scenario, not both");
  row.places = words_of(node, row.by_scenario ? "scenario" : "case");
  row.estimators = words_of(node, "estimator");
  row.metrics = words_of(node, "metric");
  row.estimate = fields.estimate;
  for (const std::string& allowed : fields.allow) {
    if (allowed != "not_initialised")
      node.fail_at("allow", fmt::format("'{}' cannot be allowed; expected [not_initialised]", allowed));
    row.allow_not_initialised = true;
  }
  check_day(node, fields.report_only_until);
  row.report_only_until = fields.report_only_until.empty() ? gate.report_only_until : fields.report_only_until;
  read_rule(node, fields, row);
  if (!row.absolute && gate.baseline.empty())
    node.fail("is held to a baseline, and the gate file names none: add `baseline: FILE`");
  return row;
}

}  // namespace

GateFile load_gate(const std::filesystem::path& file) {
  const core::ConfigNode node = core::ConfigNode::load(file.string());
  if (!node.is_block()) node.fail("a gate is a block of `key: value` lines");
  GateFile gate;
  gate.file = file.string();
  std::string baseline;
  TopLevel top{gate, baseline};
  node.read(top, {"rows"});
  if (gate.name.empty()) node.fail_at("name", "is missing; expected a name such as regression");
  check_day(node, gate.report_only_until);
  if (!baseline.empty()) gate.baseline = (file.parent_path() / baseline).lexically_normal();
  const core::ConfigNode rows = node.child("rows");
  if (!rows.present() || !rows.is_list() || rows.items().empty())
    node.fail_at("rows", "is missing or empty; expected a list of rows: a gate without any says nothing");
  for (const core::ConfigNode& row : rows.items()) gate.rows.push_back(read_row(row, gate));
  return gate;
}

bool matches_pattern(const std::string& pattern, const std::string& text) {
  // `star` is where to go on from when what follows the last `*` does not fit: that `*` then takes one more letter.
  std::size_t p = 0, t = 0, star = std::string::npos, taken = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

}  // namespace tarmac::scenarios
