/// A gate's verdict as text: JUnit XML for a CI's test page, Markdown for a pull request. Plain data in, text out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tarmac::reports {

enum class GateVerdict : std::uint8_t {
  pass = 0,
  fail = 1,
  inconclusive = 2,  ///< neither shown worse nor shown not to be: reported, not red
  report_only = 3,   ///< a fail that does not count yet
};
const char* name_of(GateVerdict verdict);  ///< "pass", "FAIL", "inconclusive", "report-only"

struct GateReportRow {
  std::string case_name, estimator, metric, unit;
  std::string rule;  ///< in words: "median at most 0.5", "no worse (margin 0 %)"
  GateVerdict verdict = GateVerdict::pass;
  std::string reason;                     ///< why; for inconclusive the change that could have been seen
  std::optional<double> value, baseline;  ///< what was compared: medians over seeds, or the statistic of the bound
  std::optional<double> change_percent;   ///< new against baseline, in the metric's own direction
  std::optional<double> change_low_percent, change_high_percent;  ///< 95 % interval
  std::optional<double> p, p_adjusted;                            ///< one-sided, of "no worse than the margin"
  std::optional<double> detectable_percent;  ///< worsening that would have been red in 80 % of such comparisons
  std::size_t pairs = 0;
  std::string report_only_until;      ///< where it is report_only
  std::vector<std::string> evidence;  ///< lines: logs, commands
};

struct GateReport {
  std::string gate, why;
  std::string build, baseline_build;
  std::vector<std::string> notes;  ///< what to know of the whole comparison
  std::vector<GateReportRow> rows;

  std::size_t count(GateVerdict verdict) const;
  bool failed() const { return count(GateVerdict::fail) > 0; }
};

/// "regression: FAILED, 1 of 12 rows (9 pass, 2 inconclusive)".
std::string headline(const GateReport& report);

/// One test case a row; inconclusive is skipped with a message, a red that does not count yet passes with what it would
/// have said in system-out.
std::string junit_xml(const GateReport& report);

/// Verdict line first, then what is red, then what is inconclusive; passes are folded. 200 rows at most, in that order,
/// and how many more there are. `link` goes to the whole report; empty: none.
std::string gate_markdown(const GateReport& report, const std::string& link);

/// The same two when nothing could be judged: one test case that is an error, and one line.
std::string junit_error_xml(const std::string& gate, const std::string& message);
std::string gate_error_markdown(const std::string& gate, const std::string& message);

/// Text as XML's character data and attribute value: escapes markup, and writes what XML 1.0 cannot hold (control
/// characters, bytes that are no UTF-8) as "\x1b".
std::string xml_escaped(const std::string& text);

/// Numbers as the tables show them: four digits, "+5.2 %", "n/a".
std::string value_text(const std::optional<double>& value);
std::string percent_text(const std::optional<double>& percent);
std::string interval_text(const GateReportRow& row);
std::string p_text(const std::optional<double>& p);
std::string detectable_text(const std::optional<double>& percent);

}  // namespace tarmac::reports
