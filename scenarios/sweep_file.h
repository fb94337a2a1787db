/// A sweep: many cells in one file.
///
///   name: clocks
///   why: ...
///   seeds: 1..3                        # or [1, 5..9]; a block may have its own
///   estimators: [kiss-icp, ct-icp]     # likewise
///   diagnostics: system                # none | system | full
///   keep: estimates                    # scores | estimates | everything: what of a cell's files stays
///   limits: {wall_s: 600, cpu_s: 600, memory_mb: 4096}     # of each estimator's process
///   set: {rig.lidar.columns: 512}      # for all blocks
///   blocks:
///     - name: brake                    # label of its cases; without it, the scenario's name
///       scenario: quick-brake          # a name or a path (from the sweep file's folder), or a list of them
///       set: {duration_s: 5}
///       vary:                          # every combination, the last key fastest
///         rig.lidar.sweep_rate_hz: [10, 20]
///         faults.lidar.clock_offset_ms: {from: -5, to: 5, steps: 3}
///         estimators.kiss-icp.voxel_size_m: {from: 0.25, to: 2, steps: 4, scale: log}
///       draw:                          # and each of these combinations with `count` draws
///         count: 20
///         method: latin-hypercube      # or random
///         seed: 7
///         over:
///           motion.start.speed_m_s: {from: 2, to: 8}           # also scale: log, integer: true
///           rig.lidar.model: [vlp-16, hdl-32e]
///       exclude:                       # cells that match all of a line; also by scenario, estimator, seed
///         - {rig.lidar.sweep_rate_hz: 20, rig.lidar.model: hdl-32e}
///         - {motion.start.speed_m_s: {from: 6, to: 8}, seed: [2, 3]}
///
/// docs/sweeps.md says it in full.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace tarmac::scenarios {

struct SweepLimits {
  double wall_s = 600, cpu_s = 600, memory_mb = 4096, file_mb = 16384;
  void visit(core::OptionVisitor& v);
};

/// A cell before its scenario is read: which scenario, what is set in it, and which estimator.
struct SweepCell {
  std::string block;
  std::string scenario;  ///< as the file names it; a path is resolved against the sweep file's folder
  /// Block's name (of several scenarios: then " scenario=..."), then " key=value" for each parameter that concerns this
  /// cell. Together with seed and estimator it names the cell.
  std::string case_name;
  std::uint64_t seed = 0;
  std::string estimator;
  /// `set` of the file, of the block, the parameters, --set; without those of other estimators.
  std::vector<Override> sets;
  std::vector<Override> parameters;  ///< varied and drawn ones that concern this cell
  std::string place;                 ///< "sweeps/regression.yaml:12: blocks.0" for errors that show later
};

struct SweepFile {
  std::string name, why;
  std::string diagnostics = "system";
  std::string keep = "estimates";
  SweepLimits limits;
  /// In order of block, scenario, combination, draw, seed, estimator. `estimators.<name>.*` parameters concern the
  /// cells of that estimator alone: others do not repeat for them. Draws that come out the same are one cell.
  std::vector<SweepCell> cells;
  std::string text;  ///< of the file
};

/// Throws InputError (file, line, field, what was expected) for anything wrong; two cells that are the same are wrong.
/// `sets` are the command line's --set: they hold last, over the file's.
SweepFile load_sweep(const std::filesystem::path& file, const std::vector<Override>& sets = {});

/// A sweep (or gate) file by path, or by name in a folder `subfolder` ("sweeps", "gates") of the scenarios folders.
/// Throws InputError with did-you-mean.
std::filesystem::path find_beside_scenarios(const std::string& name_or_path, const std::string& subfolder,
                                            const std::vector<std::filesystem::path>& scenario_folders);
/// All such files, sorted by name.
std::vector<std::filesystem::path> list_beside_scenarios(const std::string& subfolder,
                                                         const std::vector<std::filesystem::path>& scenario_folders);

}  // namespace tarmac::scenarios
