#include "sim/simulate.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <time.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/recording.h"
#include "sim/imu/imu.h"
#include "sim/raycast/tracer.h"
#include "sim/rig_options.h"
#include "sim/sweep_pipeline.h"
#include "sim/truth/ground_truth.h"
#include "sim/truth/write_truth.h"

namespace tarmac::sim {
namespace {

using namespace core;

double process_cpu_s() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class Stopwatch {
 public:
  double wall_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }
  double cpu_s() const { return process_cpu_s() - cpu_; }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = process_cpu_s();
};

std::string speed_note(const PipelineTotals& totals, double simulated_s, double wall_s) {
  return fmt::format("{:.1f} Mrays/s, {:.1f}x real time", 1e-6 * static_cast<double>(totals.rays) / wall_s,
                     simulated_s / wall_s);
}

std::int64_t sweeps_within(const lidar::FiringTable& firing, const SimulationInput& input) {
  const Time end = std::min(Time(input.duration), input.motion->end());
  const std::int64_t count = firing.sweeps_until(end);
  if (count < 1)
    throw InputError(fmt::format("{}: a duration of {} s holds no whole sweep (one takes {} s): make it longer",
                                 input.scenario_name, to_s(end), to_s(firing.sweep(0).end)));
  return count;
}

std::size_t write_imu(const RigOptions& options, const SimulationInput& input, RecordingWriter& recording) {
  const Time end = std::min(Time(input.duration), input.motion->end());
  const std::vector<ImuSample> samples =
      synthesize_imu(*input.motion, options.imu, options.gravity_m_s2, Time{}, end, input.seed, "imu0");
  const std::size_t chunk = std::max<std::size_t>(1, static_cast<std::size_t>(options.imu.rate_hz));  // a second each
  for (std::size_t i = 0; i < samples.size(); i += chunk)
    recording.write(0, std::span(samples).subspan(i, std::min(chunk, samples.size() - i)));
  return samples.size();
}

}  // namespace

void check(const SimulationInput& input) {
  sweeps_within(firing_table(read_rig(input.rig), input.seed), input);
}

SimulationSummary simulate(const SimulationInput& input, const SimulationSettings& settings,
                           const std::filesystem::path& recording_folder, const std::filesystem::path& truth_folder,
                           const Progress& progress) {
  const Stopwatch watch;
  const int threads = std::clamp(settings.threads, 1, tbb::info::default_concurrency());
  const RigOptions options = read_rig(input.rig);
  const Rig rig = data_sheet(options);

  const auto tracer =
      std::make_shared<const raycast::Tracer>(input.scene, raycast::TracerSettings{threads, settings.fast});
  const lidar::SweepSimulator simulator(options.lidar.profile, firing_table(options, input.seed),
                                        {.sensor = 0, .T_body_lidar = options.lidar.T_body_lidar}, options.lidar.noise,
                                        input.seed, tracer, input.scene, input.motion);
  const std::int64_t count = sweeps_within(simulator.firing(), input);

  RecordingWriter recording(recording_folder, rig);
  truth::write_truth(truth_folder, input.resolved_scenario, input.resolved_motion, *input.motion, rig, {});
  ChunkWriter labels(truth_folder / "lidar0_labels.chunks");
  const PipelineTotals totals =
      run_sweeps(simulator, *input.scene, count, threads, recording, labels, [&](const PipelineTotals& so_far) {
        const double share = static_cast<double>(so_far.sweeps) / static_cast<double>(count);
        progress(share, speed_note(so_far, share * to_s(input.duration), watch.wall_s()));
      });
  labels.finish();

  SimulationSummary summary;
  summary.imu_samples = options.has_imu ? write_imu(options, input, recording) : 0;
  summary.recording_hash = recording.finish();
  summary.sweeps = totals.sweeps;
  summary.rays = totals.rays;
  summary.points = totals.points;
  summary.trace_cpu_s = totals.trace_cpu_s;
  summary.isa = tracer->isa();
  summary.threads = threads;
  summary.wall_s = watch.wall_s();
  summary.cpu_s = watch.cpu_s();
  summary.real_time_factor = to_s(input.duration) / summary.wall_s;
  return summary;
}

std::string resolve_rig(const ConfigNode& rig) {
  return write_options(read_rig(rig), 2);
}

}  // namespace tarmac::sim
