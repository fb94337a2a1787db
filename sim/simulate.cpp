#include "sim/simulate.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <time.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/files.h"
#include "core/recording.h"
#include "sim/collisions.h"
#include "sim/faults/fault_log.h"
#include "sim/faults/fault_options.h"
#include "sim/faults/imu_faults.h"
#include "sim/faults/lidar_faults.h"
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

/// Options of rig and faults, and the rig as it is: the data sheet's with every mounting where it truly is.
struct Setup {
  RigOptions rig;
  faults::FaultOptions faults;
  Rig sheet, truth;
  std::vector<truth::Fault> log;
};

Setup read_setup(const SimulationInput& input) {
  Setup setup;
  setup.rig = read_rig(input.rig);
  setup.faults = faults::read_faults(input.faults, setup.rig.has_imu, setup.rig.lidar.sweep_rate_hz);
  setup.sheet = setup.truth = data_sheet(setup.rig);
  SE3& T_body_lidar = setup.truth.lidars[0].T_body_lidar;
  T_body_lidar = T_body_lidar * setup.faults.lidar.extrinsic_error;
  if (setup.rig.has_imu) {
    SE3& T_body_imu = setup.truth.imus[0].T_body_imu;
    T_body_imu = T_body_imu * setup.faults.imu.extrinsic_error;
  }
  return setup;
}

faults::LidarFaults lidar_faults(const lidar::FiringTable& firing, std::int64_t count, std::uint64_t seed,
                                 Setup& setup) {
  std::vector<faults::SweepStamp> sweeps;
  std::vector<std::size_t> columns;
  for (std::int64_t k = 0; k < count; ++k) {
    const lidar::SweepSpan span = firing.sweep(k);
    sweeps.push_back({span.begin, span.end});
    columns.push_back(static_cast<std::size_t>(span.cycles));
  }
  faults::LidarFaults realised(setup.faults.lidar, sweeps, seed, "lidar0");
  setup.log = faults::lidar_log(setup.faults.lidar, realised, columns, "lidar0");
  return realised;
}

/// Samples as they are recorded, with the errors that the device had.
SynthesizedImu make_imu(Setup& setup, const SimulationInput& input) {
  if (!setup.rig.has_imu) return {};
  const Time end = std::min(Time(input.duration), input.motion->end());
  ImuOptions mounted = setup.rig.imu;
  mounted.T_body_imu = setup.truth.imus[0].T_body_imu;
  SynthesizedImu imu = synthesize_imu(*input.motion, mounted, setup.rig.gravity_m_s2, Time{}, end, input.seed, "imu0");
  const std::size_t lost = faults::apply_imu_faults(setup.faults.imu, input.seed, "imu0", imu.samples);
  for (truth::Fault& fault : faults::imu_log(setup.faults.imu, lost, imu.samples.size() + lost, "imu0"))
    setup.log.push_back(std::move(fault));
  return imu;
}

std::size_t write_imu(const RigOptions& options, const std::vector<ImuSample>& samples, RecordingWriter& recording) {
  const std::size_t chunk = std::max<std::size_t>(1, static_cast<std::size_t>(options.imu.rate_hz));  // a second each
  for (std::size_t i = 0; i < samples.size(); i += chunk)
    recording.write(0, std::span(samples).subspan(i, std::min(chunk, samples.size() - i)));
  return samples.size();
}

}  // namespace

Workload workload_of(const ConfigNode& rig, Duration duration) {
  const lidar::FiringTable firing = firing_table(read_rig(rig), 1);
  const auto sweeps = static_cast<std::size_t>(std::max<std::int64_t>(0, firing.sweeps_until(Time(duration))));
  return {sweeps, sweeps * static_cast<std::size_t>(firing.sweep(0).cycles) * firing.channels()};
}

void check(const SimulationInput& input) {
  sweeps_within(firing_table(read_setup(input).rig, input.seed), input);
  check_collisions(*input.scene, *input.motion, {}, Time(input.duration), input.scenario_name);
}

SimulationSummary simulate(const SimulationInput& input, const SimulationSettings& settings,
                           const std::filesystem::path& recording_folder, const std::filesystem::path& truth_folder,
                           const Progress& progress) {
  const Stopwatch watch;
  const int threads = std::clamp(settings.threads, 1, tbb::info::default_concurrency());
  Setup setup = read_setup(input);
  const RigOptions& options = setup.rig;

  const auto tracer =
      std::make_shared<const raycast::Tracer>(input.scene, raycast::TracerSettings{threads, settings.fast});
  const lidar::SweepSimulator simulator(options.lidar.profile, firing_table(options, input.seed),
                                        {.sensor = 0, .T_body_lidar = setup.truth.lidars[0].T_body_lidar},
                                        options.lidar.noise, input.seed, tracer, input.scene, input.motion);
  const std::int64_t count = sweeps_within(simulator.firing(), input);

  const faults::LidarFaults faults = lidar_faults(simulator.firing(), count, input.seed, setup);
  const SynthesizedImu imu = make_imu(setup, input);

  RecordingWriter recording(recording_folder, setup.sheet);
  truth::write_truth(truth_folder, input.resolved_scenario, input.resolved_motion, *input.motion, setup.truth,
                     setup.log);
  std::filesystem::remove(truth_folder / "imu0_errors.json");  // of an earlier run with an IMU
  if (options.has_imu) write_file(truth_folder / "imu0_errors.json", errors_as_json(imu.errors));
  ChunkWriter labels(truth_folder / "lidar0_labels.chunks");
  const auto after_sweep = [&](const PipelineTotals& so_far) {
    const double share = static_cast<double>(so_far.sweeps + so_far.lost) / static_cast<double>(count);
    progress(share, speed_note(so_far, share * to_s(input.duration), watch.wall_s()));
  };
  const PipelineTotals totals =
      run_sweeps(simulator, *input.scene, count, threads, recording, labels, after_sweep, &faults);
  labels.finish();

  SimulationSummary summary;
  summary.imu_samples = options.has_imu ? write_imu(options, imu.samples, recording) : 0;
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

std::string resolve_faults(const ConfigNode& faults, const ConfigNode& rig) {
  const RigOptions options = read_rig(rig);
  faults::FaultOptions read = faults::read_faults(faults, options.has_imu, options.lidar.sweep_rate_hz);
  if (!faults.present()) return "";
  return write_options_of([&](OptionVisitor& v) { read.visit(v, options.has_imu); }, 2);
}

}  // namespace tarmac::sim
