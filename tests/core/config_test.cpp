#include "core/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "core/files.h"
#include "tests/core/example_options.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;

ConfigNode parse(const std::string& text) {
  return ConfigNode::parse(text, "drive.yaml");
}

ExampleOptions read(const std::string& text) {
  ExampleOptions options;
  parse(text).read(options);
  return options;
}

std::string error_of(const std::string& text) {
  return message_of<InputError>([&] { read(text); });
}

TEST(Config, AbsentKeysKeepTheirDefaults) {
  const ExampleOptions options = read("speed_m_s: 3\n");
  EXPECT_EQ(options.speed_m_s, 3);
  EXPECT_EQ(options.title, ExampleOptions{}.title);
  EXPECT_EQ(options.wheels.size(), ExampleOptions{}.wheels.size());
  EXPECT_EQ(options.wheels[1].radius_m, ExampleOptions{}.wheels[1].radius_m);
}

TEST(Config, AnEmptyFileIsAnEmptyBlock) {
  EXPECT_EQ(read("").speed_m_s, ExampleOptions{}.speed_m_s);
  EXPECT_EQ(read("# nothing but a remark\n").speed_m_s, ExampleOptions{}.speed_m_s);
}

TEST(Config, ReadsEveryKindOfValue) {
  const ExampleOptions o = read(R"(
enabled: false
speed_m_s: 2.5e1
title: "no: plain word"
size_m: [3, 4]
offset_m: [1, -2, 0.5]
gains: [1, 2, 3]
names: [x]
T_body_lidar: {xyz_m: [1, 2, 3], rpy_deg: [0, 0, 90]}
engine:
  cylinders: 6
  serial: 9007199254740993
wheels:
  - {radius_m: 0.5}
  - side: right
  - {}
)");
  EXPECT_FALSE(o.enabled);
  EXPECT_EQ(o.speed_m_s, 25);
  EXPECT_EQ(o.title, "no: plain word");
  EXPECT_EQ(o.size_m, Eigen::Vector2d(3, 4));
  EXPECT_EQ(o.offset_m, Eigen::Vector3d(1, -2, 0.5));
  EXPECT_THAT(o.gains, ElementsAre(1, 2, 3));
  EXPECT_THAT(o.names, ElementsAre("x"));
  EXPECT_LT((o.T_body_lidar * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-15);
  EXPECT_EQ(o.engine.cylinders, 6);
  EXPECT_EQ(o.engine.serial, 9007199254740993) << "2^53 + 1: never through a double";
  ASSERT_EQ(o.wheels.size(), 3u);
  EXPECT_EQ(o.wheels[0].radius_m, 0.5);
  EXPECT_EQ(o.wheels[1].side, "right");
  EXPECT_EQ(o.wheels[2].radius_m, WheelOptions{}.radius_m);
}

TEST(Config, PosesTakeEulerAnglesInTheOrderYawPitchRollOrAQuaternion) {
  const double half = std::numbers::pi / 180 / 2;
  const ExampleOptions euler = read("T_body_lidar: {rpy_deg: [10, 20, 30]}");
  const Eigen::Quaterniond q = Eigen::Quaterniond(std::cos(30 * half), 0, 0, std::sin(30 * half)) *
                               Eigen::Quaterniond(std::cos(20 * half), 0, std::sin(20 * half), 0) *
                               Eigen::Quaterniond(std::cos(10 * half), std::sin(10 * half), 0, 0);
  EXPECT_LT((euler.T_body_lidar.linear() - q.toRotationMatrix()).norm(), 1e-15);
  const ExampleOptions quat = read("T_body_lidar: {xyz_m: [0, 0, 2], quat_xyzw: [0, 0, 1, 0]}");
  EXPECT_LT((quat.T_body_lidar * Eigen::Vector3d(1, 1, 0) - Eigen::Vector3d(-1, -1, 2)).norm(), 1e-15);
  EXPECT_THAT(error_of("T_body_lidar: {quat_xyzw: [0, 0, 1, 1]}"), HasSubstr("T_body_lidar.quat_xyzw"));
  EXPECT_THAT(error_of("T_body_lidar: {quat_xyzw: [0, 0, 0, 1], rpy_deg: [0, 0, 0]}"), HasSubstr("not both"));
  EXPECT_THAT(error_of("T_body_lidar: {xyz: [0, 0, 0]}"), HasSubstr("did you mean 'xyz_m'"));
}

TEST(Config, AnUnknownKeyIsAnErrorWithItsLineAndASuggestion) {
  EXPECT_THAT(error_of("enabled: true\nspeed_ms: 4\n"),
              AllOf(StartsWith("drive.yaml:2: speed_ms: "), HasSubstr("did you mean 'speed_m_s'?")));
  EXPECT_THAT(error_of("engine:\n  cylinders: 4\n  cilinders: 5\n"),
              AllOf(StartsWith("drive.yaml:3: engine.cilinders: "), HasSubstr("did you mean 'cylinders'?")));
  EXPECT_THAT(error_of("wheels:\n  - radius_m: 1\n  - {radius: 2}\n"),
              AllOf(StartsWith("drive.yaml:3: wheels.1.radius: "), HasSubstr("did you mean 'radius_m'?")));
}

TEST(Config, AnUnknownKeyThatResemblesNothingListsWhatIsKnown) {
  EXPECT_THAT(error_of("zzzzzzzzz: 1\n"),
              AllOf(StartsWith("drive.yaml:1: zzzzzzzzz: "), HasSubstr("enabled, speed_m_s")));
}

TEST(Config, AnUnknownKeyWithoutAValueStillHasItsLine) {
  EXPECT_THAT(error_of("enabled: true\nspeed_ms:\n"), StartsWith("drive.yaml:2: speed_ms: "));
}

TEST(Config, KeysLeftToTheCallerAreAllowed) {
  ExampleOptions options;
  parse("kind: path\nspeed_m_s: 2\n").read(options, {"kind"});
  EXPECT_EQ(options.speed_m_s, 2);
  EXPECT_THAT(message_of<InputError>([&] { parse("knd: path\n").read(options, {"kind"}); }),
              HasSubstr("did you mean 'kind'?"));
}

TEST(Config, WrongTypesAreErrorsThatShowTheValue) {
  EXPECT_THAT(error_of("enabled: 1"), AllOf(StartsWith("drive.yaml:1: enabled: "), HasSubstr("true or false")));
  EXPECT_THAT(error_of("speed_m_s: fast"), AllOf(HasSubstr("'fast'"), HasSubstr("finite number")));
  EXPECT_THAT(error_of("speed_m_s: 3 m"), HasSubstr("'3 m'"));
  EXPECT_THAT(error_of("speed_m_s: .nan"), HasSubstr("finite number"));
  EXPECT_THAT(error_of("speed_m_s: .inf"), HasSubstr("finite number"));
  EXPECT_THAT(error_of("speed_m_s: [1]"), HasSubstr("single value"));
  EXPECT_THAT(error_of("engine: {cylinders: 4.5}"), HasSubstr("whole number"));
  EXPECT_THAT(error_of("engine: {cylinders: 99999999999}"), HasSubstr("whole number"));
  EXPECT_THAT(error_of("engine: 4"), HasSubstr("block"));
  EXPECT_THAT(error_of("gains: 4"), HasSubstr("list"));
  EXPECT_THAT(error_of("gains: [1, x]"), HasSubstr("gains.1"));
  EXPECT_THAT(error_of("size_m: [1, 2, 3]"), HasSubstr("3 numbers, 2 were expected"));
  EXPECT_THAT(error_of("wheels: {radius_m: 1}"), HasSubstr("list"));
  EXPECT_THAT(error_of("wheels: [3]"), HasSubstr("wheels.0"));
  EXPECT_THAT(error_of("- 1\n- 2\n"), HasSubstr("block"));
}

TEST(Config, ValuesOutOfRangeAreErrorsThatSayTheRange) {
  EXPECT_THAT(error_of("title: x\nspeed_m_s: -1\n"),
              AllOf(StartsWith("drive.yaml:2: speed_m_s: "), HasSubstr("-1 must be at least 0 and below 100")));
  EXPECT_THAT(error_of("speed_m_s: 100"), HasSubstr("below 100"));
  EXPECT_EQ(read("speed_m_s: 0").speed_m_s, 0) << "at_least takes the bound itself";
  EXPECT_THAT(error_of("gains: [1, 0]"), HasSubstr("above 0"));
  EXPECT_THAT(error_of("engine: {cylinders: 13}"), HasSubstr("at least 1 and at most 12"));
  EXPECT_THAT(error_of("wheels: [{side: rigth}]"),
              AllOf(HasSubstr("wheels.0.side"), HasSubstr("left, right"), HasSubstr("did you mean 'right'?")));
}

TEST(Config, ARepeatedKeyIsAnErrorAtItsSecondLine) {
  EXPECT_THAT(error_of("title: a\nenabled: true\ntitle: b\n"),
              AllOf(StartsWith("drive.yaml:3: title: "), HasSubstr("twice")));
  EXPECT_THAT(error_of("engine:\n  serial: 1\n  serial: 1\n"), StartsWith("drive.yaml:3: engine.serial: "));
}

TEST(Config, TextThatIsNoYamlIsAnErrorWithLineAndColumn) {
  EXPECT_THAT(error_of("title: a\nsize_m: [1, 2\n"), AllOf(StartsWith("drive.yaml:"), HasSubstr("no YAML")));
  EXPECT_THAT(error_of("a: b: c\n"), AllOf(StartsWith("drive.yaml:1: column "), HasSubstr("no YAML")));
}

TEST(Config, ASelfReferenceIsAnErrorAndNoEndlessLoop) {
  EXPECT_THAT(error_of("names: &a [*a]\n"), StartsWith("drive.yaml:1"));
}

TEST(Config, AFileThatCannotBeReadIsAnError) {
  EXPECT_THAT(message_of<InputError>([] { ConfigNode::load("/nowhere/drive.yaml"); }),
              HasSubstr("/nowhere/drive.yaml"));
}

TEST(Config, LoadNamesTheFileAndLine) {
  const tests::TemporaryFolder folder;
  write_file(folder / "drive.yaml", "enabled: true\ntitel: x\n");
  ExampleOptions options;
  EXPECT_THAT(message_of<InputError>([&] { ConfigNode::load(folder / "drive.yaml").read(options); }),
              StartsWith((folder / "drive.yaml").string() + ":2: titel: "));
}

TEST(ConfigNode, WalksBlocksListsAndScalars) {
  const ConfigNode root = parse("b: {x: 1}\na:\n  - one\n  - two\n");
  EXPECT_THAT(root.keys(), ElementsAre("b", "a")) << "in the file's order";
  EXPECT_TRUE(root.is_block());
  EXPECT_TRUE(root.child("a").is_list());
  EXPECT_EQ(root.child("a").items()[1].scalar("item"), "two");
  EXPECT_EQ(root.child("a").items()[1].line(), 4);
  EXPECT_EQ(root.child("b").child("x").scalar("x"), "1");
  EXPECT_FALSE(root.child("c").present());
  EXPECT_FALSE(root.child("c").child("d").present()) << "an absent node reads as an empty block";
  EXPECT_EQ(root.child("c").scalar_or("otherwise"), "otherwise");
  EXPECT_THAT(message_of<InputError>([&] { root.child("c").scalar("c"); }), HasSubstr("c is missing"));
  EXPECT_THAT(message_of<InputError>([&] { root.fail_at("c", "is needed"); }),
              StartsWith("drive.yaml:1: c: is needed"));
  EXPECT_THAT(message_of<InputError>([&] { root.child("b").fail_at("y", "is needed"); }),
              StartsWith("drive.yaml:1: b.y: is needed"));
  EXPECT_EQ(root.file(), "drive.yaml");
}

TEST(ConfigNode, TextReadsBackAsTheSame) {
  const std::string text = "a: 1\nb:\n  - {c: \"true\"}\n  - ~\n";
  const ConfigNode again = parse(parse(text).text());
  EXPECT_EQ(again.child("a").scalar("a"), "1");
  EXPECT_EQ(again.child("b").items()[0].child("c").scalar("c"), "true");
  EXPECT_FALSE(again.child("b").items()[1].present());
}

TEST(ConfigNode, LookingForAKeyDoesNotMakeIt) {
  const ConfigNode root = parse("a: 1\n");
  (void)root.child("b").child("c").present();
  EXPECT_THAT(root.keys(), ElementsAre("a"));
  EXPECT_EQ(root.text(), "a: 1\n");
}

TEST(ConfigSet, OverridesAndAddsValuesAlsoInsideLists) {
  ConfigNode root = parse("speed_m_s: 1\nwheels:\n  - radius_m: 1\n  - radius_m: 2\ngains: [1, 2]\n");
  root.set("speed_m_s", "7");
  root.set("wheels.1.radius_m", "3");
  root.set("wheels.0.side", "right");
  root.set("gains.0", "9");
  root.set("engine.cylinders", "8");
  root.set("size_m", "[5, 6]");
  root.set("T_body_lidar", "{xyz_m: [1, 2, 3]}");
  ExampleOptions o;
  root.read(o);
  EXPECT_EQ(o.speed_m_s, 7);
  EXPECT_EQ(o.wheels[0].radius_m, 1);
  EXPECT_EQ(o.wheels[0].side, "right");
  EXPECT_EQ(o.wheels[1].radius_m, 3);
  EXPECT_THAT(o.gains, ElementsAre(9, 2));
  EXPECT_EQ(o.engine.cylinders, 8);
  EXPECT_EQ(o.size_m, Eigen::Vector2d(5, 6));
  EXPECT_EQ(o.T_body_lidar.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(ConfigSet, WorksOnAnEmptyConfiguration) {
  ConfigNode root = parse("");
  root.set("engine.cylinders", "2");
  ExampleOptions o;
  root.read(o);
  EXPECT_EQ(o.engine.cylinders, 2);
}

TEST(ConfigSet, ErrorsNameTheArgumentNotALine) {
  const auto error_after = [](const std::string& path, const std::string& value) {
    return message_of<InputError>([&] {
      ConfigNode root = parse("speed_m_s: 1\nwheels:\n  - radius_m: 1\ntitle: x\n");
      root.set(path, value);
      ExampleOptions o;
      root.read(o);
    });
  };
  EXPECT_THAT(error_after("speed_m_s", "-4"), AllOf(StartsWith("--set speed_m_s"), HasSubstr("at least 0")));
  EXPECT_THAT(error_after("wheels.0.radius_m", "0"), StartsWith("--set wheels.0.radius_m"));
  EXPECT_THAT(error_after("wheels.5.radius_m", "1"),
              AllOf(StartsWith("--set wheels.5.radius_m=1"), HasSubstr("list of 1")));
  EXPECT_THAT(error_after("wheels.x.radius_m", "1"), HasSubstr("no index"));
  EXPECT_THAT(error_after("title.x", "1"), HasSubstr("inside a single value"));
  EXPECT_THAT(error_after("sped_m_s", "1"),
              AllOf(StartsWith("--set sped_m_s"), HasSubstr("did you mean 'speed_m_s'?")));
  EXPECT_THAT(error_after("engine", "{cylinders: 99}"), StartsWith("--set engine"));
  EXPECT_THAT(error_after("engine", "{serial: 1, serial: 2}"), AllOf(StartsWith("--set engine"), HasSubstr("twice")));
  EXPECT_THAT(error_after("", "1"), HasSubstr("dotted path"));
  EXPECT_THAT(error_after("a..b", "1"), HasSubstr("dotted path"));
  EXPECT_THAT(error_after("speed_m_s", "[1"), HasSubstr("no YAML"));
}

TEST(ConfigSet, OneArgumentDoesNotTakeTheBlameForAnother) {
  const std::string message = message_of<InputError>([] {
    ConfigNode root = parse("speed_m_s: 1\ntitle: x\nspeed: 2\n");
    root.set("title", "y");
    ExampleOptions o;
    root.read(o);
  });
  EXPECT_THAT(message, StartsWith("drive.yaml:3: speed: "));
}

TEST(DidYouMean, FindsTyposAndLeavesStrangersAlone) {
  const std::vector<std::string> known = {"voxel_size_m", "max_range_m", "deskew"};
  EXPECT_EQ(did_you_mean("voxelsize_m", known), "voxel_size_m");
  EXPECT_EQ(did_you_mean("deskw", known), "deskew");
  EXPECT_EQ(did_you_mean("max_rnage_m", known), "max_range_m");
  EXPECT_EQ(did_you_mean("gravity", known), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

}  // namespace
}  // namespace tarmac::core
