#include "scenarios/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"

namespace tarmac::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

class ScenarioFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& text, const std::string& name = "drive.yaml") {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    try {
      load_scenario(write(text), overrides);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "no error";
  }
  fs::path folder_;
};

constexpr const char* kGood =
    "name: drive\n"
    "why: because\n"
    "duration_s: 4\n"
    "scene: {kind: stand}\n"
    "motion: {kind: still}\n"
    "rig: {lidar: {model: vlp-16}}\n";

TEST_F(ScenarioFile, ReadsItsTopLevelAndLeavesTheBlocksToTheirModules) {
  const Scenario scenario = load_scenario(write(kGood), {});
  EXPECT_EQ(scenario.name, "drive");
  EXPECT_EQ(core::to_s(scenario.duration()), 4);
  EXPECT_EQ(scenario.rig.child("lidar").child("model").scalar("model"), "vlp-16");
  EXPECT_FALSE(scenario.estimators.present());
}

TEST_F(ScenarioFile, OverridesReachAnyDepth) {
  const Scenario scenario =
      load_scenario(write(kGood), {parse_override("duration_s=7.5"), parse_override("rig.lidar.model=os1")});
  EXPECT_EQ(scenario.duration_s, 7.5);
  EXPECT_EQ(scenario.rig.child("lidar").child("model").scalar("model"), "os1");
}

TEST_F(ScenarioFile, NamesFileLineAndFieldOfEveryMistake) {
  const std::string good = kGood;
  EXPECT_THAT(error_of(good + "durations_s: 3\n"),
              AllOf(HasSubstr("drive.yaml:7"), HasSubstr("durations_s"), HasSubstr("did you mean 'duration_s'")));
  EXPECT_THAT(error_of("name: drive\nduration_s: -5\n"),
              AllOf(HasSubstr("drive.yaml:2"), HasSubstr("duration_s"), HasSubstr("above 0")));
  EXPECT_THAT(error_of("name: drive\nduration_s: 5\nscene: {}\nmotion: {}\n"),
              AllOf(HasSubstr("rig"), HasSubstr("missing")));
  EXPECT_THAT(error_of("name: Drive One\nduration_s: 5\n"), AllOf(HasSubstr("drive.yaml:1"), HasSubstr("kebab-case")));
  EXPECT_THAT(error_of(good + "name: twice\n"), AllOf(HasSubstr(":7"), HasSubstr("stands twice")));
  EXPECT_THAT(error_of("name: [drive\n"), HasSubstr("no YAML"));
  EXPECT_THAT(error_of("just text\n"), HasSubstr("block"));
  EXPECT_THAT(error_of(good + "estimators: 3\n"), AllOf(HasSubstr("drive.yaml:7"), HasSubstr("estimators")));
  EXPECT_THAT(error_of(good, {parse_override("duration_s=long")}),
              AllOf(HasSubstr("--set duration_s"), HasSubstr("finite number")));
}

TEST_F(ScenarioFile, IsFoundByNameAndGuessedWhenMistyped) {
  write(kGood, "stand-turn.yaml");
  EXPECT_EQ(find_scenario("stand-turn", {folder_}), folder_ / "stand-turn.yaml");
  try {
    find_scenario("stand-trun", {folder_});
    FAIL() << "found what does not exist";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'stand-turn'"));
  }
}

TEST(Seeds, AreOneNumberOrAnAscendingRange) {
  EXPECT_THAT(parse_seeds("7"), testing::ElementsAre(7));
  EXPECT_THAT(parse_seeds("2..4"), testing::ElementsAre(2, 3, 4));
  for (const char* bad : {"", "x", "3..1", "1..", "..2", "-1", "1..99999999"}) {
    EXPECT_THROW(parse_seeds(bad), core::InputError) << bad;
  }
}

TEST(Override, NeedsAKeyAndAnEqualsSign) {
  EXPECT_EQ(parse_override("a.b=c=d"), Override("a.b", "c=d"));
  EXPECT_THROW(parse_override("a.b"), core::InputError);
  EXPECT_THROW(parse_override("=1"), core::InputError);
}

}  // namespace
}  // namespace tarmac::scenarios
