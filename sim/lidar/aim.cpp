#include "sim/lidar/aim.h"

#include "core/vector_loop.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TARMAC_VECTOR_LOOP void point(std::size_t channels, const double* __restrict bx, const double* __restrict by,
                              const double* __restrict bz, const double* __restrict offset_s,
                              const double* __restrict R, const double* __restrict S, double* __restrict dx,
                              double* __restrict dy, double* __restrict dz) {
  const double r0 = R[0], r1 = R[1], r2 = R[2], r3 = R[3], r4 = R[4], r5 = R[5], r6 = R[6], r7 = R[7], r8 = R[8];
  const double s0 = S[0], s1 = S[1], s2 = S[2], s3 = S[3], s4 = S[4], s5 = S[5], s6 = S[6], s7 = S[7], s8 = S[8];
#pragma GCC ivdep
  for (std::size_t c = 0; c < channels; ++c) {
    const double x = bx[c], y = by[c], z = bz[c], dt = offset_s[c];
    dx[c] = r0 * x + r3 * y + r6 * z + dt * (s0 * x + s3 * y + s6 * z);
    dy[c] = r1 * x + r4 * y + r7 * z + dt * (s1 * x + s4 * y + s7 * z);
    dz[c] = r2 * x + r5 * y + r8 * z + dt * (s2 * x + s5 * y + s8 * z);
  }
}

TARMAC_VECTOR_LOOP void place(std::size_t channels, const double* __restrict offset_s, const double* __restrict origin,
                              const double* __restrict rate, double* __restrict ox, double* __restrict oy,
                              double* __restrict oz) {
  const double x = origin[0], y = origin[1], z = origin[2], vx = rate[0], vy = rate[1], vz = rate[2];
#pragma GCC ivdep
  for (std::size_t c = 0; c < channels; ++c) {
    const double dt = offset_s[c];
    ox[c] = x + dt * vx;
    oy[c] = y + dt * vy;
    oz[c] = z + dt * vz;
  }
}

}  // namespace

void BeamTable::push_back(const Vector3d& beam) {
  x.push_back(beam.x());
  y.push_back(beam.y());
  z.push_back(beam.z());
}

void BeamTable::clear() {
  x.clear();
  y.clear();
  z.clear();
}

void AimedCycles::clear() {
  cycles.clear();
  rays.clear();
  t_ns.clear();
  own.clear();
}

Matrix3d turned_by(const Cycle& cycle) {
  Matrix3d turn;
  turn << cycle.cos_azimuth, cycle.sin_azimuth, 0, -cycle.sin_azimuth, cycle.cos_azimuth, 0, 0, 0, 1;
  return turn;
}

CycleRays::CycleRays(const BodyState& body, const core::SE3& T_body_lidar, const Vector3d& base, const Cycle& cycle,
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

Aim::Aim(const FiringTable& firing, const core::SE3& T_body_lidar) : T_body_lidar_(T_body_lidar) {
  for (std::size_t c = 0; c < firing.channels(); ++c) {
    const Cycle ahead{core::Time{}, 1, 0, 1, 0};
    beams_.push_back(firing.direction(ahead, c));
    origin_offset_.push_back(firing.origin_offset(ahead, c));
    offset_s_.push_back(1e-9 * firing.offset_ns(c));
    offset_ns_.push_back(firing.offset_ns(c));
  }
}

void Aim::add_cycle(const FiringTable& firing, const Cycle& cycle, const BodyState& body, const Vector3d& base,
                    std::int32_t t_ns, AimedCycles& out) const {
  out.cycles.push_back(cycle);
  out.rays.emplace_back(body, T_body_lidar_, base, cycle, firing.origin(cycle));
  out.t_ns.push_back(t_ns);
  if (!firing.beams_change()) return;
  for (std::size_t c = 0; c < channels(); ++c) out.own.push_back(firing.direction(cycle, c));
}

void Aim::cycles(const FiringTable& firing, const SweepSpan& span, const SweepMotion& motion, std::int64_t first,
                 std::size_t count, const Vector3d& base, AimedCycles& out) const {
  out.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const Cycle cycle = firing.cycle(span, first + static_cast<std::int64_t>(k));
    add_cycle(firing, cycle, motion.at(cycle.t), base, static_cast<std::int32_t>((cycle.t - span.begin).count()), out);
  }
}

void Aim::body_cycles(const FiringTable& firing, const SweepSpan& span, std::int64_t first, std::size_t count,
                      AimedCycles& out) const {
  const BodyState still{Matrix3d::Identity(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  out.clear();
  for (std::size_t k = 0; k < count; ++k)
    add_cycle(firing, firing.cycle(span, first + static_cast<std::int64_t>(k)), still, Vector3d::Zero(), 0, out);
}

void Aim::rays(const FiringTable& firing, const AimedCycles& cycles, raycast::Rays& out) const {
  const std::size_t n = channels();
  out.resize(cycles.cycles.size() * n);
  for (std::size_t k = 0, i = 0; k < cycles.cycles.size(); ++k, i += n) {
    const CycleRays& c = cycles.rays[k];
    const BeamArrays b = beams(cycles, k);
    point(n, b.x, b.y, b.z, offset_s_.data(), c.R.data(), c.S.data(), &out.dx[i], &out.dy[i], &out.dz[i]);
    place(n, offset_s_.data(), c.origin.data(), c.rate.data(), &out.ox[i], &out.oy[i], &out.oz[i]);
    if (firing.channel_origins())
      for (std::size_t channel = 0; channel < n; ++channel) {
        const Vector3d by = c.shift(origin_offset_[channel], offset_s_[channel]);
        out.ox[i + channel] += by.x();
        out.oy[i + channel] += by.y();
        out.oz[i + channel] += by.z();
      }
    for (std::size_t channel = 0; channel < n; ++channel) out.t_ns[i + channel] = cycles.t_ns[k] + offset_ns_[channel];
  }
}

void Aim::directions(const AimedCycles& cycles, const BeamTable& beams, double* dx, double* dy, double* dz) const {
  const std::size_t n = channels();
  for (std::size_t k = 0, i = 0; k < cycles.cycles.size(); ++k, i += n) {
    const BeamArrays b = of_cycle(beams, k);
    point(n, b.x, b.y, b.z, offset_s_.data(), cycles.rays[k].R.data(), cycles.rays[k].S.data(), dx + i, dy + i, dz + i);
  }
}

}  // namespace tarmac::sim::lidar
