#include "core/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/config.h"
#include "tests/core/example_options.h"

namespace tarmac::core {
namespace {

const OptionDescription* find(const std::vector<OptionDescription>& lines, const std::string& name) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.name == name; });
  return found == lines.end() ? nullptr : &*found;
}

ExampleOptions unusual() {
  ExampleOptions o;
  o.enabled = false;
  o.speed_m_s = 0.1 + 0.2;  // needs all 17 digits
  o.title = "quotes \" backslash \\ colon: hash # \ttab\nline";
  o.size_m = {1e-300, 1e300};
  o.gains = {};
  o.names = {"null", "Null", "~", "", "true", "12", " lead", "- dash", "[", "NULL"};
  o.T_body_lidar.linear() = so3::exp({0.1, -0.7, 2.9});
  o.T_body_lidar.translation() = Eigen::Vector3d(1, -2, 1.0 / 3);
  o.engine.serial = -9007199254740993;
  o.wheels = {{.radius_m = 7, .side = "right"}};
  return o;
}

void expect_same(const ExampleOptions& a, const ExampleOptions& b) {
  EXPECT_EQ(a.enabled, b.enabled);
  EXPECT_EQ(a.speed_m_s, b.speed_m_s);
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.size_m, b.size_m);
  EXPECT_EQ(a.offset_m, b.offset_m);
  EXPECT_EQ(a.gains, b.gains);
  EXPECT_EQ(a.names, b.names);
  EXPECT_LT((a.T_body_lidar.matrix() - b.T_body_lidar.matrix()).norm(), 1e-15);
  EXPECT_EQ(a.engine.cylinders, b.engine.cylinders);
  EXPECT_EQ(a.engine.serial, b.engine.serial);
  ASSERT_EQ(a.wheels.size(), b.wheels.size());
  for (std::size_t i = 0; i < a.wheels.size(); ++i) {
    EXPECT_EQ(a.wheels[i].radius_m, b.wheels[i].radius_m);
    EXPECT_EQ(a.wheels[i].side, b.wheels[i].side);
  }
}

TEST(WriteOptions, ReadsBackAsTheSameValues) {
  for (const ExampleOptions& written : {ExampleOptions{}, unusual()}) {
    const std::string text = write_options(written);
    ExampleOptions read;
    ConfigNode::parse(text, "written").read(read);
    expect_same(read, written);
    EXPECT_EQ(write_options(read), text);
  }
}

TEST(WriteOptions, AnEmptyListIsWrittenAsOneAndNotAsTheDefault) {
  ExampleOptions written;
  written.wheels.clear();
  ExampleOptions read;
  ConfigNode::parse(write_options(written), "written").read(read);
  EXPECT_TRUE(read.wheels.empty());
}

TEST(WriteOptions, IndentedTextIsABlockOfItsOwn) {
  const std::string text = "outer:\n" + write_options(unusual(), 4);
  ExampleOptions read;
  ConfigNode::parse(text, "written").child("outer").read(read);
  expect_same(read, unusual());
}

TEST(DescribeOptions, ListsEveryOptionOnceWithItsTypeDefaultRangeAndMeaning) {
  const std::vector<OptionDescription> lines = describe_options<ExampleOptions>();
  std::vector<std::string> names;
  for (const OptionDescription& line : lines) {
    names.push_back(line.name);
    EXPECT_FALSE(line.meaning.empty()) << line.name;
    EXPECT_FALSE(line.type.empty()) << line.name;
  }
  EXPECT_THAT(names, ::testing::ElementsAre("enabled", "speed_m_s", "title", "size_m", "offset_m", "gains", "names",
                                            "T_body_lidar", "engine.cylinders", "engine.serial", "wheels",
                                            "wheels[].radius_m", "wheels[].side"));
  const OptionDescription* speed = find(lines, "speed_m_s");
  ASSERT_NE(speed, nullptr);
  EXPECT_EQ(speed->default_value, "1.5");
  EXPECT_EQ(speed->allowed, "at least 0 and below 100");
  EXPECT_EQ(speed->meaning, "how fast");
  EXPECT_EQ(find(lines, "wheels[].side")->allowed, "one of left, right");
  EXPECT_EQ(find(lines, "engine.serial")->allowed, "");
}

TEST(DescribeOptions, ShowsTheValuesThatItIsGiven) {
  ExampleOptions options;
  options.engine.cylinders = 11;
  EXPECT_EQ(find(describe_options(options), "engine.cylinders")->default_value, "11");
}

TEST(Range, HoldsAtTheBoundsThatIncludeThem) {
  const Range r{.above = 0, .at_most = 1};
  EXPECT_FALSE(r.holds(0));
  EXPECT_TRUE(r.holds(1e-300));
  EXPECT_TRUE(r.holds(1));
  EXPECT_FALSE(r.holds(1 + 1e-15));
  EXPECT_EQ(r.text(), "above 0 and at most 1");
  EXPECT_EQ(Range{}.text(), "");
}

}  // namespace
}  // namespace tarmac::core
