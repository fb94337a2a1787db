/// What to do next: drives are simulated once, their cells run as soon as the recording is there, and of what is ready
/// cells come before further drives, so that few recordings are in use at a time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

namespace tarmac::tools {

struct SweepTask {
  enum class Kind { simulate, cell } kind = Kind::simulate;
  std::size_t world = 0;  ///< position in the plan
  std::size_t cell = 0;   ///< position in the plan; of kind cell
};

/// Thread-safe.
class SweepSchedule {
 public:
  /// `cells` of each world that are to be run, worlds without any left out by empty lists; worlds start in order of
  /// falling `cost`, ties in the plan's order.
  SweepSchedule(std::vector<std::vector<std::size_t>> cells, const std::vector<double>& cost);

  /// Waits while all that is left depends on drives being simulated by others; empty: nothing is left, or stopped.
  std::optional<SweepTask> next();
  /// The drive's recording is there (or it never will be: its cells are handed out all the same).
  void simulated(std::size_t world);
  /// Returns true when it was the world's last cell.
  bool finished(const SweepTask& cell);
  /// next() gives nothing more.
  void stop();

 private:
  struct World {
    enum class State { waiting, simulating, ready } state = State::waiting;
    std::vector<std::size_t> to_start;  ///< cells not handed out yet, last first
    std::size_t unfinished = 0;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<World> worlds_;
  std::vector<std::size_t> order_;
  bool stopped_ = false;
};

}  // namespace tarmac::tools
