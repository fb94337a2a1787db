/// One cell from its recording to its metrics, and one drive's recording: each step a child process held to limits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "scenarios/cell.h"
#include "tools/sweeps/plan.h"
#include "tools/sweeps/recording_cache.h"

namespace tarmac::tools {

/// The disk is full (or a quota is): nothing that is running can be finished, and it is no method's fault.
class NoRoom : public core::InputError {
 public:
  using core::InputError::InputError;
};

/// A drive that could not be simulated; `status` is what its cells get: not_simulated or killed.
class NotSimulated : public std::runtime_error {
 public:
  NotSimulated(std::string status_of_cells, const std::string& why)
      : std::runtime_error(why), status(std::move(status_of_cells)) {}
  std::string status;
};

struct CellFolders {
  std::filesystem::path store;  ///< DIR
  std::filesystem::path work;   ///< this process's, below DIR/work
  std::filesystem::path cell(const scenarios::Cell& c) const { return store / "cells" / c.key; }
};

struct CellSettings {
  ChildLimits
      limits;  ///< of the estimator; simulating and scoring get ten times its wall time and four times its memory
  std::string diagnostics, keep;
  std::filesystem::path estimator_program;
  bool fast = false;
};

struct SimulatedDrive {
  std::string recording_hash;
  double work_s = 0;  ///< of the simulation itself
};
/// True: what went wrong went wrong for want of room, by the room that is left in `folder` or by the words of a program
/// of ours (a method's own words are not believed).
bool lacks_room(const std::filesystem::path& folder, const std::string& words_of_ours);

/// Simulates a drive into `folder`. Throws NotSimulated, NoRoom, Interrupted.
SimulatedDrive simulate_drive(const PlannedWorld& world, const std::filesystem::path& folder,
                              const CellSettings& settings, const core::Progress& progress);

struct FinishedCell {
  scenarios::CellOutcome outcome;
  std::vector<scenarios::MetricValue> metrics;
};

/// Runs the estimator, scores it, and puts the cell's files in place. A failure of the method is an outcome. What is
/// thrown (NoRoom, Interrupted, whatever a full or broken disk makes of writing) leaves nothing behind.
FinishedCell run_cell(const PlannedCell& cell, const PlannedWorld& world, const CachedRecording& recording,
                      const CellFolders& folders, const CellSettings& settings, const core::Progress& progress);

/// The cell of a drive that could not be simulated.
FinishedCell cell_without_recording(const PlannedCell& cell, const NotSimulated& why);

}  // namespace tarmac::tools
