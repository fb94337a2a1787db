#include "scenarios/sweep_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

namespace tarmac::scenarios {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr std::uint64_t kMaxSeeds = 10'000;

/// A single value, or a list of them that is not empty.
std::vector<ConfigNode> one_or_several(const ConfigNode& node) {
  if (!node.is_list()) return {node};
  std::vector<ConfigNode> items = node.items();
  if (items.empty()) node.fail("the list is empty; give at least one");
  return items;
}

std::vector<std::string> read_names(const ConfigNode& node, const char* what) {
  std::vector<std::string> names;
  for (const ConfigNode& item : one_or_several(node)) {
    const std::string name = item.scalar(what);
    if (name.empty()) item.fail(fmt::format("is empty; expected the name of a {}", what));
    if (std::find(names.begin(), names.end(), name) != names.end()) item.fail(fmt::format("{} stands twice", name));
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> read_estimators(const ConfigNode& node) {
  std::vector<std::string> names = read_names(node, "estimator");
  for (const std::string& name : names) {
    if (name == "all") node.fail("name the estimators one by one: what `all` means changes with the build");
    if (name.find_first_of(". /\\") != std::string::npos) {
      node.fail(fmt::format("'{}' is no name of an estimator, such as kiss-icp", name));
    }
  }
  return names;
}

std::uint64_t read_seed(const ConfigNode& node, const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    node.fail(fmt::format("'{}' is no seed; expected a whole number such as 7, a range such as 1..5, or a list of them",
                          text));
  }
  return seed;
}

std::vector<std::uint64_t> read_seeds(const ConfigNode& node) {
  std::vector<std::uint64_t> seeds;
  std::set<std::uint64_t> seen;
  for (const ConfigNode& item : one_or_several(node)) {
    const std::string text = item.scalar("seeds");
    const std::size_t dots = text.find("..");
    const std::uint64_t first = read_seed(item, text.substr(0, dots));
    const std::uint64_t last = dots == std::string::npos ? first : read_seed(item, text.substr(dots + 2));
    if (last < first || last - first >= kMaxSeeds) {
      item.fail(fmt::format("{}: a range must ascend and hold at most {} seeds", text, kMaxSeeds));
    }
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      if (!seen.insert(seed).second) item.fail(fmt::format("seed {} stands twice", seed));
      seeds.push_back(seed);
    }
  }
  return seeds;
}

std::vector<Override> read_sets(const ConfigNode& node) {
  std::vector<Override> sets;
  for (const std::string& path : node.keys()) {
    check_path(path, node.child(path));
    for (const Override& before : sets) {
      if (!before.first.starts_with(path + ".")) continue;
      node.child(path).fail(fmt::format("overwrites {}, which stands above it; put it first", before.first));
    }
    sets.emplace_back(path, one_line_yaml(node.child(path)));
  }
  return sets;
}

/// A name stays; a path is taken from the sweep file's folder.
std::string resolve_scenario_path(const ConfigNode& node, const std::string& scenario) {
  if (scenario.find('/') == std::string::npos && !scenario.ends_with(".yaml")) return scenario;
  const fs::path file = (fs::path(node.file()).parent_path() / scenario).lexically_normal();
  if (!fs::is_regular_file(file)) {
    node.fail(
        fmt::format("{}: there is no such scenario file ({} from here); a path is taken from the sweep file's "
                    "folder, a name is looked up",
                    scenario, file.string()));
  }
  return file.string();
}

SweepExclusion::Condition read_condition(const ConfigNode& line, const std::string& key,
                                         const std::vector<std::string>& known) {
  const ConfigNode value = line.child(key);
  if (std::find(known.begin(), known.end(), key) == known.end()) {
    const std::string guess = core::did_you_mean(key, known);
    value.fail(fmt::format("this block varies no such thing{}; known are {}",
                           guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess), fmt::join(known, ", ")));
  }
  SweepExclusion::Condition condition{key, {}, std::nullopt};
  if (value.is_block() && value.child("from").present() && value.child("to").present()) {
    AxisRange range;
    value.read_into([&](core::OptionVisitor& v) {
      v("from", range.from, "first value");
      v("to", range.to, "last value");
    });
    if (range.from > range.to) value.fail_at("to", fmt::format("{} lies below from, {}", range.to, range.from));
    condition.range = range;
    return condition;
  }
  condition.values.push_back(one_line_yaml(value));
  if (value.is_list()) {
    for (const ConfigNode& item : value.items()) condition.values.push_back(one_line_yaml(item));
  }
  return condition;
}

std::vector<SweepExclusion> read_exclusions(const SweepBlock& block) {
  std::vector<std::string> known;
  for (const auto* axes : {&block.grid, &block.drawn_axes})
    for (const Axis& axis : *axes) known.push_back(axis.path);
  known.insert(known.end(), {"scenario", "estimator", "seed"});
  std::vector<SweepExclusion> exclusions;
  for (const ConfigNode& line : block.node.child("exclude").items()) {
    if (!line.is_block()) line.fail("must be a block of `key: value`, such as {motion.cruise_m_s: 4, seed: 3}");
    SweepExclusion exclusion;
    exclusion.node = line;
    for (const std::string& key : line.keys()) exclusion.conditions.push_back(read_condition(line, key, known));
    if (exclusion.conditions.empty()) line.fail("is empty; it would exclude every cell");
    exclusions.push_back(std::move(exclusion));
  }
  return exclusions;
}

void read_draw(SweepBlock& block) {
  const ConfigNode draw = block.node.child("draw");
  if (!draw.present()) return;
  refuse_keys_without_value(draw);
  draw.read(block.draw, {"over"});
  if (!draw.child("count").present()) draw.fail_at("count", "is missing; expected the number of draws");
  const ConfigNode over = draw.child("over");
  if (!over.present() || over.keys().empty()) {
    draw.fail_at("over", "is missing; expected what is drawn, such as {motion.cruise_m_s: {from: 2, to: 8}}");
  }
  block.drawn_axes = read_draw_axes(over);
  if (block.name.empty() && block.scenarios.size() > 1) {
    block.node.fail_at("name",
                       "is missing; a block that draws for several scenarios needs a name of its own, since "
                       "the draws depend on it");
  }
}

/// A parameter inside of another, or twice, would overwrite what the case's name says.
void refuse_clashes(const SweepBlock& block) {
  const ConfigNode over = block.node.child("draw").child("over"), set = block.node.child("set");
  for (const Axis& drawn : block.drawn_axes) {
    for (const Axis& varied : block.grid) {
      if (drawn.path == varied.path) over.child(drawn.path).fail("stands in `vary` as well; it can be in one only");
      if (drawn.path.starts_with(varied.path + ".") || varied.path.starts_with(drawn.path + ".")) {
        over.child(drawn.path).fail(fmt::format("and {} in `vary` overlap; one lies inside of the other", varied.path));
      }
    }
  }
  for (const std::string& path : set.keys()) {
    for (const auto* axes : {&block.grid, &block.drawn_axes}) {
      for (const Axis& axis : *axes) {
        if (axis.path != path && !path.starts_with(axis.path + ".")) continue;
        set.child(path).fail(fmt::format("is overwritten by {}, which has several values in this block", axis.path));
      }
    }
  }
}

}  // namespace

void refuse_keys_without_value(const ConfigNode& node) {
  for (const std::string& key : node.keys()) {
    if (!node.child(key).present()) node.child(key).fail("has no value; give one, or leave the key out");
  }
}

void refuse_options_of_others(const ConfigNode& node, const std::vector<std::string>& run, const char* who) {
  for (const std::string& path : node.keys()) {
    const std::string estimator = estimator_of(path);
    if (estimator.empty() || std::find(run.begin(), run.end(), estimator) != run.end()) continue;
    const std::string guess = core::did_you_mean(estimator, run);
    node.child(path).fail(fmt::format("{} does not run {}{}; it runs {}", who, estimator,
                                      guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                      fmt::join(run, ", ")));
  }
}

SweepBlock read_sweep_block(const ConfigNode& file, std::size_t index, const ConfigNode& node) {
  if (!node.is_block()) node.fail("must be a block of `key: value` lines with a scenario");
  node.allow_only({"name", "scenario", "seeds", "estimators", "set", "vary", "draw", "exclude"});
  refuse_keys_without_value(node);
  SweepBlock block;
  block.node = node;
  block.place = fmt::format("{}:{}: blocks.{}", node.file(), node.line(), index);
  block.name = node.child("name").scalar_or("");
  if (node.child("name").present() && !is_kebab(block.name)) {
    node.fail_at("name", fmt::format("'{}' must be a name in kebab-case, such as brake", block.name));
  }
  if (!node.child("scenario").present()) node.fail_at("scenario", "is missing; expected a name, a path, or a list");
  for (const std::string& scenario : read_names(node.child("scenario"), "scenario")) {
    for (const std::string& before : block.scenarios) {
      if (short_scenario_name(before) != short_scenario_name(scenario)) continue;
      node.fail_at("scenario", fmt::format("two scenarios are called {}; put them into blocks of their own, with names",
                                           short_scenario_name(scenario)));
    }
    block.scenarios.push_back(resolve_scenario_path(node.child("scenario"), scenario));
  }
  const auto own_or_files = [&](const char* key) {
    const ConfigNode value = node.child(key).present() ? node.child(key) : file.child(key);
    if (!value.present()) node.fail_at(key, "is missing here and at the file's top");
    return value;
  };
  block.seeds = read_seeds(own_or_files("seeds"));
  block.estimators = read_estimators(own_or_files("estimators"));
  block.sets = read_sets(file.child("set"));
  for (Override& set : read_sets(node.child("set"))) block.sets.push_back(std::move(set));
  block.grid = read_grid(node.child("vary"));
  read_draw(block);
  refuse_clashes(block);
  for (const ConfigNode& parameters : {node.child("set"), node.child("vary"), node.child("draw").child("over")}) {
    refuse_options_of_others(parameters, block.estimators, "this block");
  }
  block.exclusions = read_exclusions(block);
  return block;
}

std::string short_scenario_name(const std::string& scenario) {
  return fs::path(scenario).stem().string();
}

}  // namespace tarmac::scenarios
