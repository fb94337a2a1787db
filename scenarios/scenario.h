/// A scenario: a whole question in one file, with the reason why it is asked and what would be a surprise.
///
///   name: stand-turn
///   why: ...
///   surprise: ...
///   duration_s: 66
///   scene: {kind: stand, ...}
///   motion: {kind: drive, ...}
///   rig: {lidar: {...}, imu: {...}}
///   faults: {lidar: {clock_offset_ms: 5}}    # optional: what is wrong with the sensors
///   truth: {per_point: true}                 # optional: what is stored of every point beside its label
///   estimators:            # optional: options of bundled methods, and foreign programs
///     kiss-icp: {voxel_size_m: 1.0}
///     my-tool: {command: [prog, '{input}', '{output}'], frame: lidar, interpolation: se3, timeout_s: 600}
///
/// The blocks scene, motion, rig, faults and estimators are read by the modules that know them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/options.h"
#include "core/time.h"

namespace tarmac::scenarios {

/// What of the truth is stored that could be computed again.
struct TruthOptions {
  bool per_point = false;
  void visit(core::OptionVisitor& v);
};

struct Scenario {
  std::string name;
  std::string why;
  std::string surprise;
  std::int64_t seed = 1;  ///< used when the command line gives none
  double duration_s = 0;
  TruthOptions truth;
  core::ConfigNode node;  ///< the whole file, `--set` applied
  core::ConfigNode scene, motion, rig, faults, estimators;

  core::Duration duration() const { return core::duration_from_s(duration_s); }
};

/// Lower-case letters, digits and hyphens, as in stand-turn: how files of this folder are named.
bool is_kebab(const std::string& name);

/// One `--set key=value`.
using Override = std::pair<std::string, std::string>;
/// Splits "key=value"; throws InputError when there is no '='.
Override parse_override(const std::string& text);

/// Throws InputError (file, line, field, what was expected) for anything wrong at the top level.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<Override>& overrides);

/// A scenario by path, or by name when the file lies in a known scenarios folder. Throws InputError with did-you-mean.
std::filesystem::path find_scenario(const std::string& name_or_path, const std::vector<std::filesystem::path>& folders);
/// All scenario files of the folders, sorted by name.
std::vector<std::filesystem::path> list_scenarios(const std::vector<std::filesystem::path>& folders);

/// "7" or "1..5"; throws InputError otherwise.
std::vector<std::uint64_t> parse_seeds(const std::string& text);

}  // namespace tarmac::scenarios
