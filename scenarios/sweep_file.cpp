#include "scenarios/sweep_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/sweep_axes.h"

namespace tarmac::scenarios {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr double kMaxCells = 1'000'000;
constexpr std::uint64_t kMaxSeeds = 10'000;

/// A line of `exclude`: what a cell must have, all of it.
struct Exclusion {
  struct Condition {
    std::string key;                  ///< a path, or scenario, estimator, seed
    std::vector<std::string> values;  ///< any of them
    std::optional<AxisRange> range;
  };
  ConfigNode node;
  std::vector<Condition> conditions;
  bool used = false;
};

/// One block as read, before its cells are made.
struct Block {
  ConfigNode node;
  std::string place;  ///< "file:line: blocks.N"
  std::string name;   ///< empty: cells are labelled by their scenario
  std::vector<std::string> scenarios;
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> estimators;
  std::vector<Override> sets;  ///< the file's and the block's
  std::vector<Axis> grid, drawn_axes;
  DrawOptions draw;
  std::vector<Exclusion> exclusions;
};

struct TopLevel {
  SweepFile& sweep;
  void visit(core::OptionVisitor& v) {
    v("name", sweep.name, "kebab-case name");
    v("why", sweep.why, "what the sweep is for");
    v.choice("diagnostics", sweep.diagnostics, {"none", "system", "full"}, "what estimators record per sweep");
    v.choice("keep", sweep.keep, {"scores", "estimates", "everything"}, "what of a cell's files stays");
    v.group("limits", sweep.limits, "of each estimator's process");
  }
};

bool is_kebab(const std::string& name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos &&
         name.front() != '-' && name.back() != '-';
}

std::string short_name(const std::string& scenario) {
  return fs::path(scenario).stem().string();
}

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

Exclusion::Condition read_condition(const ConfigNode& line, const std::string& key,
                                    const std::vector<std::string>& known) {
  const ConfigNode value = line.child(key);
  if (std::find(known.begin(), known.end(), key) == known.end()) {
    const std::string guess = core::did_you_mean(key, known);
    value.fail(fmt::format("this block varies no such thing{}; known are {}",
                           guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess), fmt::join(known, ", ")));
  }
  Exclusion::Condition condition{key, {}, std::nullopt};
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

std::vector<Exclusion> read_exclusions(const Block& block) {
  std::vector<std::string> known;
  for (const auto* axes : {&block.grid, &block.drawn_axes})
    for (const Axis& axis : *axes) known.push_back(axis.path);
  known.insert(known.end(), {"scenario", "estimator", "seed"});
  std::vector<Exclusion> exclusions;
  for (const ConfigNode& line : block.node.child("exclude").items()) {
    if (!line.is_block()) line.fail("must be a block of `key: value`, such as {motion.cruise_m_s: 4, seed: 3}");
    Exclusion exclusion;
    exclusion.node = line;
    for (const std::string& key : line.keys()) exclusion.conditions.push_back(read_condition(line, key, known));
    if (exclusion.conditions.empty()) line.fail("is empty; it would exclude every cell");
    exclusions.push_back(std::move(exclusion));
  }
  return exclusions;
}

void read_draw(Block& block) {
  const ConfigNode draw = block.node.child("draw");
  if (!draw.present()) return;
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
void refuse_clashes(const Block& block) {
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

/// Options of an estimator that the block does not run are a mistyped name.
void refuse_other_estimators(const ConfigNode& node, const std::vector<std::string>& run, const char* who) {
  for (const std::string& path : node.keys()) {
    const std::string estimator = estimator_of(path);
    if (estimator.empty() || std::find(run.begin(), run.end(), estimator) != run.end()) continue;
    const std::string guess = core::did_you_mean(estimator, run);
    node.child(path).fail(fmt::format("{} does not run {}{}; it runs {}", who, estimator,
                                      guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                      fmt::join(run, ", ")));
  }
}

Block read_block(const ConfigNode& file, const ConfigNode& node, std::size_t index) {
  if (!node.is_block()) node.fail("must be a block of `key: value` lines with a scenario");
  node.allow_only({"name", "scenario", "seeds", "estimators", "set", "vary", "draw", "exclude"});
  Block block;
  block.node = node;
  block.place = fmt::format("{}:{}: blocks.{}", node.file(), node.line(), index);
  block.name = node.child("name").scalar_or("");
  if (node.child("name").present() && !is_kebab(block.name)) {
    node.fail_at("name", fmt::format("'{}' must be a name in kebab-case, such as brake", block.name));
  }
  if (!node.child("scenario").present()) node.fail_at("scenario", "is missing; expected a name, a path, or a list");
  for (const std::string& scenario : read_names(node.child("scenario"), "scenario")) {
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
    refuse_other_estimators(parameters, block.estimators, "this block");
  }
  block.exclusions = read_exclusions(block);
  return block;
}

bool holds(const Exclusion::Condition& condition, const std::string& value) {
  if (condition.range) {
    const std::optional<double> number = number_of(value);
    return number && *number >= condition.range->from && *number <= condition.range->to;
  }
  return std::any_of(condition.values.begin(), condition.values.end(),
                     [&](const std::string& v) { return same_value(v, value); });
}

bool matches(const Exclusion& exclusion, const SweepCell& cell) {
  return std::all_of(exclusion.conditions.begin(), exclusion.conditions.end(), [&](const Exclusion::Condition& c) {
    if (c.key == "scenario") return holds(c, cell.scenario) || holds(c, short_name(cell.scenario));
    if (c.key == "estimator") return holds(c, cell.estimator);
    if (c.key == "seed") return holds(c, fmt::format("{}", cell.seed));
    return std::any_of(cell.parameters.begin(), cell.parameters.end(),
                       [&](const Override& p) { return p.first == c.key && holds(c, p.second); });
  });
}

/// All combinations of the grid, the last key fastest; each with all draws.
std::vector<std::vector<Override>> combinations(const Block& block, const std::string& draws_name) {
  std::vector<std::vector<Override>> all = {{}};
  for (const Axis& axis : block.grid) {
    std::vector<std::vector<Override>> longer;
    for (const auto& begin : all) {
      for (const std::string& value : axis.values) {
        longer.push_back(begin);
        longer.back().emplace_back(axis.path, value);
      }
    }
    all = std::move(longer);
  }
  if (block.drawn_axes.empty()) return all;
  std::vector<std::vector<std::string>> draws;
  for (const Axis& axis : block.drawn_axes) draws.push_back(draw_values(axis, block.draw, draws_name));
  std::vector<std::vector<Override>> with_draws;
  for (const auto& begin : all) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.draw.count); ++i) {
      with_draws.push_back(begin);
      for (std::size_t a = 0; a < draws.size(); ++a) {
        with_draws.back().emplace_back(block.drawn_axes[a].path, draws[a][i]);
      }
    }
  }
  return with_draws;
}

std::vector<Override> concerning(const std::vector<Override>& sets, const std::string& estimator) {
  std::vector<Override> out;
  for (const Override& set : sets) {
    const std::string whose = estimator_of(set.first);
    if (whose.empty() || whose == estimator) out.push_back(set);
  }
  return out;
}

std::string label_of(const Block& block, const std::string& scenario) {
  if (block.name.empty()) return short_name(scenario);
  return block.name;
}

std::string case_name_of(const Block& block, const std::string& scenario, const std::vector<Override>& parameters) {
  std::string name = label_of(block, scenario);
  if (!block.name.empty() && block.scenarios.size() > 1) name += " scenario=" + short_name(scenario);
  for (const auto& [path, value] : parameters) name += fmt::format(" {}={}", path, value);
  return name;
}

double number_of_cells(const Block& block) {
  double n = static_cast<double>(block.scenarios.size() * block.seeds.size() * block.estimators.size());
  for (const Axis& axis : block.grid) n *= static_cast<double>(axis.values.size());
  if (!block.drawn_axes.empty()) n *= block.draw.count;
  return n;
}

void append_cells(Block& block, const std::vector<Override>& last_sets, std::vector<SweepCell>& cells) {
  const std::size_t before = cells.size();
  std::size_t excluded = 0;
  for (const std::string& scenario : block.scenarios) {
    std::set<std::pair<std::string, std::string>> seen;  // case and estimator
    for (const std::vector<Override>& combination : combinations(block, label_of(block, scenario))) {
      std::vector<std::pair<std::string, std::vector<Override>>> per_estimator;
      for (const std::string& estimator : block.estimators) {
        std::vector<Override> parameters = concerning(combination, estimator);
        if (seen.emplace(case_name_of(block, scenario, parameters), estimator).second) {
          per_estimator.emplace_back(estimator, std::move(parameters));
        }
      }
      for (const std::uint64_t seed : block.seeds) {
        for (const auto& [estimator, parameters] : per_estimator) {
          SweepCell cell{label_of(block, scenario),
                         scenario,
                         case_name_of(block, scenario, parameters),
                         seed,
                         estimator,
                         {},
                         parameters,
                         block.place};
          bool out = false;
          for (Exclusion& exclusion : block.exclusions) {
            if (!matches(exclusion, cell)) continue;
            exclusion.used = out = true;
          }
          if (out) {
            ++excluded;
            continue;
          }
          cell.sets = concerning(block.sets, estimator);
          cell.sets.insert(cell.sets.end(), parameters.begin(), parameters.end());
          for (const Override& set : concerning(last_sets, estimator)) cell.sets.push_back(set);
          cells.push_back(std::move(cell));
        }
      }
    }
  }
  for (const Exclusion& exclusion : block.exclusions) {
    if (!exclusion.used) exclusion.node.fail("excludes nothing: no cell of this block matches all of it");
  }
  if (cells.size() == before) {
    block.node.child("exclude").fail(
        fmt::format("nothing is left of the block: all of its {} cells are excluded", excluded));
  }
}

/// What decides a cell's result, the same for two ways of writing it: settings that a later one overwrites go.
std::string content_of(const SweepCell& cell) {
  std::vector<Override> effective;
  for (auto set = cell.sets.rbegin(); set != cell.sets.rend(); ++set) {
    const bool overwritten = std::any_of(effective.begin(), effective.end(), [&](const Override& later) {
      return set->first == later.first || set->first.starts_with(later.first + ".");
    });
    if (!overwritten) effective.push_back(*set);
  }
  std::sort(effective.begin(), effective.end());
  std::string content = fmt::format("{}\n{}\n{}\n", cell.scenario, cell.seed, cell.estimator);
  for (const auto& [path, value] : effective) {
    const std::optional<double> number = number_of(value);
    content += fmt::format("{}={}\n", path, number ? number_text(*number) : value);
  }
  return content;
}

void refuse_equal_cells(const std::vector<SweepCell>& cells) {
  std::map<std::string, const SweepCell*> seen;
  for (const SweepCell& cell : cells) {
    const auto [there, is_new] = seen.emplace(content_of(cell), &cell);
    if (is_new) continue;
    throw core::InputError(fmt::format("{}: {} of seed {} in '{}' is the same as in '{}' ({}); remove one of them",
                                       cell.place, cell.estimator, cell.seed, cell.case_name, there->second->case_name,
                                       there->second->place));
  }
}

void refuse_equal_labels(const std::vector<Block>& blocks) {
  std::map<std::string, const Block*> seen;
  for (const Block& block : blocks) {
    std::set<std::string> labels;
    for (const std::string& scenario : block.scenarios) {
      if (!labels.insert(label_of(block, scenario)).second && block.name.empty()) {
        block.node.fail_at("scenario", fmt::format("two scenarios are called {}; put them into blocks with names",
                                                   short_name(scenario)));
      }
    }
    for (const std::string& label : labels) {
      const auto [there, is_new] = seen.emplace(label, &block);
      if (is_new) continue;
      block.node.fail_at("name", fmt::format("another block is called {} ({}); give each a name of its own", label,
                                             there->second->place));
    }
  }
}

/// What the command line sets holds for all blocks; it may not undo what a block varies.
void check_last_sets(const std::vector<Override>& sets, const std::vector<Block>& blocks) {
  for (const auto& [path, value] : sets) {
    const std::string where = fmt::format("--set {}={}", path, value);
    bool runs = estimator_of(path).empty();
    for (const Block& block : blocks) {
      const auto& names = block.estimators;
      runs = runs || std::find(names.begin(), names.end(), estimator_of(path)) != names.end();
      for (const auto* axes : {&block.grid, &block.drawn_axes}) {
        for (const Axis& axis : *axes) {
          if (axis.path != path && !axis.path.starts_with(path + ".") && !path.starts_with(axis.path + ".")) continue;
          throw core::InputError(fmt::format("{}: would undo {}, which {} varies", where, axis.path, block.place));
        }
      }
    }
    if (!runs) throw core::InputError(fmt::format("{}: no block runs {}", where, estimator_of(path)));
  }
}

}  // namespace

void SweepLimits::visit(core::OptionVisitor& v) {
  v("wall_s", wall_s, "wall time of an estimator's process", {.above = 0});
  v("cpu_s", cpu_s, "CPU time of an estimator's process", {.above = 0});
  v("memory_mb", memory_mb, "memory of an estimator's process", {.above = 0});
}

SweepFile load_sweep(const fs::path& file, const std::vector<Override>& sets) {
  SweepFile sweep;
  sweep.text = core::read_file(file.string());
  const ConfigNode node = ConfigNode::parse(sweep.text, file.string());
  if (!node.is_block()) node.fail("a sweep is a block of `key: value` lines");
  TopLevel top{sweep};
  node.read(top, {"seeds", "estimators", "set", "blocks"});
  if (!is_kebab(sweep.name)) {
    node.fail_at("name", fmt::format("'{}' must be a name in kebab-case, such as regression", sweep.name));
  }
  const std::vector<ConfigNode> items = node.child("blocks").items();
  if (items.empty()) node.fail_at("blocks", "is missing; expected a list of blocks, each with a scenario");
  std::vector<Block> blocks;
  double cells = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    blocks.push_back(read_block(node, items[i], i));
    cells += number_of_cells(blocks.back());
    if (cells > kMaxCells) {
      items[i].fail(
          fmt::format("with this block the sweep has {:.0f} cells; at most {:.0f} are possible", cells, kMaxCells));
    }
  }
  std::vector<std::string> run;
  for (const Block& block : blocks) run.insert(run.end(), block.estimators.begin(), block.estimators.end());
  refuse_other_estimators(node.child("set"), run, "this sweep");
  refuse_equal_labels(blocks);
  check_last_sets(sets, blocks);
  for (Block& block : blocks) append_cells(block, sets, sweep.cells);
  refuse_equal_cells(sweep.cells);
  return sweep;
}

}  // namespace tarmac::scenarios
