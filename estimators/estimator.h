/// Turns sensor data into motion. An estimator sees core/ and its own folder: nothing of the truth can reach it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/diagnostics.h"
#include "core/estimate.h"
#include "core/measurements.h"
#include "core/recording.h"
#include "core/rig.h"

namespace tarmac::estimators {

/// The stages of `stages_ms` that serve the diagnostics alone: writing them, and looking for surfaces to write.
inline constexpr const char* kRecordStage = "record";
inline constexpr const char* kSurfacesStage = "surfaces";

/// What an estimator says of one sweep.
struct SweepOutcome {
  core::SweepResult result;
  std::vector<core::Segment> motion;  ///< T_map_body(t) over the sweep: what the method placed its points by
  core::SweepDiagnostics diagnostics;
  std::vector<std::pair<std::string, double>> stages_ms;
  std::string note;  ///< what was unusual about the sweep, for the log; empty: nothing
};

/// What a method that is not ready yet says of a sweep.
inline SweepOutcome initialising_outcome(const core::LidarSweep& sweep) {
  SweepOutcome outcome;
  outcome.diagnostics.index = sweep.index;
  outcome.diagnostics.points_in = static_cast<std::int32_t>(sweep.size());
  outcome.result = {.index = sweep.index,
                    .begin = sweep.begin,
                    .end = sweep.end,
                    .reference = sweep.end,
                    .status = core::SweepStatus::initialising};
  return outcome;
}

/// Complete once constructed; two instances never influence each other. Sweeps come in order, checked: finite points,
/// strictly later than the one before. An empty sweep comes as an empty sweep.
class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual void add(const core::ImuSample& sample) { (void)sample; }  ///< in time order
  virtual SweepOutcome add(const core::LidarSweep& sweep) = 0;
  /// Called once after the last event: sets the final trajectory, run status and message where the method has them.
  virtual void finish(core::Estimate& estimate) { (void)estimate; }
};

struct EstimatorContext {
  core::Rig rig;
  int threads = 1;
  core::DiagnosticsLevel diagnostics = core::DiagnosticsLevel::system;
};

enum class Needs : std::uint8_t { lidar = 1, imu = 2, lidar_and_imu = 3 };

struct EstimatorEntry {
  const char* name;  ///< kebab-case
  const char* summary;
  const char* source;  ///< the publication
  Needs needs;
  std::unique_ptr<Estimator> (*make)(const core::ConfigNode& options, const EstimatorContext& context);
  std::vector<core::OptionDescription> (*describe)();
  std::string (*resolve)(const core::ConfigNode& options);  ///< every option written out, indented by 4
  /// Of a rig with several LiDARs: false, their sweeps come merged, in the body's frame (core/merged_sweeps.h), and
  /// EstimatorContext::rig has one LiDAR there; true, they come as recorded, each LiDAR's own, in order of their ends, and
  /// what add() returns of the first LiDAR's counts.
  bool raw_lidars = false;
};

/// make/describe/resolve of an estimator class with a constructor (Options, EstimatorContext).
template <class E, class Options>
std::unique_ptr<Estimator> make_with(const core::ConfigNode& node, const EstimatorContext& context) {
  Options options;
  node.read(options);
  return std::make_unique<E>(options, context);
}
template <class Options>
std::vector<core::OptionDescription> describe_with() {
  return core::describe_options<Options>();
}
template <class Options>
std::string resolve_with(const core::ConfigNode& node) {
  Options options;
  node.read(options);
  return core::write_options(options, 4);
}

}  // namespace tarmac::estimators
