#include "reports/gate_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

namespace {

using namespace tarmac::reports;
using testing::HasSubstr;
using testing::Not;

GateReportRow row(GateVerdict verdict, const std::string& reason) {
  GateReportRow r;
  r.case_name = "brake x=<3> & \"more\"";
  r.estimator = "kiss-icp";
  r.metric = "rpe_1sweep_trans_rmse_m";
  r.unit = "m";
  r.rule = "no worse than the baseline";
  r.verdict = verdict;
  r.reason = reason;
  r.value = 0.0525;
  r.baseline = 0.05;
  r.change_percent = 5;
  r.change_low_percent = 2.5;
  r.change_high_percent = 7.5;
  r.p = 0.001;
  r.p_adjusted = 0.002;
  r.detectable_percent = 4.25;
  return r;
}

GateReport report() {
  GateReport r;
  r.gate = "regression";
  r.build = "0.1.0 (abc)";
  r.baseline_build = "0.1.0 (def)";
  r.notes = {"recordings of 2 of 10 drives differ"};
  r.rows = {row(GateVerdict::fail, "worse | much\nworse \x1b[31m"), row(GateVerdict::pass, ""),
            row(GateVerdict::inconclusive, "a worsening by 4.2 % would have been red"),
            row(GateVerdict::report_only, "red \x01")};
  r.rows[0].evidence = {"seed 3: log: out/log.txt"};
  r.rows[3].report_only_until = "2026-12-31";
  return r;
}

TEST(GateReport, TheHeadlineCounts) {
  EXPECT_EQ(headline(report()), "regression: FAILED, 1 of 4 rows (1 pass, 1 inconclusive, 1 red but reported only)");
  GateReport fine = report();
  fine.rows.erase(fine.rows.begin());
  EXPECT_EQ(headline(fine), "regression: passed, 3 rows (1 pass, 1 inconclusive, 1 red but reported only)");
  EXPECT_FALSE(fine.failed());
}

TEST(GateMarkdown, BeginsWithTheVerdictAndFoldsPasses) {
  const std::string text = gate_markdown(report(), "https://ci.example/report");
  EXPECT_EQ(text.find("❌ **Gate regression: FAILED"), 0u);
  EXPECT_LT(text.find("**FAIL**"), text.find("**inconclusive**"));
  EXPECT_LT(text.find("<details>"), text.find("**pass**"));
  EXPECT_GT(text.find("<details>"), text.find("**report-only**"));
  EXPECT_THAT(text, HasSubstr("+5.00 % | +2.50 to +7.50 % | 0.0020 | 4.2 %"));
  EXPECT_THAT(text, HasSubstr("[Full report](<https://ci.example/report>)"));
  EXPECT_THAT(text, HasSubstr("a smaller one can go unseen"));
  EXPECT_THAT(gate_markdown(report(), ""), Not(HasSubstr("Full report")));
}

TEST(GateMarkdown, TextCannotBreakTheTable) {
  const std::string text = gate_markdown(report(), "");
  EXPECT_THAT(text, HasSubstr("worse \\| much worse"));
  EXPECT_THAT(text, HasSubstr("x=&lt;3&gt; &amp;"));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(GateMarkdown, NobodyIsNamedByATextInIt) {
  GateReport r = report();
  r.rows[0].case_name = "@everybody";
  EXPECT_THAT(gate_markdown(r, ""), HasSubstr("&#64;everybody"));
  EXPECT_EQ(gate_markdown(r, "").find('@'), std::string::npos);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(GateMarkdown, HoldsTwoHundredRowsRedsFirstAndCountsTheRest) {
  GateReport r = report();
  r.rows.clear();
  for (int k = 0; k < 150; ++k) {
    r.rows.push_back(row(GateVerdict::pass, ""));
    r.rows.push_back(row(GateVerdict::inconclusive, "who knows"));
    r.rows.push_back(row(GateVerdict::fail, "worse"));
    r.rows.back().evidence = {"a log"};
  }
  const std::string text = gate_markdown(r, "");
  EXPECT_EQ(count_of(text, "| **FAIL**"), 150u);
  EXPECT_EQ(count_of(text, "| **inconclusive**"), 50u);
  EXPECT_EQ(count_of(text, "| **pass**"), 0u);
  EXPECT_THAT(text, HasSubstr("100 more rows (inconclusive) are left out here."));
  EXPECT_THAT(text, HasSubstr("150 more rows (pass) are left out here."));
  EXPECT_THAT(text, HasSubstr("100 more lines are left out here"));
  EXPECT_LT(text.size(), 65536u) << "the most that a comment on GitHub can hold";
}

TEST(GateErrors, AreOneTestCaseAndOneLine) {
  const std::string xml = junit_error_xml("regression", "b.yaml: <no such file>");
  EXPECT_THAT(xml, HasSubstr("tests=\"1\" failures=\"0\" errors=\"1\""));
  EXPECT_THAT(xml, HasSubstr("<error type=\"input\" message=\"b.yaml: &lt;no such file&gt;\">"));
  EXPECT_THAT(gate_error_markdown("regression", "a @b"), HasSubstr("regression: nothing was judged**\n\na &#64;b"));
}

TEST(GateXml, EscapesWhatXmlCannotHold) {
  EXPECT_EQ(xml_escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(xml_escaped(std::string("\x00\x1b", 2)), "\\x00\\x1b");
  EXPECT_EQ(xml_escaped("µ — 𝛼"), "µ — 𝛼");
  EXPECT_EQ(xml_escaped("\xff\xc3"), "\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(xml_escaped("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(xml_escaped("\xef\xbf\xbf"), "\\xef\\xbf\\xbf") << "U+FFFF is no character";
  EXPECT_EQ(xml_escaped("a\nb"), "a&#10;b");
}

TEST(GateNumbers, AreShort) {
  EXPECT_EQ(percent_text(-0.001), "+0.00 %");
  EXPECT_EQ(percent_text(std::nullopt), "");
  EXPECT_EQ(p_text(1e-9), "< 0.0001");
  EXPECT_EQ(detectable_text(std::numeric_limits<double>::infinity()), "none");
}

/// Written where TARMAC_JUNIT_OUT says, for junit_test.py, which reads it with an XML parser.
TEST(GateJunit, IsWrittenForAParserToRead) {
  const char* out = std::getenv("TARMAC_JUNIT_OUT");
  const std::string text = junit_xml(report());
  EXPECT_THAT(text, HasSubstr("tests=\"4\" failures=\"1\" errors=\"0\" skipped=\"1\""));
  if (!out) return;
  std::ofstream(out, std::ios::binary) << text;
}

}  // namespace
