// `tarmac gate`: a sweep's results against a gate file.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "reports/gate_reports.h"
#include "scenarios/store.h"
#include "scenarios/sweep_file.h"
#include "tools/gates/judge.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/results_table.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using reports::GateReport;
using reports::GateReportRow;
using reports::GateVerdict;
using Json = nlohmann::ordered_json;

constexpr int kGateFailed = 1;

std::string today_utc() {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

void print_report(const GateReport& report) {
  std::vector<std::vector<std::string>> lines = {{"case", "estimator", "metric", "value", "baseline", "change",
                                                  "95 % interval", "p adjusted", "detectable", "verdict"}};
  for (const GateReportRow& row : report.rows)
    lines.push_back({row.case_name, row.estimator, row.metric, reports::value_text(row.value),
                     row.baseline ? reports::value_text(row.baseline) : "", reports::percent_text(row.change_percent),
                     reports::interval_text(row), reports::p_text(row.p_adjusted),
                     reports::detectable_text(row.detectable_percent), reports::name_of(row.verdict)});
  print_table(lines);
  for (const GateReportRow& row : report.rows) {
    if (row.verdict == GateVerdict::pass) continue;
    fmt::print("{}: {} {} {}: {}: {}\n", reports::name_of(row.verdict), row.case_name, row.estimator, row.metric,
               row.rule, row.reason);
    if (row.verdict == GateVerdict::inconclusive) continue;
    for (const std::string& line : row.evidence) fmt::print("  {}\n", line);
  }
  for (const std::string& note : report.notes) fmt::print("note: {}\n", note);
  fmt::print("{}\n", reports::headline(report));
}

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

void print_json(const GateReport& report) {
  Json rows = Json::array();
  for (const GateReportRow& row : report.rows)
    rows.push_back({{"gate", report.gate},
                    {"case", row.case_name},
                    {"estimator", row.estimator},
                    {"metric", row.metric},
                    {"unit", row.unit},
                    {"rule", row.rule},
                    {"verdict", reports::name_of(row.verdict)},
                    {"reason", row.reason},
                    {"value", number(row.value)},
                    {"baseline", number(row.baseline)},
                    {"pairs", row.pairs},
                    {"change_percent", number(row.change_percent)},
                    {"change_low_percent", number(row.change_low_percent)},
                    {"change_high_percent", number(row.change_high_percent)},
                    {"p", number(row.p)},
                    {"p_adjusted", number(row.p_adjusted)},
                    {"detectable_percent", number(row.detectable_percent)},
                    {"report_only_until", row.report_only_until},
                    {"evidence", row.evidence}});
  fmt::print("{}\n", rows.dump(1, ' ', false, Json::error_handler_t::replace));
}

GateReport judge(const GateArguments& arguments) {
  const scenarios::GateFile gate =
      scenarios::load_gate(scenarios::find_beside_scenarios(arguments.gate, "gates", scenario_folders()));
  check_metrics(gate);
  std::optional<scenarios::Baseline> baseline;
  if (!gate.baseline.empty()) baseline = scenarios::load_baseline(gate.baseline);
  const scenarios::Store store = scenarios::Store::open(arguments.folder, scenarios::Store::Access::read_only);
  if (!gate.sweep.empty() && gate.sweep != store.identity().sweep)
    throw core::InputError(fmt::format("{}: holds results of the sweep '{}', and {} is for '{}'", arguments.folder,
                                       store.identity().sweep, gate.file, gate.sweep));
  return judge_gate({&gate, store.results({}), store.unfinished(), baseline ? &*baseline : nullptr,
                     store.identity().build, arguments.folder, today_utc(), store.holds_whole_plan()});
}

/// So that a page of tests shows why nothing was judged, and no report of an earlier run is taken for this one's.
void write_error(const GateArguments& arguments, const std::string& message) {
  const std::string gate = fs::path(arguments.gate).stem().string();
  if (!arguments.junit.empty()) core::write_file(arguments.junit, reports::junit_error_xml(gate, message));
  if (!arguments.markdown.empty()) core::write_file(arguments.markdown, reports::gate_error_markdown(gate, message));
}

GateReport judge_or_write_error(const GateArguments& arguments) {
  try {
    return judge(arguments);
  } catch (const core::InputError& error) {
    try {
      write_error(arguments, error.what());
    } catch (const core::InputError& no_report) {
      throw core::InputError(fmt::format("{}\nand that could not be reported: {}", error.what(), no_report.what()));
    }
    throw;
  }
}

}  // namespace

int gate_command(const GateArguments& arguments, const CommonArguments& common) {
  const GateReport report = judge_or_write_error(arguments);
  if (!arguments.junit.empty()) core::write_file(arguments.junit, reports::junit_xml(report));
  if (!arguments.markdown.empty()) core::write_file(arguments.markdown, reports::gate_markdown(report, arguments.link));
  common.json ? print_json(report) : print_report(report);
  return report.failed() ? kGateFailed : 0;
}

}  // namespace tarmac::tools
