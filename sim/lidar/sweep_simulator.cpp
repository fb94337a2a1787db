#include "sim/lidar/sweep_simulator.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vector_loop.h"

namespace tarmac::sim::lidar {
namespace {

using core::Duration;
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

/// Turns the sensor's beams by -azimuth about z: azimuths are clockwise.
Matrix3d turned_by(const Cycle& cycle) {
  Matrix3d turn;
  turn << cycle.cos_azimuth, cycle.sin_azimuth, 0, -cycle.sin_azimuth, cycle.cos_azimuth, 0, 0, 0, 1;
  return turn;
}

/// The rays of one cycle: o = origin + dt rate, d = (R + dt S) b, for beams b in the head's frame.
struct CycleRays {
  Matrix3d R, S;
  Vector3d origin, rate;

  // The sensor around the cycle's time: T(t + dt) = (p + v dt, R (I + hat(w) dt)), p relative to `base`.
  CycleRays(const BodyState& body, const core::SE3& T_body_lidar, const Vector3d& base, const Cycle& cycle,
            const Vector3d& origin_sensor) {
    const Matrix3d R_world_lidar = body.R_world_body * T_body_lidar.linear(), turn = turned_by(cycle);
    const Vector3d omega_lidar = T_body_lidar.linear().transpose() * body.omega_body;
    const Vector3d arm = body.R_world_body * T_body_lidar.translation();
    const Matrix3d swing = R_world_lidar * core::so3::hat(omega_lidar);
    R = R_world_lidar * turn;
    S = swing * turn;
    origin = body.p_world + arm - base + R_world_lidar * origin_sensor;
    rate = body.v_world + body.R_world_body * body.omega_body.cross(T_body_lidar.translation()) + swing * origin_sensor;
  }

  /// How far a beam's own origin, in the head's frame, moves the ray.
  Vector3d shift(const Vector3d& offset, double dt_s) const { return (R + dt_s * S) * offset; }
};

struct RayArrays {
  double *ox, *oy, *oz, *dx, *dy, *dz;
};

TARMAC_VECTOR_LOOP void aim_cycle(std::size_t channels, const Beams b, const double* __restrict R,
                                  const double* __restrict S, const double* __restrict origin,
                                  const double* __restrict rate, const RayArrays out) {
  const double r0 = R[0], r1 = R[1], r2 = R[2], r3 = R[3], r4 = R[4], r5 = R[5], r6 = R[6], r7 = R[7], r8 = R[8];
  const double s0 = S[0], s1 = S[1], s2 = S[2], s3 = S[3], s4 = S[4], s5 = S[5], s6 = S[6], s7 = S[7], s8 = S[8];
  const double ox = origin[0], oy = origin[1], oz = origin[2], vx = rate[0], vy = rate[1], vz = rate[2];
#pragma GCC ivdep
  for (std::size_t c = 0; c < channels; ++c) {
    const double x = b.x[c], y = b.y[c], z = b.z[c], dt = b.offset_s[c];
    out.ox[c] = ox + dt * vx;
    out.oy[c] = oy + dt * vy;
    out.oz[c] = oz + dt * vz;
    out.dx[c] = r0 * x + r3 * y + r6 * z + dt * (s0 * x + s3 * y + s6 * z);
    out.dy[c] = r1 * x + r4 * y + r7 * z + dt * (s1 * x + s4 * y + s7 * z);
    out.dz[c] = r2 * x + r5 * y + r8 * z + dt * (s2 * x + s5 * y + s8 * z);
  }
}

/// Raw ranges of what was met, 0 where nothing was.
TARMAC_VECTOR_LOOP void raw_ranges(std::size_t count, const double* __restrict t_m,
                                   const std::uint32_t* __restrict instance, double offset_m,
                                   double* __restrict range_m) {
  for (std::size_t i = 0; i < count; ++i) {
    const double range = t_m[i] + offset_m;
    range_m[i] = instance[i] != raycast::Hits::nothing ? range : 0.0;
  }
}

/// p = origin + (range - offset) direction, by the nominal table: what the sensor's driver computes from a raw range.
TARMAC_VECTOR_LOOP void place_cycle(std::size_t channels, const Beams b, double cos_azimuth, double sin_azimuth,
                                    const double* __restrict origin, double offset_m, const double* __restrict range_m,
                                    float* __restrict x_m, float* __restrict y_m, float* __restrict z_m) {
  const double ox = origin[0], oy = origin[1], oz = origin[2];
  for (std::size_t c = 0; c < channels; ++c) {
    const double r = range_m[c] - offset_m, x = b.x[c], y = b.y[c];
    x_m[c] = static_cast<float>(ox + r * (x * cos_azimuth + y * sin_azimuth));
    y_m[c] = static_cast<float>(oy + r * (y * cos_azimuth - x * sin_azimuth));
    z_m[c] = static_cast<float>(oz + r * b.z[c]);
  }
}

void shift(raycast::Rays& rays, std::size_t i, const Vector3d& by) {
  rays.ox[i] += by.x();
  rays.oy[i] += by.y();
  rays.oz[i] += by.z();
}

void resize(SimulatedSweep& out, std::size_t n, bool point_truth) {
  core::LidarSweep& s = out.sweep;
  for (auto* v : {&s.x_m, &s.y_m, &s.z_m, &s.intensity}) v->resize(n);
  s.t_ns.resize(n);
  s.ring.resize(n);
  out.instance.resize(n);
  out.kind.assign(n, truth::ReturnKind::surface);
  const std::size_t asked = point_truth ? n : 0;
  out.true_range_m.resize(asked);
  for (auto* v : {&out.normal_x, &out.normal_y, &out.normal_z, &out.cos_incidence}) v->resize(asked);
}

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
                               std::shared_ptr<const core::SmoothTrajectory> motion, const Requests& requests)
    : SweepSimulator(profile, FiringTable(profile, mode), mounting, noise, seed, std::move(tracer), std::move(scene),
                     std::move(motion), requests) {}

SweepSimulator::SweepSimulator(const Profile& profile, FiringTable firing, const Mounting& mounting,
                               const NoiseOptions& noise, std::uint64_t seed,
                               std::shared_ptr<const raycast::Tracer> tracer,
                               std::shared_ptr<const scenes::Scene> scene,
                               std::shared_ptr<const core::SmoothTrajectory> motion, const Requests& requests)
    : profile_(profile),
      firing_(std::move(firing)),
      mounting_(mounting),
      options_(noise),
      requests_(requests),
      tracer_(std::move(tracer)),
      scene_(std::move(scene)),
      motion_(std::move(motion)),
      reflectance_(scene_->materials),
      detection_(profile, seed, stream_name(mounting.sensor, "detection").c_str()),
      range_noise_(profile, noise.range_scale, seed, stream_name(mounting.sensor, "range_noise").c_str()),
      channel_bias_(profile, noise.channel_bias_scale, seed, stream_name(mounting.sensor, "channel_bias").c_str(),
                    firing_.profile_channels()),
      intensity_(noise.intensity, seed, stream_name(mounting.sensor, "intensity").c_str()),
      batch_cycles_(std::max<std::size_t>(1, batch_rays / (tile * firing_.channels())) * tile),
      batch_tiles_(firing_.tiles(batch_cycles_)) {
  for (std::size_t c = 0; c < firing_.channels(); ++c) {
    const Cycle ahead{Time{}, 1, 0, 1, 0};
    const Vector3d beam = firing_.direction(ahead, c);
    origin_offset_.push_back(firing_.origin_offset(ahead, c));
    beam_x_.push_back(beam.x());
    beam_y_.push_back(beam.y());
    beam_z_.push_back(beam.z());
    offset_s_.push_back(1e-9 * firing_.offset_ns(c));
    ring_.push_back(firing_.ring(c));
  }
}

raycast::SweepTracer SweepSimulator::tracer_for(const SweepSpan& span) const {
  const Vector3d origin = motion_->pose(span.begin) * mounting_.T_body_lidar.translation();
  return tracer_->sweep(span.begin, span.end, origin, profile_.max_range_m + 1);
}

SweepMotion SweepSimulator::motion_of(const SweepSpan& span) const {
  return SweepMotion(*motion_, firing_.cycle(span, 0).t, firing_.cycle(span, span.cycles - 1).t);
}

SimulatedSweep SweepSimulator::sweep(std::int64_t index) const {
  Workspace workspace;
  SimulatedSweep out;
  sweep(index, workspace, out);
  return out;
}

void SweepSimulator::sweep(std::int64_t index, Workspace& w, SimulatedSweep& out) const {
  const SweepSpan span = firing_.sweep(index);
  out.sweep.index = index;
  out.sweep.begin = span.begin;
  out.sweep.end = span.end;
  out.sweep.sensor = mounting_.sensor;
  out.rays = static_cast<std::size_t>(span.cycles) * firing_.channels();
  out.trace_cpu_s = 0;
  resize(out, out.rays, requests_.point_truth);

  const raycast::SweepTracer tracer = tracer_for(span);
  const SweepMotion motion = motion_of(span);
  std::size_t points = 0;
  for (std::int64_t first = 0; first < span.cycles; first += static_cast<std::int64_t>(batch_cycles_)) {
    const std::size_t cycles = std::min(batch_cycles_, static_cast<std::size_t>(span.cycles - first));
    aim(span, motion, first, cycles, tracer.base(), w);
    const double before_s = thread_cpu_s();
    if (cycles == batch_cycles_)
      tracer.trace(w.rays, batch_tiles_, w.hits);
    else
      tracer.trace(w.rays, firing_.tiles(cycles), w.hits);
    out.trace_cpu_s += thread_cpu_s() - before_s;
    measure(span, first, w);
    if (requests_.point_truth) report_truth(w, points, out);
    points = report(w, points, out);
  }
  resize(out, points, requests_.point_truth);
}

AimedSweep SweepSimulator::aimed(std::int64_t index) const {
  const SweepSpan span = firing_.sweep(index);
  AimedSweep result{tracer_for(span), {}, {}};
  Workspace w;
  aim(span, motion_of(span), 0, static_cast<std::size_t>(span.cycles), result.tracer.base(), w);
  result.rays = std::move(w.rays);
  for (std::int64_t first = 0; first < span.cycles; first += static_cast<std::int64_t>(batch_cycles_)) {
    const std::size_t cycles = std::min(batch_cycles_, static_cast<std::size_t>(span.cycles - first));
    const auto offset = static_cast<std::uint32_t>(static_cast<std::size_t>(first) * firing_.channels());
    for (const std::uint32_t ray : firing_.tiles(cycles))
      result.tiles.push_back(ray == raycast::SweepTracer::no_ray ? ray : ray + offset);
  }
  return result;
}

void SweepSimulator::aim(const SweepSpan& span, const SweepMotion& motion, std::int64_t first, std::size_t cycles,
                         const Vector3d& base, Workspace& w) const {
  const std::size_t channels = firing_.channels();
  raycast::Rays& rays = w.rays;
  rays.resize(cycles * channels);
  w.cycles.resize(cycles);
  for (std::size_t k = 0; k < cycles; ++k) w.cycles[k] = firing_.cycle(span, first + static_cast<std::int64_t>(k));
  if (firing_.beams_change()) point_beams(w);
  for (std::size_t k = 0; k < cycles; ++k) {
    const Cycle& cycle = w.cycles[k];
    const CycleRays c(motion.at(cycle.t), mounting_.T_body_lidar, base, cycle, firing_.origin(cycle));
    const std::size_t i = k * channels;
    aim_cycle(channels, beams_at(w, i), c.R.data(), c.S.data(), c.origin.data(), c.rate.data(),
              {&rays.ox[i], &rays.oy[i], &rays.oz[i], &rays.dx[i], &rays.dy[i], &rays.dz[i]});
    if (firing_.channel_origins())
      for (std::size_t channel = 0; channel < channels; ++channel)
        shift(rays, i + channel, c.shift(origin_offset_[channel], offset_s_[channel]));
    const auto cycle_ns = static_cast<std::int32_t>((cycle.t - span.begin).count());
    for (std::size_t channel = 0; channel < channels; ++channel)
      rays.t_ns[i + channel] = cycle_ns + firing_.offset_ns(channel);
  }
}

Beams SweepSimulator::beams_at(const Workspace& w, std::size_t i) const {
  if (firing_.beams_change()) return {&w.beam_x[i], &w.beam_y[i], &w.beam_z[i], offset_s_.data()};
  return {beam_x_.data(), beam_y_.data(), beam_z_.data(), offset_s_.data()};
}

void SweepSimulator::point_beams(Workspace& w) const {
  const std::size_t channels = firing_.channels();
  for (auto* v : {&w.beam_x, &w.beam_y, &w.beam_z}) v->resize(w.cycles.size() * channels);
  for (std::size_t k = 0, i = 0; k < w.cycles.size(); ++k)
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      const Vector3d beam = firing_.direction(w.cycles[k], c);
      w.beam_x[i] = beam.x();
      w.beam_y[i] = beam.y();
      w.beam_z[i] = beam.z();
    }
}

void SweepSimulator::measure(const SweepSpan& span, std::int64_t first, Workspace& w) const {
  Echoes& e = w.echoes;
  e.resize(w.hits.size());
  e.channels = firing_.channels();
  e.first_firing = static_cast<std::uint64_t>(span.first_cycle + first) * firing_.channels();
  raw_ranges(e.size(), w.hits.t_m.data(), w.hits.instance.data(), firing_.range_offset_m(), e.range_m.data());
  if (requests_.point_truth) w.true_range_m = e.range_m;
  e.cos_incidence.swap(w.hits.cos_incidence);
  e.material.swap(w.hits.material);
  reflectance_(e);
  if (options_.dropout) detection_(e);
  if (options_.range_scale > 0) range_noise_(e);
  if (options_.channel_bias_scale > 0) channel_bias_(e);
  if (options_.quantisation) quantise(profile_.range_step_m, e);
  intensity_(e);
}

void SweepSimulator::report_truth(const Workspace& w, std::size_t points, SimulatedSweep& out) const {
  for (std::size_t i = 0; i < w.echoes.size(); ++i) {
    if (!reported(w.echoes.range_m[i])) continue;
    out.true_range_m[points] = w.true_range_m[i];
    out.normal_x[points] = w.hits.nx[i];
    out.normal_y[points] = w.hits.ny[i];
    out.normal_z[points] = w.hits.nz[i];
    out.cos_incidence[points] = w.echoes.cos_incidence[i];
    ++points;
  }
}

// Returns how many points there are now.
std::size_t SweepSimulator::report(Workspace& w, std::size_t points, SimulatedSweep& out) const {
  const std::size_t channels = firing_.channels(), firings = w.echoes.size();
  const Echoes& e = w.echoes;
  for (auto* v : {&w.x_m, &w.y_m, &w.z_m}) v->resize(firings);
  core::LidarSweep& to = out.sweep;
  for (std::size_t k = 0, i = 0; k < w.cycles.size(); ++k) {
    const Cycle cycle = w.cycles[k].reported();
    const Vector3d origin = firing_.origin(cycle);
    place_cycle(channels, beams_at(w, i), cycle.cos_azimuth, cycle.sin_azimuth, origin.data(), firing_.range_offset_m(),
                &e.range_m[i], &w.x_m[i], &w.y_m[i], &w.z_m[i]);
    if (firing_.channel_origins()) {
      const Matrix3d turn = turned_by(cycle);
      for (std::size_t c = 0; c < channels; ++c) {
        const Eigen::Vector3f offset = (turn * origin_offset_[c]).cast<float>();
        w.x_m[i + c] += offset.x();
        w.y_m[i + c] += offset.y();
        w.z_m[i + c] += offset.z();
      }
    }
    // Each is written; those that do not count are written over by the next.
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      to.x_m[points] = w.x_m[i];
      to.y_m[points] = w.y_m[i];
      to.z_m[points] = w.z_m[i];
      to.t_ns[points] = w.rays.t_ns[i];
      to.ring[points] = ring_[c];
      to.intensity[points] = e.intensity[i];
      out.instance[points] = w.hits.instance[i];
      points += (e.range_m[i] >= profile_.min_range_m) & (e.range_m[i] <= profile_.max_range_m);
    }
  }
  return points;
}

}  // namespace tarmac::sim::lidar
