#include "sim/lidar/sweep_simulator.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tarmac::sim::lidar {
namespace {

using core::Duration;
using core::Kinematics;
using core::Time;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t batch_rays = 1024;  // small enough for the second-level cache with all arrays
constexpr std::size_t tile = raycast::SweepTracer::tile;

double thread_cpu_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string stream_name(std::uint16_t sensor, const char* effect) {
  return fmt::format("lidar{}/{}", sensor, effect);
}

// The pose of the sensor around one cycle's time: T(t + dt) = (p + v dt, R (I + hat(w) dt)), p relative to `base`.
struct SensorMotion {
  Matrix3d R;
  Vector3d p, v, w_sensor;

  SensorMotion(const Kinematics& k, const core::SE3& T_body_lidar, const Vector3d& base)
      : R(k.T_world_body.linear() * T_body_lidar.linear()),
        p(k.T_world_body * T_body_lidar.translation() - base),
        v(k.v_world + k.T_world_body.linear() * k.omega_body.cross(T_body_lidar.translation())),
        w_sensor(T_body_lidar.linear().transpose() * k.omega_body) {}
};

}  // namespace

void NoiseOptions::visit(core::OptionVisitor& v) {
  v("range_scale", range_scale, "factor on the sensor's range noise", {.at_least = 0});
  v("channel_bias_scale", channel_bias_scale, "factor on the constant range errors of its channels", {.at_least = 0});
  v("quantisation", quantisation, "round ranges to the sensor's step");
  v("dropout", dropout, "lose echoes that are too weak");
  v("intensity", intensity, "noise on the intensity");
}

SweepSimulator::SweepSimulator(const Profile& profile, const Mode& mode, const Mounting& mounting,
                               const NoiseOptions& noise, std::uint64_t seed,
                               std::shared_ptr<const raycast::Tracer> tracer,
                               std::shared_ptr<const scenes::Scene> scene,
                               std::shared_ptr<const core::SmoothTrajectory> motion)
    : SweepSimulator(profile, FiringTable(profile, mode), mounting, noise, seed, std::move(tracer), std::move(scene),
                     std::move(motion)) {}

SweepSimulator::SweepSimulator(const Profile& profile, FiringTable firing, const Mounting& mounting,
                               const NoiseOptions& noise, std::uint64_t seed,
                               std::shared_ptr<const raycast::Tracer> tracer,
                               std::shared_ptr<const scenes::Scene> scene,
                               std::shared_ptr<const core::SmoothTrajectory> motion)
    : profile_(profile),
      firing_(std::move(firing)),
      mounting_(mounting),
      options_(noise),
      tracer_(std::move(tracer)),
      scene_(std::move(scene)),
      motion_(std::move(motion)),
      reflectance_(scene_->materials),
      detection_(profile, seed, stream_name(mounting.sensor, "detection").c_str()),
      range_noise_(profile, noise.range_scale, seed, stream_name(mounting.sensor, "range_noise").c_str()),
      channel_bias_(profile, noise.channel_bias_scale, seed, stream_name(mounting.sensor, "channel_bias").c_str()),
      intensity_(noise.intensity, seed, stream_name(mounting.sensor, "intensity").c_str()),
      batch_cycles_(std::max<std::size_t>(1, batch_rays / (tile * firing_.channels())) * tile),
      batch_tiles_(firing_.tiles(batch_cycles_)) {}

SimulatedSweep SweepSimulator::sweep(std::int64_t index) const {
  const SweepSpan span = firing_.sweep(index);
  SimulatedSweep out;
  out.sweep.index = index;
  out.sweep.begin = span.begin;
  out.sweep.end = span.end;
  out.sweep.sensor = mounting_.sensor;
  out.rays = static_cast<std::size_t>(span.cycles) * firing_.channels();
  out.sweep.reserve(out.rays);
  out.instance.reserve(out.rays);

  const Vector3d origin = motion_->pose(span.begin) * mounting_.T_body_lidar.translation();
  const raycast::SweepTracer tracer = tracer_->sweep(span.begin, span.end, origin, profile_.max_range_m + 1);
  Workspace w;
  for (std::int64_t first = 0; first < span.cycles; first += static_cast<std::int64_t>(batch_cycles_)) {
    const std::size_t cycles = std::min(batch_cycles_, static_cast<std::size_t>(span.cycles - first));
    aim(span, first, cycles, tracer.base(), w);
    const double before_s = thread_cpu_s();
    if (cycles == batch_cycles_)
      tracer.trace(w.rays, batch_tiles_, w.hits);
    else
      tracer.trace(w.rays, firing_.tiles(cycles), w.hits);
    out.trace_cpu_s += thread_cpu_s() - before_s;
    measure(span, first, w);
    report(span, w, out);
  }
  return out;
}

void SweepSimulator::aim(const SweepSpan& span, std::int64_t first, std::size_t cycles, const Vector3d& base,
                         Workspace& w) const {
  const std::size_t channels = firing_.channels();
  raycast::Rays& rays = w.rays;
  rays.resize(cycles * channels);
  w.cycles.resize(cycles);
  for (std::size_t k = 0, i = 0; k < cycles; ++k) {
    const Cycle& cycle = w.cycles[k] = firing_.cycle(span, first + static_cast<std::int64_t>(k));
    const SensorMotion sensor(motion_->at(cycle.t), mounting_.T_body_lidar, base);
    const Vector3d origin_sensor = firing_.origin(cycle), origin = sensor.p + sensor.R * origin_sensor;
    const Vector3d origin_rate = sensor.v + sensor.R * sensor.w_sensor.cross(origin_sensor);
    const auto cycle_ns = static_cast<std::int32_t>((cycle.t - span.begin).count());
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      Vector3d d = firing_.direction(cycle, c), o = origin;
      const double dt = 1e-9 * firing_.offset_ns(c);
      if (firing_.channel_origins()) {
        const Vector3d offset = firing_.origin_offset(cycle, c);
        o += sensor.R * (offset + dt * sensor.w_sensor.cross(offset));
      }
      if (firing_.staggered()) {
        d += dt * sensor.w_sensor.cross(d);
        o += dt * origin_rate;
      }
      d = sensor.R * d;
      rays.ox[i] = o.x();
      rays.oy[i] = o.y();
      rays.oz[i] = o.z();
      rays.dx[i] = d.x();
      rays.dy[i] = d.y();
      rays.dz[i] = d.z();
      rays.t_ns[i] = cycle_ns + firing_.offset_ns(c);
    }
  }
}

void SweepSimulator::measure(const SweepSpan& span, std::int64_t first, Workspace& w) const {
  Echoes& e = w.echoes;
  e.resize(w.hits.size());
  e.channels = firing_.channels();
  e.first_firing = static_cast<std::uint64_t>(span.first_cycle + first) * firing_.channels();
  for (std::size_t i = 0; i < e.size(); ++i) {
    const bool met = w.hits.instance[i] != raycast::Hits::nothing;
    e.range_m[i] = met ? w.hits.t_m[i] + firing_.range_offset_m() : 0;
    e.cos_incidence[i] = w.hits.cos_incidence[i];
    e.material[i] = w.hits.material[i];
  }
  reflectance_(e);
  if (options_.dropout) detection_(e);
  if (options_.range_scale > 0) range_noise_(e);
  if (options_.channel_bias_scale > 0) channel_bias_(e);
  if (options_.quantisation) quantise(profile_.range_step_m, e);
  intensity_(e);
}

// p = origin + (range - offset) direction, by the nominal table: what the sensor's driver computes from a raw range.
void SweepSimulator::report(const SweepSpan&, const Workspace& w, SimulatedSweep& out) const {
  const std::size_t channels = firing_.channels();
  const Echoes& e = w.echoes;
  for (std::size_t k = 0, i = 0; k < w.cycles.size(); ++k) {
    const Cycle cycle = w.cycles[k].reported();
    const Vector3d shared_origin = firing_.origin(cycle);
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      if (!(e.range_m[i] >= profile_.min_range_m && e.range_m[i] <= profile_.max_range_m)) continue;
      Vector3d origin = shared_origin;
      if (firing_.channel_origins()) origin += firing_.origin_offset(cycle, c);
      const Vector3d p = origin + (e.range_m[i] - firing_.range_offset_m()) * firing_.direction(cycle, c);
      out.sweep.push_back(p.cast<float>(), w.rays.t_ns[i], static_cast<std::uint16_t>(profile_.ring[c]),
                          e.intensity[i]);
      out.instance.push_back(w.hits.instance[i]);
    }
  }
}

}  // namespace tarmac::sim::lidar
