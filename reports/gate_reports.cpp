#include "reports/gate_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/markdown.h"

namespace tarmac::reports {
namespace {

/// Bytes of the UTF-8 character at `i` that XML 1.0 can hold; 0: there is none.
std::size_t character_at(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
  const auto continues = [&](std::size_t k) { return (byte(k) & 0xC0u) == 0x80u; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  if (first >= 0xC2 && first < 0xE0) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first < 0xF0) {
    if (!continues(1) || !continues(2)) return 0;
    const unsigned code = (first & 0x0Fu) << 12 | (byte(1) & 0x3Fu) << 6 | (byte(2) & 0x3Fu);
    const bool surrogate = code >= 0xD800 && code < 0xE000;
    return code >= 0x800 && !surrogate && code < 0xFFFE ? 3 : 0;
  }
  if (first >= 0xF0 && first < 0xF5) {
    if (!continues(1) || !continues(2) || !continues(3)) return 0;
    const unsigned code = (first & 0x07u) << 18 | (byte(1) & 0x3Fu) << 12 | (byte(2) & 0x3Fu) << 6 | (byte(3) & 0x3Fu);
    return code >= 0x10000 && code <= 0x10FFFF ? 4 : 0;
  }
  return 0;
}

constexpr std::size_t kMostRows = 200;     ///< of the Markdown: a comment has a largest size
constexpr std::size_t kMostEvidence = 50;  ///< lines

std::string words_of(const GateReportRow& row) {
  return fmt::format("{} · {} · {}", row.case_name, row.estimator, row.metric);
}

constexpr const char* kTableHead =
    "| row | value | baseline | Δ | 95 % interval | p (adjusted) | detectable | verdict |\n"
    "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n";

std::string table_line(const GateReportRow& row) {
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  return fmt::format("| {} | {}{} | {} | {} | {} | {} | {} | **{}**: {} |\n", markdown_cell(words_of(row)),
                     value_text(row.value), markdown_cell(unit), value_text(row.baseline),
                     percent_text(row.change_percent), interval_text(row), p_text(row.p_adjusted),
                     detectable_text(row.detectable_percent), name_of(row.verdict),
                     markdown_cell(row.reason.empty() ? row.rule : row.reason));
}

/// A table of the rows with that verdict; what is shown is taken from `room`, and what does not fit is counted.
std::string table_of(const GateReport& report, GateVerdict verdict, std::size_t& room) {
  std::string lines;
  std::size_t left_out = 0;
  for (const GateReportRow& row : report.rows) {
    if (row.verdict != verdict) continue;
    if (room == 0) {
      ++left_out;
      continue;
    }
    lines += table_line(row);
    --room;
  }
  std::string text = lines.empty() ? "" : kTableHead + lines + "\n";
  if (left_out > 0) text += fmt::format("{} more rows ({}) are left out here.\n\n", left_out, name_of(verdict));
  return text;
}

std::string evidence_of(const GateReport& report) {
  std::string lines;
  std::size_t count = 0;
  for (const GateReportRow& row : report.rows) {
    if (row.verdict != GateVerdict::fail && row.verdict != GateVerdict::report_only) continue;
    for (const std::string& line : row.evidence)
      if (++count <= kMostEvidence) lines += fmt::format("- {}\n", markdown_cell(line));
  }
  if (count > kMostEvidence) lines += fmt::format("- {} more lines are left out here\n", count - kMostEvidence);
  return lines.empty() ? "" : "Logs and commands of the runs that failed:\n\n" + lines + "\n";
}

std::string junit_message(const GateReportRow& row) {
  std::string text = row.rule;
  if (!row.reason.empty()) text += ": " + row.reason;
  return text;
}

std::string junit_details(const GateReportRow& row) {
  std::string text = fmt::format(
      "{}\nvalue {} {}, baseline {}, change {}, 95 % interval {}, p {} (adjusted {}), detectable {}\n",
      junit_message(row), value_text(row.value), row.unit, value_text(row.baseline), percent_text(row.change_percent),
      interval_text(row), p_text(row.p), p_text(row.p_adjusted), detectable_text(row.detectable_percent));
  for (const std::string& line : row.evidence) text += line + "\n";
  return text;
}

std::string junit_case(const GateReport& report, const GateReportRow& row) {
  std::string text = fmt::format("    <testcase classname=\"gate.{}\" name=\"{}\" time=\"0\">\n",
                                 xml_escaped(report.gate), xml_escaped(words_of(row) + " · " + row.rule));
  const std::string message = xml_escaped(junit_message(row)), details = xml_escaped(junit_details(row));
  switch (row.verdict) {
    case GateVerdict::fail:
      text += fmt::format("      <failure type=\"gate\" message=\"{}\">{}</failure>\n", message, details);
      break;
    case GateVerdict::inconclusive:
      text += fmt::format("      <skipped message=\"inconclusive: {}\"/>\n", message);
      break;
    case GateVerdict::report_only:
      text += fmt::format("      <system-out>red, reported only until {}: {}</system-out>\n",
                          xml_escaped(row.report_only_until), details);
      break;
    case GateVerdict::pass:
      text += fmt::format("      <system-out>{}</system-out>\n", details);
      break;
  }
  return text + "    </testcase>\n";
}

}  // namespace

const char* name_of(GateVerdict verdict) {
  switch (verdict) {
    case GateVerdict::pass:
      return "pass";
    case GateVerdict::fail:
      return "FAIL";
    case GateVerdict::inconclusive:
      return "inconclusive";
    case GateVerdict::report_only:
      return "report-only";
  }
  return "unknown";
}

std::size_t GateReport::count(GateVerdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const GateReportRow& row) { return row.verdict == verdict; }));
}

std::string headline(const GateReport& report) {
  std::string text = report.failed() ? fmt::format("{}: FAILED, {} of {} rows", report.gate,
                                                   report.count(GateVerdict::fail), report.rows.size())
                                     : fmt::format("{}: passed, {} rows", report.gate, report.rows.size());
  text += fmt::format(" ({} pass, {} inconclusive", report.count(GateVerdict::pass),
                      report.count(GateVerdict::inconclusive));
  const std::size_t report_only = report.count(GateVerdict::report_only);
  return text + (report_only ? fmt::format(", {} red but reported only)", report_only) : ")");
}

std::string junit_xml(const GateReport& report) {
  const auto counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\"", report.rows.size(),
                                  report.count(GateVerdict::fail), report.count(GateVerdict::inconclusive));
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"gate.{1}\" {0} time=\"0\">\n",
      counts, xml_escaped(report.gate));
  for (const GateReportRow& row : report.rows) text += junit_case(report, row);
  if (!report.notes.empty()) {
    text += "    <system-out>";
    for (const std::string& note : report.notes) text += xml_escaped(note) + "\n";
    text += "</system-out>\n";
  }
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string gate_markdown(const GateReport& report, const std::string& link) {
  std::string text = fmt::format("{} **Gate {}**\n\n", report.failed() ? "❌" : "✅", markdown_cell(headline(report)));
  for (const std::string& note : report.notes) text += fmt::format("> {}\n\n", markdown_cell(note));
  std::size_t room = kMostRows;
  text += table_of(report, GateVerdict::fail, room);
  const std::string reds = table_of(report, GateVerdict::report_only, room);
  if (!reds.empty()) text += "Red, and reported only for now:\n\n" + reds;
  const std::string open = table_of(report, GateVerdict::inconclusive, room);
  if (!open.empty())
    text +=
        "Inconclusive: not shown to be worse, and not shown not to be. \"Detectable\" is the worsening that would "
        "have been red in 80 % of such comparisons; a smaller one can go unseen.\n\n" +
        open;
  text += evidence_of(report);
  const std::string passes = table_of(report, GateVerdict::pass, room);
  if (!passes.empty())
    text += fmt::format("<details><summary>{} rows pass</summary>\n\n{}</details>\n\n", report.count(GateVerdict::pass),
                        passes);
  if (!report.build.empty())
    text += fmt::format("Build {}{}.", markdown_cell(report.build),
                        report.baseline_build.empty() ? "" : ", baseline of " + markdown_cell(report.baseline_build));
  if (!link.empty()) text += fmt::format(" [Full report](<{}>)", link);
  return text + "\n";
}

std::string junit_error_xml(const std::string& gate, const std::string& message) {
  constexpr const char* kCounts = "tests=\"1\" failures=\"0\" errors=\"1\" skipped=\"0\"";
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"gate.{1}\" {0} time=\"0\">\n"
      "    <testcase classname=\"gate.{1}\" name=\"input\" time=\"0\">\n"
      "      <error type=\"input\" message=\"{2}\">{2}</error>\n    </testcase>\n  </testsuite>\n</testsuites>\n",
      kCounts, xml_escaped(gate), xml_escaped(message));
}

std::string gate_error_markdown(const std::string& gate, const std::string& message) {
  return fmt::format("❌ **Gate {}: nothing was judged**\n\n{}\n", markdown_cell(gate), markdown_cell(message));
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_at(text, i);
    if (length == 0) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i++]));
      continue;
    }
    switch (text[i]) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':  // in an attribute a parser would make these spaces
        out += "&#10;";
        break;
      case '\t':
        out += "&#9;";
        break;
      case '\r':
        out += "&#13;";
        break;
      default:
        out += text.substr(i, length);
    }
    i += length;
  }
  return out;
}

std::string value_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "n/a";
}

std::string percent_text(const std::optional<double>& percent) {
  if (!percent) return "";
  return fmt::format("{:+.2f} %", std::abs(*percent) < 0.005 ? 0.0 : *percent);
}

std::string interval_text(const GateReportRow& row) {
  if (!row.change_low_percent || !row.change_high_percent) return "";
  return fmt::format("{:+.2f} to {:+.2f} %", *row.change_low_percent, *row.change_high_percent);
}

std::string p_text(const std::optional<double>& p) {
  if (!p) return "";
  return *p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", *p);
}

std::string detectable_text(const std::optional<double>& percent) {
  if (!percent) return "";
  return std::isfinite(*percent) ? fmt::format("{:.1f} %", *percent) : "none";
}

}  // namespace tarmac::reports
