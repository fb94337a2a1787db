// The sweep file: which cells it makes, and what its mistakes are told as.
#include "scenarios/sweep_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/config.h"
#include "core/files.h"
#include "tests/scenarios/sweep_support.h"

namespace tarmac::scenarios {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
namespace fs = std::filesystem;

TEST_F(SweepFileTest, OneBlockOfOneScenarioIsOneCellPerSeedAndEstimator) {
  const SweepFile sweep =
      load("name: nightly\nwhy: because\nseeds: 1..2\nestimators: [kiss-icp, ct-icp]\nblocks:\n  - scenario: slalom\n");
  EXPECT_EQ(sweep.name, "nightly");
  EXPECT_EQ(sweep.why, "because");
  EXPECT_EQ(sweep.diagnostics, "system");
  EXPECT_EQ(sweep.keep, "estimates");
  ASSERT_EQ(sweep.cells.size(), 4U);
  std::vector<std::pair<std::uint64_t, std::string>> order;
  for (const SweepCell& cell : sweep.cells) {
    order.emplace_back(cell.seed, cell.estimator);
    EXPECT_EQ(cell.block, "slalom");
    EXPECT_EQ(cell.scenario, "slalom");
    EXPECT_EQ(cell.case_name, "slalom");
    EXPECT_THAT(cell.sets, IsEmpty());
    EXPECT_THAT(cell.parameters, IsEmpty());
    EXPECT_THAT(cell.place, AllOf(HasSubstr("s.yaml:6"), HasSubstr("blocks.0")));
  }
  EXPECT_THAT(order, ElementsAre(Pair(1, "kiss-icp"), Pair(1, "ct-icp"), Pair(2, "kiss-icp"), Pair(2, "ct-icp")));
}

TEST_F(SweepFileTest, KeepsItsTextAndReadsHowCellsAreRun) {
  const std::string text =
      "name: s\nseeds: 1\nestimators: kiss-icp\ndiagnostics: none\nkeep: everything\n"
      "limits: {wall_s: 20, memory_mb: 512}\nblocks:\n  - scenario: slalom\n";
  const SweepFile sweep = load(text);
  EXPECT_EQ(sweep.text, text);
  EXPECT_EQ(sweep.diagnostics, "none");
  EXPECT_EQ(sweep.keep, "everything");
  EXPECT_EQ(sweep.limits.wall_s, 20);
  EXPECT_EQ(sweep.limits.cpu_s, SweepLimits().cpu_s);
  EXPECT_EQ(sweep.limits.memory_mb, 512);
}

TEST_F(SweepFileTest, TheLastKeyOfAGridRunsFastest) {
  const SweepFile sweep = load_block("    name: grid\n    vary: {motion.a: [1, 2], rig.b: [x, y]}\n");
  EXPECT_THAT(cases(sweep), ElementsAre("grid motion.a=1 rig.b=x", "grid motion.a=1 rig.b=y", "grid motion.a=2 rig.b=x",
                                        "grid motion.a=2 rig.b=y"));
  EXPECT_THAT(sweep.cells[1].parameters, ElementsAre(Pair("motion.a", "1"), Pair("rig.b", "y")));
}

TEST_F(SweepFileTest, RangesIncludeBothEndsAndReadWell) {
  const auto grid = [&](const std::string& range) {
    return values(load_block("    vary: {motion.a: " + range + "}\n"), "motion.a");
  };
  EXPECT_THAT(grid("{from: 512, to: 2048, steps: 3, scale: log}"), ElementsAre("512", "1024", "2048"));
  EXPECT_THAT(grid("{from: 0, to: 0.5, steps: 6}"), ElementsAre("0", "0.1", "0.2", "0.3", "0.4", "0.5"));
  EXPECT_THAT(grid("{from: -0.3, to: 0.3, steps: 7}"), ElementsAre("-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(grid("{from: 0.25, to: 2, steps: 4, scale: log}"), ElementsAre("0.25", "0.5", "1", "2"));
  EXPECT_THAT(grid("{from: 1, to: 2, steps: 2}"), ElementsAre("1", "2"));
  EXPECT_THAT(grid("{from: 1, to: 2, steps: 3}"), ElementsAre("1", "1.5", "2"));
  EXPECT_THAT(grid("{from: 1, to: 100, steps: 3, scale: log, integer: true}"), ElementsAre("1", "10", "100"));
  EXPECT_THAT(grid("{from: 1, to: 4, steps: 3, integer: true}"), ElementsAre("1", "3", "4"));
  EXPECT_THAT(grid("{from: 1e6, to: 3e6, steps: 3}"), ElementsAre("1000000", "2000000", "3000000"));
}

/// Steps have even distances, of the value or of its logarithm, for ends that nobody chose to be nice.
TEST_F(SweepFileTest, RangesHaveEvenStepsWhateverTheEnds) {
  for (const bool log : {false, true}) {
    const std::vector<std::string> texts =
        values(load_block(std::string("    vary: {motion.a: {from: 0.37, to: 91.3, steps: 8, scale: ") +
                          (log ? "log" : "linear") + "}}\n"),
               "motion.a");
    ASSERT_EQ(texts.size(), 8U);
    EXPECT_EQ(texts.front(), "0.37");
    EXPECT_EQ(texts.back(), "91.3");
    const auto at = [&](std::size_t i) { return log ? std::log(std::stod(texts[i])) : std::stod(texts[i]); };
    for (std::size_t i = 1; i < 8; ++i) EXPECT_NEAR(at(i) - at(i - 1), (at(7) - at(0)) / 7, 1e-10 * std::abs(at(7)));
  }
}

TEST_F(SweepFileTest, ListedValuesMayBeAnythingThatYamlCanSay) {
  const SweepFile sweep = load_block(
      "    vary:\n"
      "      motion.path:\n"
      "        - [{straight_m: 4}, {turn_deg: 90, radius_m: 6}]\n"
      "        - - straight_m: 9\n"
      "      scene: [{kind: stand}]\n"
      "      faults.note: ['null', 'a: b', \"it's\", '', yes, \"two\\nlines\"]\n");
  ASSERT_EQ(sweep.cells.size(), 12U);
  const auto read_back = [](const SweepCell& cell) {
    core::ConfigNode node = core::ConfigNode::parse("scene: {kind: hangar}\n", "test");
    for (const auto& [path, value] : cell.sets) node.set(path, value);
    return node;
  };
  const core::ConfigNode first = read_back(sweep.cells[0]), last = read_back(sweep.cells[11]);
  EXPECT_EQ(first.child("motion").child("path").items().at(1).child("radius_m").scalar("r"), "6");
  EXPECT_EQ(last.child("motion").child("path").items().at(0).child("straight_m").scalar("r"), "9");
  EXPECT_EQ(first.child("scene").child("kind").scalar("kind"), "stand");
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < 6; ++i)
    notes.push_back(read_back(sweep.cells[i]).child("faults").child("note").scalar("n"));
  EXPECT_THAT(notes, ElementsAre("null", "a: b", "it's", "", "yes", "two\nlines"));
}

TEST_F(SweepFileTest, AForeignProgramsCommandGoesThroughAsAList) {
  const SweepFile sweep =
      load_block("    set: {estimators.my-tool.command: [prog, '{input}', '{output}']}\n", "[my-tool]");
  ASSERT_EQ(sweep.cells.size(), 1U);
  core::ConfigNode node = core::ConfigNode::parse("name: x\n", "test");
  for (const auto& [path, value] : sweep.cells[0].sets) node.set(path, value);
  std::vector<std::string> words;
  for (const auto& item : node.child("estimators").child("my-tool").child("command").items())
    words.push_back(item.scalar("word"));
  EXPECT_THAT(words, ElementsAre("prog", "{input}", "{output}"));
}

TEST_F(SweepFileTest, SettingsOfTheFileThenOfTheBlockThenParametersThenTheCommandLine) {
  const SweepFile sweep = load(
      "name: s\nseeds: 1\nestimators: [kiss-icp]\nset: {rig.a: 1, motion.b: 1}\nblocks:\n"
      "  - scenario: slalom\n    set: {rig.a: 2}\n    vary: {motion.b: [7]}\n",
      {{"faults.c", "3"}});
  EXPECT_THAT(sweep.cells.at(0).sets, ElementsAre(Pair("rig.a", "1"), Pair("motion.b", "1"), Pair("rig.a", "2"),
                                                  Pair("motion.b", "7"), Pair("faults.c", "3")));
  EXPECT_THAT(sweep.cells.at(0).parameters, ElementsAre(Pair("motion.b", "7")));
}

TEST_F(SweepFileTest, OptionsOfOneEstimatorDoNotRepeatTheOthersCells) {
  const SweepFile sweep = load_block(
      "    set: {estimators.ct-icp.max_iterations: 3}\n"
      "    vary: {estimators.kiss-icp.voxel_size_m: [0.5, 1], motion.a: [1, 2]}\n",
      "[kiss-icp, ct-icp]");
  std::map<std::string, std::vector<std::string>> by_estimator;
  for (const SweepCell& cell : sweep.cells) {
    by_estimator[cell.estimator].push_back(cell.case_name);
    for (const auto& [path, value] : cell.sets) {
      EXPECT_FALSE(path.starts_with("estimators.") && !path.starts_with("estimators." + cell.estimator + "."))
          << cell.case_name << ": " << path;
    }
  }
  EXPECT_THAT(by_estimator["ct-icp"], ElementsAre("slalom motion.a=1", "slalom motion.a=2"));
  EXPECT_THAT(by_estimator["kiss-icp"], ElementsAre("slalom estimators.kiss-icp.voxel_size_m=0.5 motion.a=1",
                                                    "slalom estimators.kiss-icp.voxel_size_m=0.5 motion.a=2",
                                                    "slalom estimators.kiss-icp.voxel_size_m=1 motion.a=1",
                                                    "slalom estimators.kiss-icp.voxel_size_m=1 motion.a=2"));
}

TEST_F(SweepFileTest, BlocksHaveSeveralScenariosNamesOfTheirOwnAndSeedsOfTheirOwn) {
  write("name: own\n", "drives/own.yaml");
  const SweepFile sweep = load(
      "name: s\nseeds: [3, 5..6]\nestimators: [kiss-icp]\nblocks:\n"
      "  - scenario: [slalom, drives/own.yaml]\n    seeds: 9\n"
      "  - {name: both, scenario: [slalom, stand-turn]}\n");
  EXPECT_THAT(cases(sweep),
              ElementsAre("slalom", "own", "both scenario=slalom", "both scenario=slalom", "both scenario=slalom",
                          "both scenario=stand-turn", "both scenario=stand-turn", "both scenario=stand-turn"));
  EXPECT_EQ(sweep.cells[0].seed, 9U);
  EXPECT_EQ(sweep.cells[1].scenario, (folder_ / "drives/own.yaml").string());
  EXPECT_EQ(sweep.cells[1].block, "own");
  EXPECT_EQ(sweep.cells[2].seed, 3U);
  EXPECT_EQ(sweep.cells[4].seed, 6U);
  EXPECT_EQ(sweep.cells[4].block, "both");
}

TEST_F(SweepFileTest, ExclusionsTakeOutCellsThatMatchAllOfALine) {
  const std::string grid = "    vary: {motion.a: [1, 2, 3], rig.b: [x, y]}\n";
  EXPECT_THAT(cases(load_block(grid + "    exclude: [{motion.a: 2.0, rig.b: x}, {motion.a: 3}]\n")),
              ElementsAre("slalom motion.a=1 rig.b=x", "slalom motion.a=1 rig.b=y", "slalom motion.a=2 rig.b=y"));
  EXPECT_THAT(cases(load_block(grid + "    exclude: [{motion.a: {from: 1.5, to: 3}}, {rig.b: [x, z]}]\n")),
              ElementsAre("slalom motion.a=1 rig.b=y"));
}

TEST_F(SweepFileTest, ExclusionsKnowScenarioEstimatorAndSeed) {
  const SweepFile sweep = load(
      "name: s\nseeds: 1..2\nestimators: [kiss-icp, ct-icp]\nblocks:\n  - scenario: [slalom, stand-turn]\n"
      "    exclude: [{scenario: slalom, estimator: ct-icp}, {seed: 2, estimator: kiss-icp}]\n");
  std::set<std::string> left;
  for (const SweepCell& c : sweep.cells) left.insert(c.scenario + " " + c.estimator + " " + std::to_string(c.seed));
  EXPECT_THAT(left,
              ElementsAre("slalom kiss-icp 1", "stand-turn ct-icp 1", "stand-turn ct-icp 2", "stand-turn kiss-icp 1"));
}

TEST_F(SweepFileTest, AnEstimatorsOptionExcludesCellsOfThatEstimatorOnly) {
  const SweepFile sweep = load_block(
      "    vary: {motion.a: [1, 2], estimators.kiss-icp.v: [1, 2]}\n"
      "    exclude: [{motion.a: 2, estimators.kiss-icp.v: 2}]\n",
      "[kiss-icp, ct-icp]");
  EXPECT_EQ(
      std::count_if(sweep.cells.begin(), sweep.cells.end(), [](const auto& c) { return c.estimator == "ct-icp"; }), 2);
  EXPECT_EQ(sweep.cells.size(), 5U);
}

/// Cells that are the same over seeds are paired by case and estimator: no two may share both.
TEST_F(SweepFileTest, CaseEstimatorAndSeedNameACell) {
  const SweepFile sweep = load(
      "name: s\nseeds: 1..3\nestimators: [kiss-icp, ct-icp]\nblocks:\n"
      "  - scenario: [slalom, stand-turn]\n"
      "  - {name: both, scenario: [slalom, stand-turn], vary: {motion.a: [1, 2], estimators.ct-icp.x: [1, 2, 3]}}\n"
      "  - name: drawn\n    scenario: slalom\n    vary: {rig.m: [p, q]}\n"
      "    draw: {count: 40, over: {faults.k: [1, 2, 3], estimators.kiss-icp.z: {from: 0, to: 1}}}\n");
  std::set<std::string> names;
  for (const SweepCell& c : sweep.cells) names.insert(c.case_name + "|" + c.estimator + "|" + std::to_string(c.seed));
  EXPECT_EQ(names.size(), sweep.cells.size());
}

/// The plan of a sweep is compared between processes and machines by its cells.
TEST_F(SweepFileTest, CellsDependOnNothingButTheFilesContent) {
  const std::string text =
      "name: s\nseeds: 1..3\nestimators: [kiss-icp, ct-icp]\nblocks:\n"
      "  - name: drawn\n    scenario: [slalom, stand-turn]\n    vary: {rig.m: [p, q]}\n"
      "    draw: {count: 9, method: latin-hypercube, seed: 3, over: {faults.k: [1, 2], motion.z: {from: 1, to: 9}}}\n"
      "    exclude: [{rig.m: q, seed: 2}]\n";
  const auto flat = [](const SweepFile& sweep) {
    std::string all;
    for (const SweepCell& c : sweep.cells) {
      all += c.block + "|" + c.scenario + "|" + c.case_name + "|" + std::to_string(c.seed) + "|" + c.estimator;
      for (const auto& [path, value] : c.sets) all += "|" + path + "=" + value;
      all += "\n";
    }
    return all;
  };
  const std::string first = flat(load(text));
  EXPECT_EQ(first, flat(load(text)));
  EXPECT_EQ(first, flat(load_sweep(write("# a comment\n\n" + text, "elsewhere/other-name.yaml"))));
  EXPECT_NE(first, flat(load(text + "    seeds: 2..4\n")));
}

TEST_F(SweepFileTest, EveryMistakeIsToldWithFileLineAndField) {
  const std::string top = "name: s\nseeds: 1\nestimators: [kiss-icp, ct-icp]\n";  // lines 1 to 3
  const std::string block = top + "blocks:\n  - scenario: slalom\n";              // line 5
  struct Mistake {
    std::string text;
    std::vector<std::string> fragments;
  };
  const std::vector<Mistake> mistakes = {
      {"", {"s.yaml", "block of `key: value`"}},
      {"just text\n", {"s.yaml:1", "block of `key: value`"}},
      {"name: [s\n", {"s.yaml:", "no YAML"}},
      {top + "name: t\nblocks: []\n", {"s.yaml:4", "name", "stands twice"}},
      {"seeds: 1\nblocks:\n  - {scenario: slalom, estimators: [a]}\n", {"s.yaml", "name", "kebab-case"}},
      {"name: My Sweep\n", {"s.yaml:1", "name", "kebab-case"}},
      {top + "block:\n  - scenario: slalom\n", {"s.yaml:4", "block", "did you mean 'blocks'"}},
      {top, {"s.yaml", "blocks", "missing"}},
      {top + "blocks: []\n", {"s.yaml:4", "blocks", "missing"}},
      {top + "blocks:\n", {"s.yaml:4", "blocks", "no value"}},
      {top + "blocks: {scenario: slalom}\n", {"s.yaml:4", "blocks", "must be a list"}},
      {top + "blocks: [slalom]\n", {"s.yaml:4", "blocks.0", "must be a block"}},
      {top + "blocks:\n  - name: x\n", {"s.yaml:5", "blocks.0.scenario", "missing"}},
      {top + "blocks:\n  - scenario: []\n", {"s.yaml:5", "blocks.0.scenario", "empty"}},
      {top + "blocks:\n  - scenario: {a: 1}\n", {"s.yaml:5", "blocks.0.scenario", "single value"}},
      {top + "blocks:\n  - scenario: [slalom, slalom]\n", {"s.yaml:5", "blocks.0.scenario.1", "slalom stands twice"}},
      {top + "blocks:\n  - scenario: drives/none.yaml\n", {"s.yaml:5", "blocks.0", "no such scenario file"}},
      {top + "diagnostics: all\nblocks: []\n", {"s.yaml:4", "diagnostics", "none, system, full"}},
      {top + "keep: estimate\nblocks: []\n", {"s.yaml:4", "keep", "did you mean 'estimates'"}},
      {top + "limits: {wall: 3}\nblocks: []\n", {"s.yaml:4", "limits.wall", "did you mean 'wall_s'"}},
      {top + "limits: {wall_s: 0}\nblocks: []\n", {"s.yaml:4", "limits.wall_s", "above 0"}},
      {top + "limits: {memory_mb: lots}\nblocks: []\n", {"s.yaml:4", "limits.memory_mb", "finite number"}},
      {top + "limits: 3\nblocks: []\n", {"s.yaml:4", "limits", "must be a block"}},

      {block + "    varry: {motion.a: [1]}\n", {"s.yaml:6", "blocks.0.varry", "did you mean 'vary'"}},
      {block + "    name: Two Words\n", {"s.yaml:6", "blocks.0.name", "kebab-case"}},
      {block + "  - scenario: slalom\n", {"s.yaml:6", "blocks.1", "another block is called slalom", "s.yaml:5"}},
      {block + "    name: x\n  - {scenario: stand-turn, name: x}\n", {"s.yaml:7", "blocks.1.name", "called x"}},
      {block + "  - {name: y, scenario: slalom}\n",
       {"s.yaml:6", "blocks.1", "kiss-icp of seed 1 in 'y' is the same as in 'slalom'", "s.yaml:5"}},
      {block + "    set: {motion.a: 1}\n  - {name: y, scenario: slalom, vary: {motion.a: [1.0, 2]}}\n",
       {"s.yaml:7", "'y motion.a=1.0' is the same as in 'slalom'"}},

      {block + "    seeds: -1\n", {"s.yaml:6", "blocks.0.seeds", "'-1' is no seed"}},
      {block + "    seeds: 3..1\n", {"s.yaml:6", "blocks.0.seeds", "ascend"}},
      {block + "    seeds: 1..99999999\n", {"s.yaml:6", "blocks.0.seeds", "at most 10000"}},
      {block + "    seeds: [1, 0..2]\n", {"s.yaml:6", "blocks.0.seeds.1", "seed 1 stands twice"}},
      {block + "    seeds: []\n", {"s.yaml:6", "blocks.0.seeds", "empty"}},
      {block + "    seeds:\n", {"s.yaml:6", "blocks.0.seeds", "no value"}},
      {block + "    seeds: {from: 1}\n", {"s.yaml:6", "blocks.0.seeds", "single value"}},
      {"name: s\nestimators: [a]\nblocks:\n  - scenario: x\n", {"s.yaml:4", "blocks.0.seeds", "missing here and"}},
      {"name: s\nseeds: 1\nblocks:\n  - scenario: x\n", {"s.yaml:4", "blocks.0.estimators", "missing here and"}},
      {block + "    estimators: all\n", {"s.yaml:6", "blocks.0.estimators", "one by one"}},
      {block + "    estimators: [kiss-icp, kiss-icp]\n", {"s.yaml:6", "estimators.1", "stands twice"}},
      {block + "    estimators: [kiss.icp]\n", {"s.yaml:6", "estimators", "no name of an estimator"}},

      {block + "    set: {motions.a: 1}\n", {"s.yaml:6", "set.motions.a", "did you mean 'motion'"}},
      {block + "    set: {motion..a: 1}\n", {"s.yaml:6", "part of the path is empty"}},
      {block + "    set: {motion.a: }\n", {"s.yaml:6", "set.motion.a", "no value"}},
      {block + "    set: {seed: 4}\n", {"s.yaml:6", "set.seed", "`seeds:`"}},
      {block + "    set: {duration_s.x: 4}\n", {"s.yaml:6", "duration_s.x", "nothing inside"}},
      {block + "    set: {estimators: {}}\n", {"s.yaml:6", "set.estimators", "name the estimator"}},
      {block + "    set: {estimators.kis-icp.v: 1}\n", {"s.yaml:6", "does not run kis-icp", "did you mean 'kiss-icp'"}},
      {block + "    set: {rig.lidar.model: x, rig.lidar: {}}\n", {"s.yaml:6", "set.rig.lidar", "put it first"}},
      {block + "set: {estimators.loam.v: 1}\n", {"s.yaml:6", "set.estimators.loam.v", "sweep does not run loam"}},
      {block + "    set: [motion.a]\n", {"s.yaml:6", "blocks.0.set", "must be a block"}},

      {block + "    vary: [motion.a]\n", {"s.yaml:6", "blocks.0.vary", "must be a block"}},
      {block + "    vary: {motion.a: 3}\n", {"s.yaml:6", "vary.motion.a", "list of values or a range"}},
      {block + "    vary: {motion.a: []}\n", {"s.yaml:6", "vary.motion.a", "empty"}},
      {block + "    vary:\n      motion.a:\n        - 1\n        -\n", {"s.yaml:", "vary.motion.a.1", "no value"}},
      {block + "    vary: {motion.a: [0.5, 1, 0.50]}\n", {"s.yaml:6", "motion.a.2", "0.50 stands in the list twice"}},
      {block + "    vary: {motion.a: {from: 1, to: 2}}\n", {"s.yaml:6", "motion.a.steps", "missing"}},
      {block + "    vary: {motion.a: {to: 1, steps: 2}}\n", {"s.yaml:6", "motion.a.from", "missing"}},
      {block + "    vary: {motion.a: {from: 3, to: 2, steps: 2}}\n", {"s.yaml:6", "motion.a.to", "must be above from"}},
      {block + "    vary: {motion.a: {from: 1, to: 2, steps: 1}}\n", {"s.yaml:6", "motion.a.steps", "at least 2"}},
      {block + "    vary: {motion.a: {from: 1, to: 2, steps: 2.5}}\n", {"s.yaml:6", "motion.a.steps", "whole number"}},
      {block + "    vary: {motion.a: {from: one, to: 2, steps: 2}}\n", {"s.yaml:6", "motion.a.from", "finite number"}},
      {block + "    vary: {motion.a: {from: 0, to: 2, steps: 2, scale: log}}\n",
       {"s.yaml:6", "motion.a.from", "above 0"}},
      {block + "    vary: {motion.a: {from: 1, to: 2, steps: 2, scale: lin}}\n", {"s.yaml:6", "scale", "linear, log"}},
      {block + "    vary: {motion.a: {from: 1, to: 2, step: 2}}\n",
       {"s.yaml:6", "motion.a.step", "did you mean 'steps'"}},
      {block + "    vary: {motion.a: {from: 1, to: 3, steps: 9, integer: true}}\n",
       {"s.yaml:6", "steps", "comes out twice"}},
      {block + "    vary: {motion.a: {from: 0.5, to: 3, steps: 2, integer: true}}\n",
       {"s.yaml:6", "integer", "whole numbers"}},
      {block + "    vary: {rig.lidar.model: [x], rig.lidar: [{}]}\n",
       {"s.yaml:6", "rig.lidar.model", "lies inside of rig.lidar"}},
      {block + "    vary: {estimators.loam.v: [1]}\n", {"s.yaml:6", "vary.estimators.loam.v", "does not run loam"}},
      {block + "    set: {motion.a: 1}\n    vary: {motion.a: [1, 2]}\n",
       {"s.yaml:6", "set.motion.a", "overwritten by motion.a"}},
      {block + "    vary: {motion.a: {from: 1, to: 2, steps: 1000}, motion.b: {from: 1, to: 2, steps: 1000}}\n",
       {"s.yaml:5", "blocks.0", "2000000 cells", "at most 1000000"}},

      {block + "    draw: {over: {motion.a: [1]}}\n", {"s.yaml:6", "draw.count", "missing"}},
      {block + "    draw: {count: 0, over: {motion.a: [1]}}\n", {"s.yaml:6", "draw.count", "at least 1"}},
      {block + "    draw: {count: [3], over: {motion.a: [1]}}\n", {"s.yaml:6", "draw.count", "single value"}},
      {block + "    draw: {count: 3}\n", {"s.yaml:6", "draw.over", "missing"}},
      {block + "    draw: {count: 3, over: {}}\n", {"s.yaml:6", "draw.over", "missing"}},
      {block + "    draw: {count: 3, methods: random, over: {motion.a: [1]}}\n",
       {"s.yaml:6", "draw.methods", "'method'"}},
      {block + "    draw: {count: 3, method: lhs, over: {motion.a: [1]}}\n",
       {"s.yaml:6", "draw.method", "latin-hypercube"}},
      {block + "    draw: {count: 3, over: {motion.a: {from: 1, to: 2, steps: 3}}}\n",
       {"s.yaml:6", "over.motion.a.steps"}},
      {block + "    draw: {count: 3, over: {motion.a: {from: -1, to: 2, scale: log}}}\n", {"s.yaml:6", "above 0"}},
      {block + "    draw: {count: 3, over: {motion.a: 7}}\n",
       {"s.yaml:6", "over.motion.a", "list of values or a range"}},
      {block + "    vary: {motion.a: [1]}\n    draw: {count: 3, over: {motion.a: [1]}}\n",
       {"s.yaml:7", "over.motion.a", "`vary` as well"}},
      {block + "    vary: {rig.lidar: [{}]}\n    draw: {count: 3, over: {rig.lidar.model: [x]}}\n",
       {"s.yaml:7", "over.rig.lidar.model", "overlap"}},
      {top + "blocks:\n  - scenario: [a, b]\n    draw: {count: 3, over: {motion.a: [1]}}\n",
       {"s.yaml:5", "blocks.0.name", "needs a name"}},

      {block + "    exclude: {motion.a: 1}\n", {"s.yaml:6", "blocks.0.exclude", "must be a list"}},
      {block + "    exclude: [seed]\n", {"s.yaml:6", "exclude.0", "must be a block"}},
      {block + "    exclude: [{}]\n", {"s.yaml:6", "exclude.0", "empty"}},
      {block + "    vary: {motion.ab: [1]}\n    exclude: [{motion.a: 1}]\n",
       {"s.yaml:7", "exclude.0.motion.a", "did you mean 'motion.ab'"}},
      {block + "    vary: {motion.a: [1, 2]}\n    exclude:\n      - {motion.a: 1}\n      - {motion.a: 3}\n",
       {"s.yaml:9", "exclude.1", "excludes nothing"}},
      {block + "    exclude: [{seed: {from: 3, to: 1}}]\n", {"s.yaml:6", "exclude.0.seed.to", "below"}},
      {block + "    exclude: [{seed: 1}]\n", {"s.yaml:6", "blocks.0.exclude", "nothing is left"}},
  };
  for (const auto& [text, fragments] : mistakes) {
    const std::string message = error_of(text);
    for (const std::string& fragment : fragments) EXPECT_THAT(message, HasSubstr(fragment)) << text;
  }
}

TEST_F(SweepFileTest, AFileThatIsNotThereIsNamed) {
  EXPECT_THROW(load_sweep(folder_ / "none.yaml"), core::InputError);
  try {
    load_sweep(folder_ / "none.yaml");
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.yaml"));
  }
}

TEST_F(SweepFileTest, TheCommandLineMayNotUndoWhatIsVaried) {
  const std::string text =
      "name: s\nseeds: 1\nestimators: [kiss-icp]\nblocks:\n  - scenario: slalom\n    vary: {rig.lidar.columns: [1, "
      "2]}\n";
  EXPECT_THAT(error_of(text, {{"rig.lidar.columns", "5"}}),
              AllOf(HasSubstr("--set rig.lidar.columns=5"), HasSubstr("s.yaml:5")));
  EXPECT_THAT(error_of(text, {{"rig.lidar", "{}"}}), HasSubstr("would undo rig.lidar.columns"));
  EXPECT_THAT(error_of(text, {{"estimators.ct-icp.x", "5"}}), HasSubstr("no block runs ct-icp"));
  EXPECT_EQ(error_of(text, {{"rig.lidar.model", "vlp-16"}, {"estimators.kiss-icp.x", "5"}}), "no error");
}

TEST_F(SweepFileTest, IsFoundByNameBesideTheScenariosAndIsNoScenario) {
  write("name: drive\n", "drive.yaml");
  const fs::path smoke = write("name: smoke\n", "sweeps/smoke.yaml");
  write("name: gate\n", "gates/smoke-gate.yaml");
  EXPECT_EQ(find_beside_scenarios("smoke", "sweeps", {folder_}), smoke);
  EXPECT_EQ(find_beside_scenarios(smoke.string(), "sweeps", {}), smoke);
  EXPECT_THAT(list_beside_scenarios("sweeps", {folder_, folder_ / "absent"}), ElementsAre(smoke));
  EXPECT_THAT(list_scenarios({folder_}), ElementsAre(folder_ / "drive.yaml"));
  try {
    find_beside_scenarios("smoky", "sweeps", {folder_});
    FAIL() << "found what does not exist";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("no such sweep"), HasSubstr("did you mean 'smoke'"), HasSubstr("tarmac list sweeps")));
  }
}

/// What docs/sweeps.md says of its own example.
TEST_F(SweepFileTest, TheDocumentedExampleMakesTheCellsThatItSays) {
  const std::string page = core::read_file(fs::path(TARMAC_SCENARIOS) / "../docs/sweeps.md");
  const std::size_t begin = page.find("```yaml\n") + 8;
  const SweepFile sweep = load(page.substr(begin, page.find("```", begin) - begin));
  std::map<std::string, std::set<std::string>> cases_of;
  for (const SweepCell& cell : sweep.cells) {
    cases_of[cell.block + " " + cell.estimator].insert(cell.case_name);
    load_scenario(find_scenario(cell.scenario, {TARMAC_SCENARIOS}), cell.sets);
  }
  EXPECT_EQ(cases_of["offset kiss-icp"].size(), 7U);
  EXPECT_EQ(cases_of["offset ct-icp"].size(), 3U);
  EXPECT_EQ(cases_of["rigs kiss-icp"].size(), 10U);
  const std::vector<std::string> drawn = values(sweep, "rig.lidar.model");
  EXPECT_EQ(std::count(drawn.begin(), drawn.end(), "vlp-16"), 10);  // five draws, two estimators
  EXPECT_EQ(sweep.cells.size(), 60U);
  EXPECT_THAT(page, HasSubstr("It makes 60 cells"));
}

TEST(ShippedSweeps, AreReadNameShippedScenariosAndKeepToTheirSize) {
  const fs::path scenarios = TARMAC_SCENARIOS;
  const std::vector<fs::path> files = list_beside_scenarios("sweeps", {scenarios});
  EXPECT_GE(files.size(), 2U);
  for (const fs::path& file : files) {
    const SweepFile sweep = load_sweep(file);
    EXPECT_EQ(sweep.name, file.stem().string());
    EXPECT_GT(sweep.why.size(), 40U) << file;
    std::map<std::string, std::set<std::uint64_t>> seeds;
    for (const SweepCell& cell : sweep.cells) {
      const Scenario scenario = load_scenario(find_scenario(cell.scenario, {scenarios}), cell.sets);
      seeds[cell.scenario].insert(cell.seed);
      if (sweep.name != "regression") continue;
      // What keeps it below ten minutes on two cores.
      const bool sixteen_beams = scenario.rig.child("lidar").child("model").scalar("model") == "vlp-16";
      EXPECT_LE(scenario.duration_s, sixteen_beams ? 6 : 15) << cell.case_name;
      EXPECT_LE(seeds[cell.scenario].size(), sixteen_beams ? 10U : 3U) << cell.case_name;
    }
    if (sweep.name == "every-scenario") {
      EXPECT_EQ(seeds.size(), list_scenarios({scenarios}).size()) << "a scenario is missing from " << file;
    } else {
      EXPECT_LE(seeds.size(), 6U) << file;
    }
  }
}

}  // namespace
}  // namespace tarmac::scenarios
