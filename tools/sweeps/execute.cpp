#include "tools/sweeps/execute.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "core/files.h"
#include "metrics/statistics.h"
#include "tools/sweeps/cell_run.h"
#include "tools/sweeps/cost.h"
#include "tools/sweeps/schedule.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What the bar shows of a method while it runs.
constexpr const char* kShownMetric = "rpe_1sweep_trans_rmse_m";

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// The bar's words: how far, and the figures so far.
class Status {
 public:
  Status(double total_cost, std::size_t total_cells, const Console& console)
      : total_cost_(total_cost), total_cells_(total_cells), console_(console), bar_(console.progress("sweep")) {}

  void cell_done(const PlannedCell& cell, const FinishedCell& finished, double cost, const std::string& log) {
    const std::lock_guard lock(mutex_);
    ++done_;
    cost_ += cost;
    if (finished.outcome.failed()) {
      ++failed_;
      console_.warn(fmt::format("{}, {}, seed {}: {}: {}{}", cell.cell.case_name, cell.cell.estimator, cell.cell.seed,
                                finished.outcome.status, finished.outcome.message,
                                log.empty() ? "" : fmt::format(" (log: {})", log)));
    }
    for (const scenarios::MetricValue& value : finished.metrics)
      if (value.metric == kShownMetric && value.value) figures_[cell.cell.estimator].push_back(*value.value);
    show();
  }
  void work_done(double cost) {
    const std::lock_guard lock(mutex_);
    cost_ += cost;
    show();
  }
  /// Cells that another process runs or has run.
  void cell_elsewhere(double cost) {
    const std::lock_guard lock(mutex_);
    ++elsewhere_;
    cost_ += cost;
    show();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    bar_(1.0, words());
  }

 private:
  void show() { bar_(std::min(0.999, total_cost_ > 0 ? cost_ / total_cost_ : 0), words()); }
  std::string words() const {
    std::string text = fmt::format("{} of {} cells", done_, total_cells_);
    if (failed_ > 0) text += fmt::format(", {} failed", failed_);
    if (elsewhere_ > 0) text += fmt::format(", {} by others", elsewhere_);
    std::string separator = "; one-sweep error [mm] ";
    for (const auto& [estimator, values] : figures_) {
      text += fmt::format("{}{} {:.3g}", separator, estimator, 1000 * metrics::quantile(values, 0.5));
      separator = ", ";
    }
    return text;
  }

  std::mutex mutex_;
  double total_cost_, cost_ = 0;
  std::size_t total_cells_, done_ = 0, failed_ = 0, elsewhere_ = 0;
  std::map<std::string, std::vector<double>> figures_;
  const Console& console_;
  core::Progress bar_;
};

/// The programs that cells run in: a build that goes on meanwhile would mix two builds in one store.
class ProgramsOnDisk {
 public:
  explicit ProgramsOnDisk(const fs::path& estimator_program) {
    files_ = {program_folder() / "tarmac-cell",
              estimator_program.empty() ? program_folder() / "tarmac-estimate" : fs::absolute(estimator_program)};
    for (const fs::path& file : files_) times_.push_back(time_of(file));
  }
  void throw_if_changed() const {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      if (time_of(files_[i]) == times_[i]) continue;
      throw core::InputError(fmt::format(
          "{}: was built again while the sweep ran; finished cells are kept, but those of another build do not go into "
          "this store: start the sweep again in another folder",
          files_[i].string()));
    }
  }

 private:
  static fs::file_time_type time_of(const fs::path& file) {
    std::error_code missing;
    return fs::last_write_time(file, missing);
  }
  std::vector<fs::path> files_;
  std::vector<fs::file_time_type> times_;
};

/// What the slots share.
class Execution {
 public:
  Execution(const SweepPlan& plan, scenarios::Store& store, const ExecuteSettings& settings, const Console& console)
      : plan_(plan),
        store_(store),
        cache_(settings.cache, settings.cache_limit_gb),
        folders_{store.folder(), store.work_folder()},
        settings_{
            {plan.file.limits.wall_s, plan.file.limits.cpu_s, plan.file.limits.memory_mb, plan.file.limits.file_mb},
            plan.file.diagnostics,
            plan.file.keep,
            settings.estimator_program,
            settings.fast},
        recordings_(plan.worlds.size()),
        not_simulated_(plan.worlds.size()),
        schedule_(pending_cells(), costs_of_worlds()),
        status_(pending_cost_, pending_count_, console) {}

  ExecuteSummary run(int jobs) {
    const auto began = Clock::now();
    std::vector<std::thread> slots;
    for (int i = 0; i < jobs; ++i) slots.emplace_back([this] { work(); });
    for (std::thread& slot : slots) slot.join();
    cache_.trim();
    if (error_) std::rethrow_exception(error_);
    status_.end();
    summary_.wall_s = seconds_since(began);
    const auto mean = [](double sum, std::size_t n) { return n > 0 ? sum / static_cast<double>(n) : 0; };
    summary_.overhead_mean_s = mean(overhead_s_, overhead_cells_);
    summary_.overhead_recording_mean_s = mean(overhead_recording_s_, summary_.recordings_made);
    return summary_;
  }

 private:
  std::vector<std::vector<std::size_t>> pending_cells() {
    const std::vector<std::string> keys = store_.pending();
    const std::set<std::string> pending(keys.begin(), keys.end());
    std::vector<std::vector<std::size_t>> cells(plan_.worlds.size());
    for (std::size_t w = 0; w < cells.size(); ++w) {
      for (const std::size_t c : plan_.worlds[w].cells) {
        if (!pending.contains(plan_.cells[c].cell.key)) continue;
        if (cells[w].empty()) pending_cost_ += estimate_cost(plan_, plan_.cells[c]).simulate_s;
        cells[w].push_back(c);
        pending_cost_ += estimate_cost(plan_, plan_.cells[c]).run_s;
        ++pending_count_;
      }
    }
    return cells;
  }
  std::vector<double> costs_of_worlds() const {
    std::vector<double> costs;
    for (const PlannedWorld& world : plan_.worlds) costs.push_back(cost_of_world(plan_, world));
    return costs;
  }

  /// A slot: one task after the other until nothing is left. The first error stops all slots.
  void work() {
    try {
      while (const std::optional<SweepTask> task = schedule_.next()) {
        task->kind == SweepTask::Kind::simulate ? simulate(*task) : cell(*task);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      schedule_.stop();
    }
  }

  void simulate(const SweepTask& task) {
    const PlannedWorld& world = plan_.worlds[task.world];
    const double cost = estimate_cost(plan_, plan_.cells[world.cells.front()]).simulate_s;
    const auto began = Clock::now();
    double work_s = 0;
    try {
      // A recording is the drive's and the simulator's: another build, or --fast, may make other bytes.
      const std::string key = core::hash_hex(fmt::format("{}\n{}\n", world.key, simulator_build_));
      CachedRecording recording = cache_.obtain(key, [&](const fs::path& folder) {
        const SimulatedDrive drive = simulate_drive(world, folder, settings_, [](double, const std::string&) {});
        work_s = drive.work_s;
        return drive.recording_hash;
      });
      const std::lock_guard lock(mutex_);
      ++(recording.made ? summary_.recordings_made : summary_.recordings_found);
      if (recording.made) overhead_recording_s_ += seconds_since(began) - work_s;
      recordings_[task.world] = std::move(recording);
    } catch (const NotSimulated& error) {
      const std::lock_guard lock(mutex_);
      not_simulated_[task.world] = error;
    }
    status_.work_done(cost);
    schedule_.simulated(task.world);
  }

  void cell(const SweepTask& task) {
    const PlannedCell& planned = plan_.cells[task.cell];
    const std::string& key = planned.cell.key;
    const double cost = estimate_cost(plan_, planned).run_s;
    if (!store_.claim(key)) {
      status_.cell_elsewhere(cost);
    } else {
      try {
        const FinishedCell finished = run(task, planned);
        programs_.throw_if_changed();
        store_.finish(key, finished.outcome, finished.metrics);
        count(finished);
        const fs::path log = folders_.cell(planned.cell) / planned.cell.estimator / "log.txt";
        status_.cell_done(planned, finished, cost, fs::exists(log) ? log.string() : "");
      } catch (...) {
        release(key);
        throw;
      }
    }
    if (schedule_.finished(task)) world_done(task.world);
  }

  /// Gives the cell back; where not even that can be written, the next start finds this process gone and does it.
  void release(const std::string& key) noexcept {
    try {
      store_.release(key);
    } catch (const std::exception&) {
    }
  }

  FinishedCell run(const SweepTask& task, const PlannedCell& planned) {
    std::optional<CachedRecording> recording;
    {
      const std::lock_guard lock(mutex_);
      if (not_simulated_[task.world]) return cell_without_recording(planned, *not_simulated_[task.world]);
      recording = recordings_[task.world];
    }
    return run_cell(planned, plan_.worlds[task.world], *recording, folders_, settings_,
                    [](double, const std::string&) {});
  }

  void count(const FinishedCell& finished) {
    const std::lock_guard lock(mutex_);
    const scenarios::CellOutcome& outcome = finished.outcome;
    if (outcome.status == "killed") {
      ++summary_.killed;
    } else {
      ++(outcome.failed() ? summary_.failed : summary_.ok);
    }
    if (outcome.status != "ok") return;
    ++overhead_cells_;
    overhead_s_ += outcome.overhead_s;
    summary_.overhead_max_s = std::max(summary_.overhead_max_s, outcome.overhead_s);
  }

  void world_done(std::size_t world) {
    {
      const std::lock_guard lock(mutex_);
      recordings_[world].reset();
    }
    cache_.trim();
  }

  const SweepPlan& plan_;
  scenarios::Store& store_;
  RecordingCache cache_;
  const CellFolders folders_;
  const CellSettings settings_;
  const std::string simulator_build_ = build_identity({}, settings_.fast);
  const ProgramsOnDisk programs_{settings_.estimator_program};
  double pending_cost_ = 0;
  std::size_t pending_count_ = 0;

  std::mutex mutex_;
  std::vector<std::optional<CachedRecording>> recordings_;
  std::vector<std::optional<NotSimulated>> not_simulated_;
  std::exception_ptr error_;
  ExecuteSummary summary_;
  double overhead_s_ = 0, overhead_recording_s_ = 0;
  std::size_t overhead_cells_ = 0;

  SweepSchedule schedule_;
  Status status_;
};

}  // namespace

ExecuteSummary execute(const SweepPlan& plan, scenarios::Store& store, const ExecuteSettings& settings,
                       const Console& console) {
  Execution execution(plan, store, settings, console);
  return execution.run(settings.jobs);
}

}  // namespace tarmac::tools
