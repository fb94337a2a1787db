/// One block of a sweep file as it is read, before its cells are made.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenarios/scenario.h"
#include "scenarios/sweep_axes.h"

namespace tarmac::scenarios {

/// A line of `exclude`: what a cell must have, all of it.
struct SweepExclusion {
  struct Condition {
    std::string key;                  ///< a path, or scenario, estimator, seed
    std::vector<std::string> values;  ///< any of them
    std::optional<AxisRange> range;
  };
  core::ConfigNode node;
  std::vector<Condition> conditions;
  bool used = false;
};

struct SweepBlock {
  core::ConfigNode node;
  std::string place;  ///< "file:line: blocks.N"
  std::string name;   ///< empty: cells are labelled by their scenario
  std::vector<std::string> scenarios;
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> estimators;
  std::vector<Override> sets;  ///< the file's and the block's
  std::vector<Axis> grid, drawn_axes;
  DrawOptions draw;
  std::vector<SweepExclusion> exclusions;
};

/// Reads `blocks.<index>` of the file; seeds, estimators and `set` of the file's top hold where the block has none
/// (`set`: before the block's). Throws InputError.
SweepBlock read_sweep_block(const core::ConfigNode& file, std::size_t index, const core::ConfigNode& node);

/// Options of an estimator that nobody runs are a mistyped name: throws InputError. `who` begins the message.
void refuse_options_of_others(const core::ConfigNode& sets, const std::vector<std::string>& estimators,
                              const char* who);

/// A key whose value was forgotten would silently count as absent: throws InputError.
void refuse_keys_without_value(const core::ConfigNode& node);

/// "quick-brake" of "drives/quick-brake.yaml".
std::string short_scenario_name(const std::string& scenario);

}  // namespace tarmac::scenarios
