// A drive out of a room on to a plane and back: rows, series and table of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "metrics/degeneracy/degeneracy.h"
#include "metrics/registry.h"
#include "tests/metrics/surfaces.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

constexpr int kSweeps = 30, kOut = 10, kBack = 22;  ///< sweeps [kOut, kBack) see a plane alone

struct OutAndBack {
  Estimate estimate;
  Oracle oracle;
  std::vector<SweepDiagnostics> surface_rows;  ///< point-to-plane
  std::vector<SweepDiagnostics> axis_rows;     ///< point-to-point, with surface rows beside
  Rig rig;

  RowSet rows(const std::vector<SweepDiagnostics>* diagnostics, bool with_oracle,
              Evaluation* evaluation = nullptr) const {
    RowSet made("causal");
    Evaluation own;
    const SweepSource source{static_cast<std::size_t>(kSweeps), [](std::size_t) { return LidarSweep{}; }, rig, 0};
    DiagnosticsSource diagnostics_source;
    if (diagnostics) diagnostics_source = diagnostics_of(*diagnostics);
    add_degeneracy(
        {estimate, diagnostics ? &diagnostics_source : nullptr, source, with_oracle ? &oracle : nullptr, Time{}},
        {.normal_noise_deg = 0}, made, evaluation ? *evaluation : own);
    return made;
  }
};

const OutAndBack& the_run() {
  static const OutAndBack run = [] {
    OutAndBack r;
    r.rig.lidars.emplace_back();
    Vector6 xi;
    xi << 5, 0, 0, 0, 0, 0.3;
    const ConstantTwist motion(pose({0, 0, 1.7}, {0, 0, 0}), xi, Time{}, time_from_s(4));
    for (int k = 0; k < kSweeps; ++k) {
      const Time begin = Time{} + k * kSpan;
      const bool out = k >= kOut && k < kBack;
      const Sweep sweep = sweep_of(out ? plane({0, 0, 1}, 0) : room(70, 60, 20), motion, begin, 64);
      OracleSweep truth;
      truth.index = k;
      truth.begin = begin;
      truth.end = begin + kSpan;
      truth.T_world_c = sweep.T_world_c;
      truth.p_world_body = sweep.T_world_c.translation();
      truth.mean_range_m = sweep.mean_range_m;
      truth.points = truth.static_returns = sweep.points.size();
      truth.blocks = sweep.analyse();
      r.oracle.sweeps.push_back(truth);

      SweepResult result;
      result.index = k;
      result.begin = begin;
      result.end = result.reference = begin + kSpan;
      result.T_map_body = motion.pose(result.end);
      r.estimate.sweeps.push_back(result);
      r.estimate.causal.append(Segment::two_pose(SegmentModel::two_pose_screw, begin, motion.pose(begin), result.end,
                                                 motion.pose(result.end)));
      SweepDiagnostics record = recorded(sweep, motion, begin, SE3::Identity());
      record.index = k;
      r.surface_rows.push_back(record);
      std::swap(record.rows, record.surface);
      record.rows_are_surface = false;
      add_axis_rows(sweep, motion, begin, record);
      r.axis_rows.push_back(std::move(record));
    }
    return r;
  }();
  return run;
}

std::map<std::string, Row> by_name(const RowSet& rows) {
  std::map<std::string, Row> map;
  for (const Row& row : rows.rows()) map[row.metric] = row;
  return map;
}

TEST(DegeneracyRows, OfExactPointToPlaneRowsAgreeWithTheOracle) {
  auto rows = by_name(the_run().rows(&the_run().surface_rows, true));
  EXPECT_NEAR(*rows["oracle_degenerate_percent"].value, 100.0 * (kBack - kOut) / kSweeps, 1e-9);
  for (const char* source : {"solve", "surface"}) {
    const std::string prefix = std::string("degeneracy_") + source;
    for (const char* block : {"_6dof_", "_12dof_"})
      for (const char* figure : {"precision", "recall", "f1", "auc"})
        EXPECT_EQ(rows[prefix + block + figure].value, 1) << prefix << block << figure;
    EXPECT_EQ(rows[prefix + "_6dof_event_recall"].value, 1);
    EXPECT_EQ(rows[prefix + "_6dof_event_precision"].value, 1);
    EXPECT_EQ(rows[prefix + "_6dof_lead_time_s"].value, 0);
  }
  const Row& recall = rows["degeneracy_solve_6dof_recall"];
  EXPECT_EQ(recall.ci_high, 1);
  // Wilson's lower bound at k = n: n / (n + z^2).
  EXPECT_NEAR(*recall.ci_low, 12 / (12 + 1.959963984540054 * 1.959963984540054), 1e-12);
  EXPECT_EQ(recall.status, "ok: 12 of 12; sweeps scored 30, near the threshold 0, unknown 0");
}

TEST(DegeneracyRows, OfAPointToPointMethodSayNothingUnlessItsSurfacesAreAsked) {
  auto rows = by_name(the_run().rows(&the_run().axis_rows, true));
  EXPECT_EQ(rows["degeneracy_solve_6dof_recall"].value, 0);
  EXPECT_FALSE(rows["degeneracy_solve_6dof_precision"].value);
  EXPECT_EQ(rows["degeneracy_surface_6dof_recall"].value, 1);
  EXPECT_EQ(rows["degeneracy_surface_6dof_precision"].value, 1);
  EXPECT_GT(*rows["solve_lambda_min_6dof_median"].value, 0.01);
}

TEST(DegeneracyRows, HaveAReasonWhereTheyHaveNoValue) {
  const auto no_truth = by_name(the_run().rows(nullptr, false));
  std::size_t family = 0;
  for (const MetricEntry& metric : metrics()) {
    if (std::string(metric.family) != "degeneracy") continue;
    ++family;
    ASSERT_TRUE(no_truth.contains(metric.name)) << metric.name;
    EXPECT_FALSE(no_truth.at(metric.name).value);
    EXPECT_TRUE(no_truth.at(metric.name).status.starts_with("n/a: ")) << no_truth.at(metric.name).status;
  }
  EXPECT_EQ(no_truth.size(), family);
  auto alone = by_name(the_run().rows(nullptr, true));
  EXPECT_TRUE(alone["oracle_degenerate_percent"].value);
  EXPECT_EQ(alone["solve_lambda_min_6dof_median"].status, "n/a: the run recorded no diagnostics");
}

TEST(DegeneracyRows, OfARecordingWithoutTruthKeepTheMethodsOwnSide) {
  // Ranges come from the recording then: give it one point at the sweeps' usual distance.
  const OutAndBack& run = the_run();
  SweepSource source{static_cast<std::size_t>(kSweeps), {}, run.rig, 0};
  source.sweep = [](std::size_t i) {
    LidarSweep sweep;
    sweep.index = static_cast<std::int64_t>(i);
    sweep.push_back({20, 0, 0}, 0, 0, 1);
    sweep.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0}, 0, 0, 1);
    return sweep;
  };
  const DiagnosticsSource diagnostics = diagnostics_of(run.surface_rows);
  const DegeneracyReport report =
      degeneracy_report({run.estimate, &diagnostics, source, nullptr, Time{}}, {.normal_noise_deg = 0});
  EXPECT_TRUE(report.oracle.empty());
  ASSERT_EQ(report.solve.size(), static_cast<std::size_t>(kSweeps));
  for (int k = 0; k < kSweeps; ++k)
    EXPECT_EQ(report.solve[static_cast<std::size_t>(k)].pose == DegeneracyClass::degenerate, k >= kOut && k < kBack);
}

TEST(DegeneracySeries, ShowClassesAndFreeDirectionsOverTime) {
  Evaluation evaluation;
  the_run().rows(&the_run().axis_rows, true, &evaluation);
  const auto value = [&](const char* name, int sweep) {
    const Series* s = evaluation.find(name);
    EXPECT_TRUE(s) << name;
    return s ? s->y.at(static_cast<std::size_t>(sweep)) : -1;
  };
  for (const char* prefix : {"oracle_", "surface_"}) {
    EXPECT_EQ(value((std::string(prefix) + "degeneracy_class_vs_time").c_str(), kOut), 2);
    EXPECT_LT(value((std::string(prefix) + "degeneracy_class_vs_time").c_str(), kBack), 2);
  }
  for (const char* prefix : {"", "oracle_"}) {
    for (const char* free : {"along_track", "cross_track", "yaw"})
      EXPECT_NEAR(value((std::string(prefix) + "weak_" + free + "_vs_time").c_str(), kOut + 3), 1, 1e-3) << free;
    for (const char* held : {"height", "roll", "pitch"})
      EXPECT_NEAR(value((std::string(prefix) + "weak_" + held + "_vs_time").c_str(), kOut + 3), 0, 1e-3) << held;
  }
  EXPECT_LT(value("degeneracy_class_vs_time", kOut), 2);  // point-to-point
  EXPECT_EQ(evaluation.find("path_degenerate")->x.size(), static_cast<std::size_t>(kBack - kOut));
  EXPECT_FALSE(evaluation.find("prior_share_vs_time"));
  // One line a sweep and source, each with as many fields as the header.
  std::size_t lines = 0;
  std::istringstream text(evaluation.degeneracy_csv);
  std::string line, header;
  std::getline(text, header);
  for (; std::getline(text, line); ++lines)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ','));
  EXPECT_EQ(lines, 3u * kSweeps);
}

TEST(DegeneracyFindings, TellWhereWhatIsFreeAndWhoNoticed) {
  Evaluation evaluation;
  the_run().rows(&the_run().axis_rows, true, &evaluation);
  ASSERT_EQ(evaluation.findings.size(), 1u);
  const Finding& finding = evaluation.findings[0];
  EXPECT_EQ(finding.topic, "degeneracy");
  EXPECT_EQ(finding.verdict, Finding::Verdict::found);
  // Sweeps 10 to 21 end at 1.1 s and 2.2 s.
  EXPECT_EQ(finding.words,
            "By exact normals the geometry does not hold along-track + cross-track + yaw from 1.1 s to 2.2 s.");
  ASSERT_EQ(finding.evidence.size(), 4u);
  EXPECT_EQ(finding.evidence[0].value, kBack - kOut);
  EXPECT_EQ(finding.evidence[2].value, 0);    // its point-to-point residuals
  EXPECT_EQ(finding.evidence[3].value, 100);  // its surface residuals
}

TEST(DegeneracyFindings, WithoutTruthAreTheMethodsOwnOrNone) {
  const OutAndBack& run = the_run();
  DegeneracyReport report;
  EXPECT_EQ(findings_of(report)[0].verdict, Finding::Verdict::cannot_be_told);
  const DiagnosticsSource diagnostics = diagnostics_of(run.surface_rows);
  const SweepSource source{static_cast<std::size_t>(kSweeps), {}, run.rig, 0};
  report = degeneracy_report({run.estimate, &diagnostics, source, &run.oracle, Time{}}, {.normal_noise_deg = 0});
  report.oracle.clear();
  ASSERT_EQ(findings_of(report).size(), 1u);
  EXPECT_EQ(findings_of(report)[0].verdict, Finding::Verdict::found);
  report.surface.resize(kOut);
  EXPECT_EQ(findings_of(report)[0].verdict, Finding::Verdict::nothing_found);
}

TEST(DegeneracyRows, AreTheSameAtAnyNumberOfThreads) {
  const OutAndBack& run = the_run();
  const DiagnosticsSource diagnostics = diagnostics_of(run.axis_rows);
  const SweepSource source{static_cast<std::size_t>(kSweeps), {}, run.rig, 0};
  const DegeneracyInput input{run.estimate, &diagnostics, source, &run.oracle, Time{}};
  EXPECT_EQ(to_csv(degeneracy_report(input, {.threads = 1})), to_csv(degeneracy_report(input, {.threads = 4})));
}

}  // namespace
}  // namespace tarmac::metrics::tests
