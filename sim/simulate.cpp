#include "sim/simulate.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <optional>

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

lidar::Requests requests_of(const LidarOptions& lidar, const lidar::BodyOptions& body, bool point_truth) {
  lidar::Requests requests;
  requests.point_truth = point_truth;
  requests.beam = lidar.beam;
  requests.body = body;
  return requests;
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

std::vector<double> sweep_rates_hz(const RigOptions& rig) {
  std::vector<double> rates;
  for (const LidarOptions& lidar : rig.lidars) rates.push_back(lidar.sweep_rate_hz);
  return rates;
}

Setup read_setup(const SimulationInput& input) {
  Setup setup;
  setup.rig = read_rig(input.rig);
  setup.faults = faults::read_faults(input.faults, setup.rig.has_imu, sweep_rates_hz(setup.rig));
  setup.sheet = setup.truth = data_sheet(setup.rig);
  for (std::size_t k = 0; k < setup.truth.lidars.size(); ++k) {
    const faults::LidarFaultOptions faults = setup.faults.of_lidar(k);
    if (setup.rig.lidars[k].profile.by_prism() && !faults.lost_sectors.empty())
      input.faults.fail(fmt::format("lost_sectors: {} has no head that turns through sectors; take them away",
                                    setup.rig.lidars[k].model));
    SE3& T_body_lidar = setup.truth.lidars[k].T_body_lidar;
    T_body_lidar = T_body_lidar * faults.extrinsic_error;
  }
  if (setup.rig.has_imu) {
    SE3& T_body_imu = setup.truth.imus[0].T_body_imu;
    T_body_imu = T_body_imu * setup.faults.imu.extrinsic_error;
  }
  return setup;
}

/// One LiDAR at work: what it fires, how often, and what goes wrong.
struct LidarRun {
  lidar::SweepSimulator simulator;
  std::int64_t sweeps;
  faults::LidarFaults faults;
};

faults::LidarFaults lidar_faults(const lidar::FiringTable& firing, std::int64_t count, std::uint64_t seed,
                                 std::size_t lidar, Setup& setup) {
  std::vector<faults::SweepStamp> sweeps;
  std::vector<std::size_t> columns;
  for (std::int64_t k = 0; k < count; ++k) {
    const lidar::SweepSpan span = firing.sweep(k);
    sweeps.push_back({span.begin, span.end});
    columns.push_back(static_cast<std::size_t>(span.cycles));
  }
  const std::string name = fmt::format("lidar{}", lidar);
  const faults::LidarFaultOptions options = setup.faults.of_lidar(lidar);
  faults::LidarFaults realised(options, sweeps, seed, name);
  for (truth::Fault& fault : faults::lidar_log(options, realised, columns, name)) setup.log.push_back(std::move(fault));
  return realised;
}

std::vector<LidarRun> make_lidars(Setup& setup, const SimulationInput& input,
                                  const std::shared_ptr<const raycast::Tracer>& tracer) {
  std::vector<LidarRun> runs;
  for (std::size_t k = 0; k < setup.rig.lidars.size(); ++k) {
    const LidarOptions& options = setup.rig.lidars[k];
    const lidar::Mounting mounting{static_cast<std::uint16_t>(k), setup.truth.lidars[k].T_body_lidar};
    lidar::SweepSimulator simulator(options.profile, firing_table(setup.rig, input.seed, k), mounting, options.noise,
                                    input.seed, tracer, input.scene, input.motion,
                                    requests_of(options, setup.rig.body, input.point_truth));
    const std::int64_t count = sweeps_within(simulator.firing(), input);
    faults::LidarFaults faults = lidar_faults(simulator.firing(), count, input.seed, k, setup);
    runs.push_back({std::move(simulator), count, std::move(faults)});
  }
  return runs;
}

/// Traces and writes all sweeps, LiDAR after LiDAR: each has a stream of its own.
PipelineTotals run_lidars(const std::vector<LidarRun>& lidars, const scenes::Scene& scene, int threads,
                          RecordingWriter& recording, const std::filesystem::path& truth_folder,
                          const AfterSweep& after_sweep) {
  PipelineTotals done;
  const auto sum = [&done](const PipelineTotals& more) {
    return PipelineTotals{done.sweeps + more.sweeps, done.rays + more.rays, done.points + more.points,
                          done.lost + more.lost, done.trace_cpu_s + more.trace_cpu_s};
  };
  for (std::size_t k = 0; k < lidars.size(); ++k) {
    ChunkWriter labels(truth_folder / fmt::format("lidar{}_labels.chunks", k));
    const PipelineTotals totals = run_sweeps(
        lidars[k].simulator, scene, lidars[k].sweeps, threads, recording, labels,
        [&](const PipelineTotals& so_far) { after_sweep(sum(so_far)); }, &lidars[k].faults);
    labels.finish();
    done = sum(totals);
  }
  return done;
}

/// Takes away what a run with other sensors has left.
void clear_truth(const std::filesystem::path& folder) {
  std::filesystem::remove(folder / "imu0_errors.json");
  if (!std::filesystem::is_directory(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("lidar") && name.ends_with("_labels.chunks")) std::filesystem::remove(entry.path());
  }
}

struct WrittenImu {
  std::size_t samples = 0;
  RealisedImuErrors errors;
};

/// Samples as they are recorded, a second at a time.
WrittenImu write_imu(Setup& setup, const SimulationInput& input, RecordingWriter& recording) {
  WrittenImu written;
  if (!setup.rig.has_imu) return written;
  const Time end = std::min(Time(input.duration), input.motion->end());
  ImuOptions mounted = setup.rig.imu;
  mounted.T_body_imu = setup.truth.imus[0].T_body_imu;
  ImuSynthesis imu(*input.motion, mounted, setup.rig.gravity_m_s2, Time{}, end, input.seed, "imu0");
  faults::ImuFaults faults(setup.faults.imu, input.seed, "imu0");
  const std::size_t second = std::max<std::size_t>(1, static_cast<std::size_t>(setup.rig.imu.rate_hz));
  std::vector<ImuSample> chunk;
  const auto flush = [&] {
    recording.write(0, chunk);
    written.samples += chunk.size();
    chunk.clear();
  };
  while (const std::optional<ImuSample> sample = imu.next()) {
    if (const std::optional<ImuSample> recorded = faults.next(*sample)) chunk.push_back(*recorded);
    if (chunk.size() == second) flush();
  }
  flush();
  for (truth::Fault& fault : faults::imu_log(setup.faults.imu, faults.lost(), written.samples + faults.lost(), "imu0"))
    setup.log.push_back(std::move(fault));
  written.errors = imu.errors();
  return written;
}

}  // namespace

Workload workload_of(const ConfigNode& rig, Duration duration, bool point_truth) {
  // Rough, on the safe side: recordings of whole sweeps with their labels took 7.9 bytes a ray, rays without a return
  // included; a point's truth (a double, four floats), an IMU sample and a line of truth.tum are taken nearly
  // uncompressed.
  constexpr double point_bytes = 11, point_truth_bytes = 18, imu_bytes = 46, tum_bytes_per_s = 118e3;
  const RigOptions options = read_rig(rig);
  Workload work;
  for (std::size_t k = 0; k < options.lidars.size(); ++k) {
    const lidar::FiringTable firing = firing_table(options, 1, k);
    const auto sweeps = static_cast<std::size_t>(std::max<std::int64_t>(0, firing.sweeps_until(Time(duration))));
    work.sweeps += sweeps;
    const std::size_t rays = sweeps * static_cast<std::size_t>(firing.sweep(0).cycles) * firing.channels();
    const double points =
        static_cast<double>(rays) * (options.lidars[k].beam.dual() ? 1.3 : 1);  // few have two returns
    work.rays += rays;
    work.bytes += (point_bytes + (point_truth ? point_truth_bytes : 0)) * points;
  }
  work.bytes += tum_bytes_per_s * to_s(duration);
  if (options.has_imu) work.bytes += imu_bytes * options.imu.rate_hz * to_s(duration);
  return work;
}

namespace {

/// What must not be run into: the rig's body where it has a size, what the motion carries where not.
truth::BodyBox ego_box(const lidar::BodyOptions& body, const truth::BodyBox& of_motion) {
  if (body.sized) {
    // A size says how high something stands above its own underside; where that is, the motion knows.
    truth::BodyBox box = of_motion;
    box.length_m = body.length_m;
    box.width_m = body.width_m;
    box.rear_overhang_m = body.rear_overhang_m;
    box.height_m = body.height_m - box.below_m;
    return box;
  }
  if (!body.any()) return of_motion;
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = low;
  for (const Eigen::Vector3f& p : lidar::body_mesh(body).vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d size = (high - low).cast<double>();
  return {.length_m = size.x(),
          .width_m = 2 * static_cast<double>(std::max(high.y(), -low.y())),
          .rear_overhang_m = static_cast<double>(-low.x()),
          .height_m = static_cast<double>(high.z())};
}

}  // namespace

void check(const SimulationInput& input) {
  const Setup setup = read_setup(input);
  for (std::size_t k = 0; k < setup.rig.lidars.size(); ++k)
    sweeps_within(firing_table(setup.rig, input.seed, k), input);
  check_collisions(*input.scene, *input.motion, ego_box(setup.rig.body, input.body), Time(input.duration),
                   input.scenario_name);
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
  const std::vector<LidarRun> lidars = make_lidars(setup, input, tracer);
  std::int64_t count = 0;
  for (const LidarRun& lidar : lidars) count += lidar.sweeps;

  RecordingWriter recording(recording_folder, setup.sheet);
  const WrittenImu imu = write_imu(setup, input, recording);
  clear_truth(truth_folder);
  truth::write_truth(truth_folder, input.resolved_scenario, input.resolved_motion, *input.motion, setup.truth,
                     setup.log);
  if (options.has_imu) write_file(truth_folder / "imu0_errors.json", errors_as_json(imu.errors));
  const auto after_sweep = [&](const PipelineTotals& so_far) {
    const double share = static_cast<double>(so_far.sweeps + so_far.lost) / static_cast<double>(count);
    progress(share, speed_note(so_far, share * to_s(input.duration), watch.wall_s()));
  };
  const PipelineTotals totals = run_lidars(lidars, *input.scene, threads, recording, truth_folder, after_sweep);

  SimulationSummary summary;
  summary.imu_samples = imu.samples;
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
  faults::FaultOptions read = faults::read_faults(faults, options.has_imu, sweep_rates_hz(options));
  if (!faults.present()) return "";
  return write_options_of([&](OptionVisitor& v) { read.visit(v, options.has_imu); }, 2);
}

}  // namespace tarmac::sim
