// The rule and its hysteresis, and what a detector scores against the oracle.
#include "metrics/degeneracy/detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tarmac::metrics::tests {
namespace {

using enum DegeneracyClass;

std::vector<DegeneracyClass> classes(const std::vector<std::optional<double>>& lambdas, const DegeneracyRule& rule) {
  Classifier classifier(rule);
  std::vector<DegeneracyClass> result;
  for (const auto& lambda : lambdas) result.push_back(classifier(lambda));
  return result;
}

TEST(DegeneracyRule, FollowsTheNoiseOfNormals) {
  EXPECT_DOUBLE_EQ(DegeneracyRule::pose(0).degenerate_below, 1e-3);
  EXPECT_DOUBLE_EQ(DegeneracyRule::pose(0.03).degenerate_below, 4 * 0.03 * 0.03);
  EXPECT_DOUBLE_EQ(DegeneracyRule::pose(0.1).weak_below, 4 * 0.1 * 0.1);  // never below the other
  EXPECT_DOUBLE_EQ(DegeneracyRule::difference(0.001).degenerate_below, 5e-5);
  EXPECT_DOUBLE_EQ(DegeneracyRule::difference(0.03).degenerate_below, 0.03 * 0.03 / 3);
}

TEST(Classifier, LeavesAClassOnlyAboveTwiceItsThreshold) {
  const DegeneracyRule rule = DegeneracyRule::pose();
  EXPECT_THAT(classes({0.02, 0.009, 0.015, 0.021, 0.015}, rule), testing::ElementsAre(ok, weak, weak, ok, ok));
  EXPECT_THAT(classes({0.0009, 0.0019, 0.0021, 0.0011, 0.0009}, rule),
              testing::ElementsAre(degenerate, degenerate, weak, weak, degenerate));
  EXPECT_THAT(classes({0.0009, 0.5}, rule), testing::ElementsAre(degenerate, ok));
}

TEST(Classifier, ForgetsOverAnUnknownSweep) {
  EXPECT_THAT(classes({0.0009, std::nullopt, 0.0015}, DegeneracyRule::pose()),
              testing::ElementsAre(degenerate, unknown, weak));
}

TEST(Proportion, HasWilsonsInterval) {
  // Its bounds p solve (k/n - p)^2 = z^2 p (1 - p) / n.
  for (const auto& [k, n] : {std::pair<std::size_t, std::size_t>{8, 10}, {1, 3}, {97, 400}}) {
    const Proportion proportion{k, n};
    for (const double p : {proportion.low(), proportion.high()}) {
      const double off = *proportion.value() - p;
      EXPECT_NEAR(off * off, 1.959963984540054 * 1.959963984540054 * p * (1 - p) / static_cast<double>(n), 1e-12);
    }
    EXPECT_LT(proportion.low(), *proportion.value());
    EXPECT_GT(proportion.high(), *proportion.value());
  }
  EXPECT_EQ((Proportion{0, 10}).low(), 0);
  EXPECT_EQ((Proportion{10, 10}).high(), 1);
  EXPECT_LT((Proportion{10, 10}).low(), 1);
  EXPECT_FALSE((Proportion{0, 0}).value());
}

constexpr double kBad = 1e-5, kGood = 1e-1, kNear = 1.5e-3;

/// A letter a sweep: D degenerate by the oracle, o not, n near the threshold (not degenerate), ? unknown.
/// Flags: f flagged, . not. The method's eigenvalue follows its flag.
std::vector<DetectorSample> samples(const std::string& oracle, const std::string& flags) {
  std::vector<DetectorSample> list;
  for (std::size_t i = 0; i < oracle.size(); ++i) {
    DetectorSample s;
    s.t_s = 0.1 * static_cast<double>(i);
    if (oracle[i] != '?') s.oracle_lambda = oracle[i] == 'D' ? kBad : oracle[i] == 'n' ? kNear : kGood;
    s.lambda = flags[i] == 'f' ? 1e-4 : 1e-2;
    s.flag = flags[i] == 'f' ? degenerate : ok;
    list.push_back(s);
  }
  return list;
}

TEST(Detector, CountsSweeps) {
  const DetectorScores s = score_detector(samples("ooooDDDDDDoonn??", "f...ffff....ff.f"), 1e-3);
  EXPECT_EQ(s.near_threshold, 2u);
  EXPECT_EQ(s.unknown, 2u);
  EXPECT_EQ(s.scored, 12u);
  EXPECT_EQ(s.positives, 6u);
  EXPECT_EQ(s.precision.k, 4u);
  EXPECT_EQ(s.precision.n, 5u);
  EXPECT_EQ(s.recall.k, 4u);
  EXPECT_EQ(s.recall.n, 6u);
  EXPECT_DOUBLE_EQ(*s.f1, 2 * (4.0 / 5) * (4.0 / 6) / (4.0 / 5 + 4.0 / 6));
  // Pairs: 6 degenerate x 6 others; won 4 x 5, tied 4 x 1 + 2 x 5.
  EXPECT_DOUBLE_EQ(*s.auc, (20 + 0.5 * 14) / 36.0);
}

TEST(Detector, ThatNeverFlagsHasNoPrecisionAndNoRecall) {
  const DetectorScores s = score_detector(samples("oooooDDDDD", ".........."), 1e-3);
  EXPECT_FALSE(s.precision.value());
  EXPECT_EQ(*s.recall.value(), 0);
  EXPECT_DOUBLE_EQ(*s.auc, 0.5);
  EXPECT_EQ(*s.event_recall.value(), 0);
  EXPECT_TRUE(s.lead_s.empty());
}

TEST(Detector, OrdersSweepsPerfectlyWhateverItsThreshold) {
  std::vector<DetectorSample> list = samples("oooooDDDDD", "..........");
  for (std::size_t i = 0; i < list.size(); ++i) list[i].lambda = 0.5 - 0.01 * static_cast<double>(i);
  EXPECT_DOUBLE_EQ(*score_detector(list, 1e-3).auc, 1);
}

TEST(Detector, CountsEventsOfFiveSweepsAndMore) {
  //                                                0         1         2         3
  const DetectorScores s =
      score_detector(samples("DDDDDDoooooDDDDooooooDDDDDDDoooooooo", "ffffff......ff....ffff.....fffff.ff."), 1e-3);
  EXPECT_EQ(s.event_recall.n, 2u);  // sweeps 11 to 14 are no event
  EXPECT_EQ(s.event_recall.k, 2u);
  EXPECT_EQ(s.event_precision.n, 2u);  // 0..5 and 27..31: 18..21 is no event
  EXPECT_EQ(s.event_precision.k, 2u);
}

TEST(Detector, StatesItsLeadAtOnsetsInsideTheRecording) {
  // The first event begins with the recording: no onset. The second is flagged 3 sweeps early, the third 2 late.
  const DetectorScores s =
      score_detector(samples("DDDDDoooooooDDDDDooooooDDDDDD", "fffff....ffffffff........ffff"), 1e-3);
  ASSERT_EQ(s.lead_s.size(), 2u);
  EXPECT_NEAR(s.lead_s[0], 0.3, 1e-12);
  EXPECT_NEAR(s.lead_s[1], -0.2, 1e-12);
}

TEST(Detector, ThatNeverLetsGoLeadsFromTheEndOfTheEventBefore) {
  const DetectorScores s = score_detector(samples("DDDDDooooDDDDD", "ffffffffffffff"), 1e-3);
  ASSERT_EQ(s.lead_s.size(), 1u);
  EXPECT_NEAR(s.lead_s[0], 0.4, 1e-12);
}

TEST(Detector, IsNotBlamedForEventsNearTheThreshold) {
  const DetectorScores s = score_detector(samples("ooooonnnnnnoooooooooo", ".....ffffff...fffff.."), 1e-3);
  EXPECT_EQ(s.event_precision.n, 1u);
  EXPECT_EQ(s.event_precision.k, 0u);
}

}  // namespace
}  // namespace tarmac::metrics::tests
