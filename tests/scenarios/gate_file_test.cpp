#include "scenarios/gate_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace tarmac::scenarios;
using tarmac::core::InputError;
using testing::HasSubstr;

class GateFileTest : public testing::Test {
 protected:
  GateFile load(const std::string& text) {
    const auto file = folder_.path() / "gates" / "g.yaml";
    std::filesystem::create_directories(file.parent_path());
    tarmac::core::write_file(file, text);
    return load_gate(file);
  }
  std::string error_of(const std::string& text) {
    try {
      load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  tarmac::tests::TemporaryFolder folder_;
};

TEST_F(GateFileTest, ReadsEveryKindOfRow) {
  const GateFile gate = load(R"(name: g
why: because
sweep: regression
baseline: ../baselines/b.yaml
alpha: 0.02
holm: false
report_only_until: 2026-12-31
rows:
  - {case: stand-turn, estimator: kiss-icp, metric: end_error_percent, max: 0.5, of: every}
  - {scenario: ['quick-*', other], estimator: '*', metric: [a_m, b_m], relative: {max_increase_percent: 10}, report_only_until: 2027-01-01}
  - {case: '*', estimator: x, metric: a_m, estimate: final, non_inferior: {margin_percent: 5, min_pairs: 10}, allow: [not_initialised]}
)");
  EXPECT_EQ(gate.name, "g");
  EXPECT_EQ(gate.sweep, "regression");
  EXPECT_EQ(gate.baseline, folder_.path() / "baselines" / "b.yaml");
  EXPECT_EQ(gate.alpha, 0.02);
  EXPECT_FALSE(gate.holm);
  ASSERT_EQ(gate.rows.size(), 3u);
  ASSERT_TRUE(gate.rows[0].absolute);
  EXPECT_EQ(gate.rows[0].absolute->max, 0.5);
  EXPECT_FALSE(gate.rows[0].absolute->min);
  EXPECT_EQ(gate.rows[0].absolute->of, GateStatistic::every);
  EXPECT_EQ(gate.rows[0].report_only_until, "2026-12-31") << "the file's holds where the row has none";
  EXPECT_TRUE(gate.rows[1].by_scenario);
  EXPECT_EQ(gate.rows[1].places, (std::vector<std::string>{"quick-*", "other"}));
  EXPECT_EQ(gate.rows[1].metrics.size(), 2u);
  EXPECT_EQ(gate.rows[1].relative->max_increase_percent, 10);
  EXPECT_FALSE(gate.rows[1].relative->max_decrease_percent);
  EXPECT_EQ(gate.rows[1].report_only_until, "2027-01-01");
  EXPECT_EQ(gate.rows[2].non_inferior->margin_percent, 5);
  EXPECT_EQ(gate.rows[2].non_inferior->min_pairs, 10u);
  EXPECT_EQ(gate.rows[2].estimate, "final");
  EXPECT_TRUE(gate.rows[2].allow_not_initialised);
}

TEST_F(GateFileTest, SaysFileLineAndFieldOfWhatIsWrong) {
  const std::string row = "{case: c, estimator: e, metric: m, ";
  struct Wrong {
    std::string text;
    std::vector<std::string> said;
  };
  const std::vector<Wrong> table = {
      {"name: g\nrows:\n  - " + row + "max: abc}\n", {"g.yaml:3", "max", "abc"}},
      {"name: g\nrows:\n  - " + row + "maxx: 1}\n", {"g.yaml:3", "maxx", "max"}},
      {"name: g\nrow: []\n", {"g.yaml:2", "row", "rows"}},
      {"name: g\nrows: []\n", {"rows", "empty"}},
      {"name: g\n", {"rows", "missing"}},
      {"rows:\n  - " + row + "max: 1}\n", {"name", "missing"}},
      {"name: g\nrows:\n  - " + row + "}\n", {"g.yaml:3", "this one has none"}},
      {"name: g\nrows:\n  - " + row + "max: 1, relative: {max_increase_percent: 1}}\n", {"a row for each"}},
      {"name: g\nrows:\n  - " + row + "relative: {max_increase_percent: 1}}\n", {"g.yaml:3", "baseline: FILE"}},
      {"name: g\nbaseline: b\nrows:\n  - " + row + "relative: {}}\n", {"relative", "max_increase_percent"}},
      {"name: g\nbaseline: b\nrows:\n  - " + row + "relative: {max_increase_percent: -1}}\n", {"at least 0"}},
      {"name: g\nbaseline: b\nrows:\n  - " + row + "non_inferior: {margin: 1}}\n", {"margin", "margin_percent"}},
      {"name: g\nbaseline: b\nrows:\n  - " + row + "non_inferior: {min_pairs: 1}}\n", {"min_pairs", "at least 2"}},
      {"name: g\nrows:\n  - " + row + "max: 1, of: worst}\n", {"of", "every"}},
      {"name: g\nbaseline: b\nrows:\n  - " + row + "non_inferior: {}, of: mean}\n", {"of", "max and min"}},
      {"name: g\nrows:\n  - " + row + "max: 1, min: 2}\n", {"min", "above max"}},
      {"name: g\nrows:\n  - " + row + "max: 1, allow: [failed]}\n", {"allow", "failed", "not_initialised"}},
      {"name: g\nrows:\n  - " + row + "max: 1, report_only_until: 2026-02-30}\n", {"g.yaml:3", "2026-02-30"}},
      {"name: g\nreport_only_until: soon\nrows:\n  - " + row + "max: 1}\n", {"g.yaml:2", "soon"}},
      {"name: g\nrows:\n  - {estimator: e, metric: m, max: 1}\n", {"case", "missing"}},
      {"name: g\nrows:\n  - {case: c, metric: m, max: 1}\n", {"estimator", "missing"}},
      {"name: g\nrows:\n  - {case: c, estimator: [], metric: m, max: 1}\n", {"estimator", "empty"}},
      {"name: g\nrows:\n  - {case: c, scenario: s, estimator: e, metric: m, max: 1}\n", {"not both"}},
      {"name: g\nalpha: 0\nrows:\n  - " + row + "max: 1}\n", {"g.yaml:2", "alpha", "above 0"}},
      {"name: g\nrows:\n  - nonsense\n", {"g.yaml:3", "a row is a block"}},
      {"- a\n", {"g.yaml", "a gate is a block"}},
      {"name: g\nname: h\n", {"g.yaml:2", "name"}},
      {"name: [\n", {"g.yaml"}},
  };
  for (const Wrong& wrong : table) {
    const std::string error = error_of(wrong.text);
    for (const std::string& said : wrong.said) EXPECT_THAT(error, HasSubstr(said)) << wrong.text;
  }
}

TEST_F(GateFileTest, AMissingFileIsAnInputError) {
  EXPECT_THROW(load_gate(folder_.path() / "none.yaml"), InputError);
}

TEST(GatePattern, AStarStandsForAnyTextAndNothingElseIsSpecial) {
  EXPECT_TRUE(matches_pattern("*", ""));
  EXPECT_TRUE(matches_pattern("*", "brake motion.peak=3"));
  EXPECT_TRUE(matches_pattern("brake", "brake"));
  EXPECT_FALSE(matches_pattern("brake", "brake motion.peak=3"));
  EXPECT_TRUE(matches_pattern("brake*", "brake motion.peak=3"));
  EXPECT_TRUE(matches_pattern("*=3", "brake motion.peak=3"));
  EXPECT_TRUE(matches_pattern("*a*b", "xaxbxaxb"));
  EXPECT_FALSE(matches_pattern("*a*b", "xaxbx"));
  EXPECT_FALSE(matches_pattern("kiss.icp", "kiss-icp"));
  EXPECT_FALSE(matches_pattern("", "x"));
}

}  // namespace
