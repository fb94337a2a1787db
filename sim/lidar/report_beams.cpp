// The points of beams that are more than lines: one or two a firing.
#include <limits>

#include "sim/lidar/sweep_simulator.h"

namespace tarmac::sim::lidar {

using Eigen::Vector3d;

/// One point, as place() puts it: in double where that rounds at the end only.
Eigen::Vector3f SweepSimulator::point_of(const Workspace& w, std::size_t firing, double range_m) const {
  const std::size_t channels = firing_.channels(), k = firing / channels, c = firing % channels;
  const Cycle cycle = w.aimed.cycles[k].reported();
  const BeamArrays b = aim_.beams(w.aimed, k);
  const Vector3d direction = turned_by(cycle) * Vector3d(b.x[c], b.y[c], b.z[c]);
  Vector3d p = firing_.origin(cycle) + (range_m - firing_.range_offset_m()) * direction;
  if (firing_.channel_origins()) p += turned_by(cycle) * aim_.origin_offset()[c];
  return p.cast<float>();
}

void SweepSimulator::report_return(const Returns& r, std::size_t i, std::size_t at, SimulatedSweep& out) const {
  out.sweep.intensity[at] = r.echoes.intensity[i];
  out.instance[at] = r.instance[i];
  out.kind[at] = r.kind[i];
  if (!requests_.point_truth) return;
  out.true_range_m[at] = r.true_range_m[i];
  out.normal_x[at] = r.nx[i];
  out.normal_y[at] = r.ny[i];
  out.normal_z[at] = r.nz[i];
  // Noise comes off no surface. The receiver counted with an incidence; it is none.
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  out.cos_incidence[at] = r.kind[i] == truth::ReturnKind::noise ? none : r.echoes.cos_incidence[i];
}

// Returns how many points there are now.
std::size_t SweepSimulator::report_beams(Workspace& w, core::Time begin, std::size_t points,
                                         SimulatedSweep& out) const {
  const std::size_t channels = firing_.channels();
  place(w.firsts.echoes.range_m, w);
  core::LidarSweep& to = out.sweep;
  const auto put = [&](const Returns& r, std::size_t i, std::size_t firing, const Eigen::Vector3f& p) {
    if (!reported(r.echoes.range_m[i])) return;
    const std::size_t c = firing % channels;
    to.x_m[points] = p.x();
    to.y_m[points] = p.y();
    to.z_m[points] = p.z();
    const auto cycle_ns = static_cast<std::int32_t>((w.aimed.cycles[firing / channels].t - begin).count());
    to.t_ns[points] = cycle_ns + firing_.offset_ns(c);
    to.ring[points] = ring_[c];
    report_return(r, i, points, out);
    ++points;
  };
  std::size_t second = 0;
  for (std::size_t i = 0; i < w.firsts.size(); ++i) {
    put(w.firsts, i, i, {w.x_m[i], w.y_m[i], w.z_m[i]});
    for (; second < w.seconds.size() && w.seconds.firing[second] == i; ++second)
      put(w.seconds, second, i, point_of(w, i, w.seconds.echoes.range_m[second]));
  }
  return points;
}

}  // namespace tarmac::sim::lidar
