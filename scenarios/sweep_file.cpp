#include "scenarios/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/sweep_block.h"

namespace tarmac::scenarios {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr double kMaxCells = 1'000'000;

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

bool holds(const SweepExclusion::Condition& condition, const std::string& value) {
  if (condition.range) {
    const std::optional<double> number = number_of(value);
    return number && *number >= condition.range->from && *number <= condition.range->to;
  }
  return std::any_of(condition.values.begin(), condition.values.end(),
                     [&](const std::string& v) { return same_value(v, value); });
}

bool matches(const SweepExclusion& exclusion, const SweepCell& cell) {
  return std::all_of(exclusion.conditions.begin(), exclusion.conditions.end(), [&](const SweepExclusion::Condition& c) {
    if (c.key == "scenario") return holds(c, cell.scenario) || holds(c, short_scenario_name(cell.scenario));
    if (c.key == "estimator") return holds(c, cell.estimator);
    if (c.key == "seed") return holds(c, fmt::format("{}", cell.seed));
    return std::any_of(cell.parameters.begin(), cell.parameters.end(),
                       [&](const Override& p) { return p.first == c.key && holds(c, p.second); });
  });
}

/// All combinations of the grid, the last key fastest; each with all draws.
std::vector<std::vector<Override>> combinations(const SweepBlock& block, const std::string& draws_name) {
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

std::string label_of(const SweepBlock& block, const std::string& scenario) {
  if (block.name.empty()) return short_scenario_name(scenario);
  return block.name;
}

std::string case_name_of(const SweepBlock& block, const std::string& scenario,
                         const std::vector<Override>& parameters) {
  std::string name = label_of(block, scenario);
  if (!block.name.empty() && block.scenarios.size() > 1) name += " scenario=" + short_scenario_name(scenario);
  for (const auto& [path, value] : parameters) name += fmt::format(" {}={}", path, value);
  return name;
}

double number_of_cells(const SweepBlock& block) {
  double n = static_cast<double>(block.scenarios.size() * block.seeds.size() * block.estimators.size());
  for (const Axis& axis : block.grid) n *= static_cast<double>(axis.values.size());
  if (!block.drawn_axes.empty()) n *= block.draw.count;
  return n;
}

bool excluded(const SweepCell& cell, std::vector<SweepExclusion>& exclusions) {
  bool out = false;
  for (SweepExclusion& exclusion : exclusions) {
    if (matches(exclusion, cell)) exclusion.used = out = true;
  }
  return out;
}

/// The cells of one scenario and one combination: all seeds, and the estimators for which the combination is new.
void append_cells(SweepBlock& block, const SweepCell& common, const std::vector<Override>& combination,
                  std::set<std::pair<std::string, std::string>>& seen, const std::vector<Override>& last_sets,
                  std::vector<SweepCell>& cells) {
  std::vector<SweepCell> of_one_seed;
  for (const std::string& estimator : block.estimators) {
    SweepCell cell = common;
    cell.estimator = estimator;
    cell.parameters = concerning(combination, estimator);
    cell.case_name = case_name_of(block, cell.scenario, cell.parameters);
    if (!seen.emplace(cell.case_name, estimator).second) continue;
    cell.sets = concerning(block.sets, estimator);
    cell.sets.insert(cell.sets.end(), cell.parameters.begin(), cell.parameters.end());
    for (Override& set : concerning(last_sets, estimator)) cell.sets.push_back(std::move(set));
    of_one_seed.push_back(std::move(cell));
  }
  for (const std::uint64_t seed : block.seeds) {
    for (SweepCell& cell : of_one_seed) {
      cell.seed = seed;
      if (!excluded(cell, block.exclusions)) cells.push_back(cell);
    }
  }
}

void append_cells(SweepBlock& block, const std::vector<Override>& last_sets, std::vector<SweepCell>& cells) {
  const std::size_t before = cells.size();
  for (const std::string& scenario : block.scenarios) {
    SweepCell common;
    common.block = label_of(block, scenario);
    common.scenario = scenario;
    common.place = block.place;
    std::set<std::pair<std::string, std::string>> seen;  // case and estimator
    for (const std::vector<Override>& combination : combinations(block, common.block)) {
      append_cells(block, common, combination, seen, last_sets, cells);
    }
  }
  for (const SweepExclusion& exclusion : block.exclusions) {
    if (!exclusion.used) exclusion.node.fail("excludes nothing: no cell of this block matches all of it");
  }
  if (cells.size() == before) block.node.child("exclude").fail("nothing is left of the block: every cell is excluded");
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

void refuse_equal_labels(const std::vector<SweepBlock>& blocks) {
  std::map<std::string, const SweepBlock*> seen;
  for (const SweepBlock& block : blocks) {
    std::set<std::string> labels;
    for (const std::string& scenario : block.scenarios) labels.insert(label_of(block, scenario));
    for (const std::string& label : labels) {
      const auto [there, is_new] = seen.emplace(label, &block);
      if (is_new) continue;
      block.node.fail_at("name", fmt::format("another block is called {} ({}); give each a name of its own", label,
                                             there->second->place));
    }
  }
}

/// What the command line sets holds for all blocks; it may not undo what a block varies.
void check_last_sets(const std::vector<Override>& sets, const std::vector<SweepBlock>& blocks) {
  for (const auto& [path, value] : sets) {
    const std::string where = fmt::format("--set {}={}", path, value);
    bool runs = estimator_of(path).empty();
    for (const SweepBlock& block : blocks) {
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
  v("file_mb", file_mb, "size of each file that an estimator's process writes", {.above = 0});
}

SweepFile load_sweep(const fs::path& file, const std::vector<Override>& sets) {
  SweepFile sweep;
  sweep.text = core::read_file(file.string());
  const ConfigNode node = ConfigNode::parse(sweep.text, file.string());
  if (!node.is_block()) node.fail("a sweep is a block of `key: value` lines");
  refuse_keys_without_value(node);
  TopLevel top{sweep};
  node.read(top, {"seeds", "estimators", "set", "blocks"});
  if (!is_kebab(sweep.name)) {
    node.fail_at("name", fmt::format("'{}' must be a name in kebab-case, such as regression", sweep.name));
  }
  const std::vector<ConfigNode> items = node.child("blocks").items();
  if (items.empty()) node.fail_at("blocks", "is missing; expected a list of blocks, each with a scenario");
  std::vector<SweepBlock> blocks;
  double cells = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    blocks.push_back(read_sweep_block(node, i, items[i]));
    cells += number_of_cells(blocks.back());
    if (cells > kMaxCells) {
      items[i].fail(
          fmt::format("with this block the sweep has {:.0f} cells; at most {:.0f} are possible", cells, kMaxCells));
    }
  }
  std::vector<std::string> run;
  for (const SweepBlock& block : blocks) run.insert(run.end(), block.estimators.begin(), block.estimators.end());
  refuse_options_of_others(node.child("set"), run, "this sweep");
  refuse_equal_labels(blocks);
  check_last_sets(sets, blocks);
  for (SweepBlock& block : blocks) append_cells(block, sets, sweep.cells);
  refuse_equal_cells(sweep.cells);
  return sweep;
}

}  // namespace tarmac::scenarios
