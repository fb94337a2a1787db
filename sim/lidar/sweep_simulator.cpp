#include "sim/lidar/sweep_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vector_loop.h"
#include "sim/lidar/thread_clock.h"

namespace tarmac::sim::lidar {
namespace {

using core::Time;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t tile = raycast::SweepTracer::tile;

std::string stream_name(std::uint16_t sensor, const char* effect) {
  return fmt::format("lidar{}/{}", sensor, effect);
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
TARMAC_VECTOR_LOOP void place_cycle(std::size_t channels, const BeamArrays b, double cos_azimuth, double sin_azimuth,
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

void resize(SimulatedSweep& out, std::size_t n, bool point_truth) {
  core::LidarSweep& s = out.sweep;
  for (auto* v : {&s.x_m, &s.y_m, &s.z_m, &s.intensity}) v->resize(n);
  s.t_ns.resize(n);
  s.ring.resize(n);
  out.instance.resize(n);
  out.kind.resize(n, truth::ReturnKind::surface);
  const std::size_t asked = point_truth ? n : 0;
  out.true_range_m.resize(asked);
  for (auto* v : {&out.normal_x, &out.normal_y, &out.normal_z, &out.cos_incidence}) v->resize(asked);
}

}  // namespace

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
      aim_(firing_, mounting.T_body_lidar) {
  for (std::size_t c = 0; c < firing_.channels(); ++c) ring_.push_back(firing_.ring(c));
  batches_.cycles = std::max<std::size_t>(1, requests.batch_rays / (tile * firing_.channels())) * tile;
  batches_.tiles = firing_.tiles(batches_.cycles);
  if (!requests.beam.any() && !requests.body.any()) return;
  std::shared_ptr<const OwnBody> body;
  if (requests.body.any()) body = std::make_shared<const OwnBody>(body_mesh(requests.body));
  beyond_ =
      std::make_shared<const Beyond>(Beyond{BeamModel(profile_, firing_, aim_, requests.beam, body, scene_),
                                            Receiver(profile_, firing_, noise, requests.beam, mounting.sensor, seed)});
}

raycast::SweepTracer SweepSimulator::tracer_for(const SweepSpan& span) const {
  const Vector3d origin = motion_->pose(span.begin) * mounting_.T_body_lidar.translation();
  const Vector3d last = motion_->pose(span.end) * mounting_.T_body_lidar.translation();
  return tracer_->sweep(span.begin, span.end, origin, profile_.max_range_m + 1 + (last - origin).norm());
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
  out.kind.clear();  // what is not told otherwise is a surface
  beyond_ ? sweep_beams(span, w, out) : sweep_lines(span, w, out);
}

void SweepSimulator::sweep_lines(const SweepSpan& span, Workspace& w, SimulatedSweep& out) const {
  resize(out, out.rays, requests_.point_truth);
  const raycast::SweepTracer tracer = tracer_for(span);
  const SweepMotion motion = motion_of(span);
  std::size_t points = 0;
  for (std::int64_t first = 0; first < span.cycles; first += static_cast<std::int64_t>(batches_.cycles)) {
    const std::size_t cycles = std::min(batches_.cycles, static_cast<std::size_t>(span.cycles - first));
    aim_.cycles(firing_, span, motion, first, cycles, tracer.base(), w.aimed);
    aim_.rays(firing_, w.aimed, w.rays);
    const double before_s = thread_cpu_s();
    if (cycles == batches_.cycles)
      tracer.trace(w.rays, batches_.tiles, w.hits);
    else
      tracer.trace(w.rays, firing_.tiles(cycles), w.hits);
    out.trace_cpu_s += thread_cpu_s() - before_s;
    measure(span, first, w);
    if (requests_.point_truth) report_truth(w, points, out);
    points = report(w, points, out);
  }
  resize(out, points, requests_.point_truth);
}

void SweepSimulator::sweep_beams(const SweepSpan& span, Workspace& w, SimulatedSweep& out) const {
  const raycast::SweepTracer tracer = tracer_for(span);
  const std::size_t channels = firing_.channels(), cycles = static_cast<std::size_t>(span.cycles);
  beyond_->model.echoes(firing_, aim_, span, motion_of(span), tracer, batches_, w.beams, out.trace_cpu_s);
  out.traced_rays = w.beams.traced_rays;
  out.split_beams = w.beams.split_beams;
  resize(out, requests_.beam.dual() ? 2 * out.rays : out.rays, requests_.point_truth);
  std::size_t points = 0;
  for (std::size_t first = 0; first < cycles; first += batches_.cycles) {
    const std::size_t count = std::min(batches_.cycles, cycles - first);
    aim_.body_cycles(firing_, span, static_cast<std::int64_t>(first), count, w.aimed);
    const auto number = static_cast<std::uint64_t>(span.first_cycle) + first;
    beyond_->receiver(w.beams.echoes, first * channels, count * channels, number * channels, w.receiver, w.firsts,
                      w.seconds);
    points = report_beams(w, span.begin, points, out);
  }
  resize(out, points, requests_.point_truth);
}

AimedSweep SweepSimulator::aimed(std::int64_t index) const {
  const SweepSpan span = firing_.sweep(index);
  AimedSweep result{tracer_for(span), {}, {}};
  AimedCycles cycles;
  aim_.cycles(firing_, span, motion_of(span), 0, static_cast<std::size_t>(span.cycles), result.tracer.base(), cycles);
  aim_.rays(firing_, cycles, result.rays);
  for (std::int64_t first = 0; first < span.cycles; first += static_cast<std::int64_t>(batches_.cycles)) {
    const std::size_t count = std::min(batches_.cycles, static_cast<std::size_t>(span.cycles - first));
    const auto offset = static_cast<std::uint32_t>(static_cast<std::size_t>(first) * firing_.channels());
    for (const std::uint32_t ray : firing_.tiles(count))
      result.tiles.push_back(ray == raycast::SweepTracer::no_ray ? ray : ray + offset);
  }
  return result;
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

/// The points of all firings of the cycles at work.
void SweepSimulator::place(const std::vector<double>& range_m, Workspace& w) const {
  const std::size_t channels = firing_.channels();
  for (auto* v : {&w.x_m, &w.y_m, &w.z_m}) v->resize(range_m.size());
  for (std::size_t k = 0, i = 0; k < w.aimed.cycles.size(); ++k, i += channels) {
    const Cycle cycle = w.aimed.cycles[k].reported();
    const Vector3d origin = firing_.origin(cycle);
    place_cycle(channels, aim_.beams(w.aimed, k), cycle.cos_azimuth, cycle.sin_azimuth, origin.data(),
                firing_.range_offset_m(), &range_m[i], &w.x_m[i], &w.y_m[i], &w.z_m[i]);
    if (!firing_.channel_origins()) continue;
    const Matrix3d turn = turned_by(cycle);
    for (std::size_t c = 0; c < channels; ++c) {
      const Eigen::Vector3f offset = (turn * aim_.origin_offset()[c]).cast<float>();
      w.x_m[i + c] += offset.x();
      w.y_m[i + c] += offset.y();
      w.z_m[i + c] += offset.z();
    }
  }
}

// Returns how many points there are now.
std::size_t SweepSimulator::report(Workspace& w, std::size_t points, SimulatedSweep& out) const {
  const Echoes& e = w.echoes;
  place(e.range_m, w);
  core::LidarSweep& to = out.sweep;
  // Each is written; those that do not count are written over by the next.
  for (std::size_t i = 0; i < e.size();)
    for (std::size_t c = 0; c < firing_.channels(); ++c, ++i) {
      to.x_m[points] = w.x_m[i];
      to.y_m[points] = w.y_m[i];
      to.z_m[points] = w.z_m[i];
      to.t_ns[points] = w.rays.t_ns[i];
      to.ring[points] = ring_[c];
      to.intensity[points] = e.intensity[i];
      out.instance[points] = w.hits.instance[i];
      points += (e.range_m[i] >= profile_.min_range_m) & (e.range_m[i] <= profile_.max_range_m);
    }
  return points;
}

}  // namespace tarmac::sim::lidar
