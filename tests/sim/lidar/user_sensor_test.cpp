// Sensors of the user's own: YAML profiles, CSV tables, and what is wrong with them.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "sim/lidar/profile_file.h"
#include "sim/rig_options.h"
#include "sim/simulate.h"

namespace tarmac::sim {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr const char* optics =
    "max_range_m: 80\nrange_step_m: 0.002\nrange_10_percent_m: 40\nrange_80_percent_m: 80\nthreshold_snr: 5.5\n"
    "sigma_from_m: [0]\nsigma_m: [0.02]\n";
constexpr const char* clock_timing = "timing: clock\ncycle_us: 50\n";
constexpr const char* table =
    "# four lasers\nelevation_deg, azimuth_offset_cw_deg, firing_us, origin_up_m\n-3,0.5,0,0.1\n-1,-0.5,1.5,0.1\n"
    "1,0.5,3,0.2\n3.25,-0.5,4.5,0.2\n";

class UserSensor : public testing::Test {
 protected:
  fs::path folder = fs::path(testing::TempDir()) /
                    ("tarmac_sensor_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  fs::path write(const std::string& name, const std::string& text) const {
    core::write_file(folder / name, text);
    return folder / name;
  }
  /// What is said about a sensor of these lines; "" when it is accepted.
  std::string complaint(const std::string& yaml) const {
    const fs::path file = write("mine.yaml", yaml);
    try {
      lidar::load_profile(file);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }
};

void expect_in(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

TEST_F(UserSensor, ProfileTakesItsChannelsFromATable) {
  write("table.csv", table);
  const lidar::Profile p =
      lidar::load_profile(write("mine.yaml", std::string(clock_timing) + optics + "channels: table.csv\n"));
  EXPECT_EQ(p.name, "mine");
  EXPECT_EQ(p.elevation_deg, (std::vector<double>{-3, -1, 1, 3.25}));
  EXPECT_EQ(p.azimuth_offset_cw_deg, (std::vector<double>{0.5, -0.5, 0.5, -0.5}));
  EXPECT_EQ(p.firing_us, (std::vector<double>{0, 1.5, 3, 4.5}));
  EXPECT_EQ(p.origin_up_m, (std::vector<double>{0.1, 0.1, 0.2, 0.2}));
  EXPECT_EQ(p.ring, (std::vector<double>{0, 1, 2, 3}));  // from the lowest beam where the table says nothing
  EXPECT_TRUE(p.origin_left_m.empty());
}

TEST_F(UserSensor, ScenarioFindsItsSensorBesideItselfAndResolvesToOneThatNeedsNoFile) {
  write("table.csv", table);
  write("mine.yaml", std::string(clock_timing) + optics + "channels: table.csv\n");
  const fs::path scenario = write("scenario.yaml", "rig: {lidar: {model: ./mine.yaml, sweep_rate_hz: 20}}\n");
  const std::string resolved = resolve_rig(ConfigNode::load(scenario.string()).child("rig"));
  fs::remove_all(folder);
  const ConfigNode again = ConfigNode::parse(resolved, "resolved.yaml");
  EXPECT_EQ(resolve_rig(again), resolved);
  const RigOptions options = read_rig(again);
  EXPECT_EQ(options.lidars[0].model, "mine");
  EXPECT_EQ(options.lidars[0].sweep_rate_hz, 20);
  EXPECT_EQ(options.lidars[0].profile.elevation_deg, (std::vector<double>{-3, -1, 1, 3.25}));
  EXPECT_EQ(options.lidars[0].profile.firing_us, (std::vector<double>{0, 1.5, 3, 4.5}));
  EXPECT_EQ(data_sheet(options).lidars.at(0).model, "mine");
  EXPECT_EQ(data_sheet(options).lidars.at(0).max_range_m, 80);
}

TEST_F(UserSensor, EveryNumberOfABundledSensorSurvivesBeingWrittenOut) {
  for (const std::string& name : lidar::profile_names()) {
    lidar::Profile bundled = lidar::profile(name);
    const lidar::Profile read = lidar::load_profile(write(name + ".yaml", core::write_options(bundled)));
    EXPECT_EQ(core::write_options(read), core::write_options(bundled)) << name;
    for (const lidar::ChannelColumn& column : lidar::channel_columns())
      EXPECT_EQ(read.*column.values, bundled.*column.values) << name << " " << column.name;
  }
}

TEST_F(UserSensor, PathGivenOnTheCommandLineIsTheCommandLines) {
  const fs::path sensor =
      write("mine.yaml", std::string(clock_timing) + optics + "elevation_deg: [0, 1]\nazimuth_offset_cw_deg: [0, 0]\n");
  ConfigNode scenario = ConfigNode::parse("rig: {lidar: {model: vlp-16}}\n", "/nowhere/scenario.yaml");
  scenario.set("rig.lidar.model", fs::relative(sensor).string());
  EXPECT_EQ(read_rig(scenario.child("rig")).lidars[0].profile.channels(), 2u);
}

TEST_F(UserSensor, MissingFieldsAreNamedOneByOne) {
  std::string yaml = "summary: mine\n";
  for (const char* line : {"timing: clock", "elevation_deg: [0, 1]", "azimuth_offset_cw_deg: [0, 0]", "max_range_m: 80",
                           "range_step_m: 0.002", "range_10_percent_m: 40", "range_80_percent_m: 80",
                           "threshold_snr: 5.5", "sigma_from_m: [0]", "sigma_m: [0.02]", "cycle_us: 50"}) {
    const std::string field = std::string(line).substr(0, std::string(line).find(':'));
    expect_in(complaint(yaml), {"mine.yaml", field, "is missing"});
    yaml += std::string(line) + "\n";
  }
  EXPECT_EQ(complaint(yaml), "");
}

TEST_F(UserSensor, ImpossibleFiringTablesAreRefusedWithLineAndField) {
  const std::string start = std::string(optics) + "elevation_deg: [0, 1, 2]\nazimuth_offset_cw_deg: [0, 0, 0]\n";
  const std::string clock = start + clock_timing, encoder = start + "timing: encoder\nmodes: [1024x10]\n";
  EXPECT_EQ(complaint(clock), "");
  EXPECT_EQ(complaint(encoder), "");
  expect_in(complaint(clock + "firing_us: [0, 2]\n"), {"mine.yaml:12", "firing_us", "2 values", "3 were expected"});
  expect_in(complaint(clock + "firing_us: [0, 2, 1]\n"), {"mine.yaml:12", "channel 2 fires at 1 us", "firing order"});
  expect_in(complaint(clock + "firing_us: [0, 2, 50]\n"), {"mine.yaml:12", "firing_us", "take 50 us", "after 50 us"});
  expect_in(complaint(encoder + "firing_us: [0, 2, 98]\n"), {"firing_us", "98 us", "97.65625 us in mode 1024x10"});
  EXPECT_EQ(complaint(encoder + "firing_us: [0, 2, 97]\n"), "");
  expect_in(complaint(clock + "firing_us: [0, 2, -1]\n"), {"mine.yaml:12", "firing_us", "at least 0"});
  expect_in(complaint(clock + "ring: [0, 1, 1]\n"), {"mine.yaml:12", "ring", "stands twice"});
  expect_in(complaint(clock + "ring: [0, 1, 1.5]\n"), {"ring", "whole number"});
  expect_in(complaint(clock + "origin_left_m: [0.1]\n"), {"mine.yaml:12", "origin_left_m", "3 were expected"});
  expect_in(complaint(clock + "modes: [1024x10]\n"), {"modes", "timing: encoder"});
  expect_in(complaint(clock + "column_window: [0, 10]\n"), {"column_window", "timing: encoder"});
  expect_in(complaint(clock + "default_rate_hz: 30\n"), {"mine.yaml:12", "default_rate_hz", "max_rate_hz (20)"});
  expect_in(complaint(start + "timing: clock\ncycle_us: 5000\n"), {"cycle_us", "fewer than 16 cycles"});
  expect_in(complaint(encoder + "column_window: [0, 1024]\n"), {"mine.yaml:12", "column_window", "0 to 1023"});
  expect_in(complaint(encoder + "column_window: [0]\n"), {"column_window", "[first, last]"});
  expect_in(complaint(encoder + "default_mode: 512x10\n"), {"mine.yaml:12", "default_mode", "1024x10"});
  expect_in(complaint(start + "timing: encoder\nmodes: [fast]\n"), {"mine.yaml:11", "modes", "'fast' is no mode"});
  expect_in(complaint(start + "timing: encoder\nmodes: [1024x10, 512x10]\n"), {"default_mode"});
  expect_in(complaint(start + "timing: pulse\n"), {"mine.yaml:10", "timing", "encoder, clock"});
  expect_in(complaint(clock + "elevation_dog: [1]\n"),
            {"mine.yaml:12", "elevation_dog", "did you mean 'elevation_deg'"});
  expect_in(complaint(std::string(optics) + clock_timing + "elevation_deg: [91]\nazimuth_offset_cw_deg: [0]\n"),
            {"mine.yaml:10", "elevation_deg", "91", "at most 90"});
}

TEST_F(UserSensor, ImpossibleStatesAreRefusedWithLineAndField) {
  const std::string start =
      std::string(optics) + "elevation_deg: [0, 1, 2]\nazimuth_offset_cw_deg: [0, 0, 0]\n" + clock_timing + "states:\n";
  const auto state = [](const std::string& values) { return "  - firing_us: [" + values + "]\n"; };
  EXPECT_EQ(complaint(start + state("30, 0, 12") + state("-1, 3, -1")), "");
  expect_in(complaint(start + state("0, 1") + state("0, 1, 2")), {"mine.yaml:13", "2 values", "3 were expected"});
  expect_in(complaint(start + state("0, 1, 2") + state("0, 1, -0.5")), {"mine.yaml:14", "channel 2", "-0.5", "silent"});
  expect_in(complaint(start + state("0, 1, 2") + state("-1, -1, -1")), {"mine.yaml:14", "no channel fires"});
  expect_in(complaint(start + state("0, 1, 50") + state("0, 1, 2")), {"mine.yaml:13", "take 50 us", "after 50 us"});
  expect_in(complaint(start + state("30, 40, 70") + state("5, 6, 7")), {"mine.yaml:14", "before the state before it"});
  expect_in(complaint(start + state("5, 6, 7") + state("40, 50, 60")), {"mine.yaml:13", "before the state before it"});
  expect_in(complaint(start + state("0, 1, -1")), {"mine.yaml:12", "channel 2 fires in none"});
  expect_in(complaint(start + state("0, .nan, 1")), {"mine.yaml:13", "firing_us", "finite"});
  expect_in(complaint(start + state("0, 1, 2") + "firing_us: [0, 1, 2]\n"), {"mine.yaml:14", "stands beside states"});
  expect_in(complaint(std::string(optics) + "elevation_deg: [0]\nazimuth_offset_cw_deg: [0]\ntiming: encoder\n" +
                      "modes: [512x10]\nstates:\n" + state("0")),
            {"states", "belong to timing: clock"});
}

TEST_F(UserSensor, ImpossiblePrismsAreRefusedWithLineAndField) {
  const std::string beam = "elevation_deg: [0]\nazimuth_offset_cw_deg: [0]\n", speeds = "prism_hz: [-100, 70]\n";
  const std::string start = std::string(optics) + "timing: prism\ncycle_us: 10\n";
  EXPECT_EQ(complaint(start + beam + speeds + "prism_wedge_deg: [18, 17]\n"), "");
  expect_in(complaint(start + beam + speeds), {"mine.yaml", "prism_wedge_deg", "is missing"});
  expect_in(complaint(start + beam + speeds + "prism_wedge_deg: [18]\n"),
            {"mine.yaml:13", "prism_wedge_deg", "has 1 values", "two wedges"});
  expect_in(complaint(start + beam + speeds + "prism_wedge_deg: [55, 55]\n"),
            {"mine.yaml:13", "prism_wedge_deg", "let no light out", "0 degrees apart"});
  expect_in(complaint(start + beam + speeds + "prism_wedge_deg: [90, 5]\n"), {"mine.yaml:13", "below 60"});
  expect_in(complaint(start + "elevation_deg: [0, 1]\nazimuth_offset_cw_deg: [0, 0]\n" + speeds +
                      "prism_wedge_deg: [18, 17]\n"),
            {"mine.yaml:10", "elevation_deg", "one channel"});
  expect_in(complaint(std::string(optics) + clock_timing + beam + speeds), {"timing", "clock", "wedges belong"});
}

TEST_F(UserSensor, MalformedTablesAreRefusedWithFileLineAndColumn) {
  const std::string yaml = std::string(clock_timing) + optics + "channels: table.csv\n";
  const std::string header = "elevation_deg,azimuth_offset_cw_deg,firing_us\n";
  const auto about = [&](const std::string& csv) {
    write("table.csv", csv);
    return complaint(yaml);
  };
  EXPECT_EQ(about(header + "1,0,0\r\n2,0,+1.5\r\n"), "");
  expect_in(about(header + "1,0,0\n2,0\n"), {"table.csv:3", "2 values", "names 3"});
  expect_in(about(header + "1,0,0\n2,zero,1\n"), {"table.csv:3", "azimuth_offset_cw_deg", "'zero'", "finite number"});
  expect_in(about(header + "1,0,nan\n"), {"table.csv:2", "firing_us", "finite"});
  expect_in(about(header + "100,0,0\n"), {"table.csv:2", "elevation_deg", "at most 90"});
  expect_in(about("elevation_dog,azimuth_offset_cw_deg\n"),
            {"table.csv:1", "elevation_dog", "did you mean 'elevation_deg'"});
  expect_in(about("elevation_deg,firing_us\n1,0\n"), {"table.csv:1", "azimuth_offset_cw_deg", "missing"});
  expect_in(about("elevation_deg,elevation_deg\n"), {"table.csv:1", "stands twice"});
  expect_in(about(header), {"table.csv", "no channels"});
  expect_in(about(header + "1,0,4\n2,0,2\n"), {"firing_us", "firing order"});
  write("table.csv", table);
  expect_in(complaint(yaml + "elevation_deg: [1, 2, 3, 4]\n"), {"mine.yaml:11", "elevation_deg", "table.csv as well"});
  expect_in(complaint(std::string(clock_timing) + optics + "channels: other.csv\n"), {"mine.yaml:10", "no such file"});
  expect_in(complaint(std::string(clock_timing) + optics + "channels: mine.yaml\n"), {"channels", ".csv", ".json"});
}

TEST_F(UserSensor, ScenarioSaysWhichOfItsLinesNamesTheBrokenFile) {
  const auto about = [&](const std::string& model) -> std::string {
    const fs::path scenario = write("scenario.yaml", "rig:\n  lidar:\n    model: " + model + "\n");
    try {
      read_rig(ConfigNode::load(scenario.string()).child("rig"));
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  };
  write("broken.yaml", "timing: clock\n");
  write("table.csv", table);
  expect_in(about("./broken.yaml"), {"scenario.yaml:3", "rig.lidar.model", "broken.yaml", "is missing"});
  expect_in(about("absent.yaml"), {"scenario.yaml:3", "no such sensor file"});
  expect_in(about("table.csv"), {"scenario.yaml:3", "channels: table.csv"});
}

TEST_F(UserSensor, InlineProfileIsCheckedLikeAFile) {
  const std::string rig = "lidar:\n  model: mine\n  profile:\n    timing: clock\n    elevation_deg: [0]\n";
  try {
    read_rig(ConfigNode::parse(rig, "test.yaml"));
    FAIL();
  } catch (const core::InputError& error) {
    expect_in(error.what(), {"test.yaml:3", "lidar.profile.azimuth_offset_cw_deg", "is missing"});
  }
}

TEST_F(UserSensor, IsDescribedByItsPath) {
  write("table.csv", table);
  const fs::path file = write("mine.yaml", std::string(clock_timing) + optics + "channels: table.csv\n");
  expect_in(describe_lidar(file.string()), {"mine", "3.2500", "0.2000", "origin"});
}

}  // namespace
}  // namespace tarmac::sim
