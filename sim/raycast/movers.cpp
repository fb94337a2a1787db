#include "sim/raycast/movers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vector_loop.h"

namespace tarmac::sim::raycast {
namespace {

using Eigen::Vector3d;

constexpr std::size_t tile = SweepTracer::tile;
// Within this time poses are taken as moving in a straight line: a T^2 / 8 is 6 micrometres at 2 m/s^2. It decides
// which triangle is met; where on it is computed from the pose itself.
constexpr double straight_ns = 5e6;
constexpr float around_bounds_m = 2e-3f;

float wrapped(float diamond) {
  return diamond >= 2 ? diamond - 4 : diamond < -2 ? diamond + 4 : diamond;
}

/// A pose of every lane: row by row R, then p.
struct LaneFrames {
  alignas(64) double row[12][tile];
};

void set_lane(LaneFrames& frames, std::size_t lane, const Frame& frame) {
  for (int k = 0; k < 9; ++k) frames.row[k][lane] = frame.R(k / 3, k % 3);
  for (int k = 0; k < 3; ++k) frames.row[9 + k][lane] = frame.p[k];
}

void entries_of(const Frame& frame, double* entries) {
  for (int k = 0; k < 9; ++k) entries[k] = frame.R(k / 3, k % 3);
  for (int k = 0; k < 3; ++k) entries[9 + k] = frame.p[k];
}

TARMAC_VECTOR_LOOP void blend(const double* __restrict first, const double* __restrict change,
                              const double* __restrict share, double (*__restrict row)[tile]) {
  for (int k = 0; k < 12; ++k)
    for (std::size_t lane = 0; lane < tile; ++lane) row[k][lane] = first[k] + share[lane] * change[k];
}

/// R^T (o - p) and R^T d.
TARMAC_VECTOR_LOOP void turn_rays(const LaneRays& world, const double (*__restrict f)[tile], RTCRay16& local) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < tile; ++k) {
    const double x = world.ox[k] - f[9][k], y = world.oy[k] - f[10][k], z = world.oz[k] - f[11][k];
    local.org_x[k] = static_cast<float>(f[0][k] * x + f[3][k] * y + f[6][k] * z);
    local.org_y[k] = static_cast<float>(f[1][k] * x + f[4][k] * y + f[7][k] * z);
    local.org_z[k] = static_cast<float>(f[2][k] * x + f[5][k] * y + f[8][k] * z);
    const double dx = world.dx[k], dy = world.dy[k], dz = world.dz[k];
    local.dir_x[k] = static_cast<float>(f[0][k] * dx + f[3][k] * dy + f[6][k] * dz);
    local.dir_y[k] = static_cast<float>(f[1][k] * dx + f[4][k] * dy + f[7][k] * dz);
    local.dir_z[k] = static_cast<float>(f[2][k] * dx + f[5][k] * dy + f[8][k] * dz);
  }
}

/// Slabs: where each ray is inside all three pairs of planes.
TARMAC_VECTOR_LOOP void meet_bounds(const RTCRay16& ray, const float* __restrict low, const float* __restrict high,
                                    int* __restrict valid) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < tile; ++k) {
    constexpr float least = 1e-12f;
    const float dx = ray.dir_x[k], dy = ray.dir_y[k], dz = ray.dir_z[k];
    const float ix = 1.0f / ((dx < 0 ? -dx : dx) < least ? least : dx);
    const float iy = 1.0f / ((dy < 0 ? -dy : dy) < least ? least : dy);
    const float iz = 1.0f / ((dz < 0 ? -dz : dz) < least ? least : dz);
    const float x0 = (low[0] - ray.org_x[k]) * ix, x1 = (high[0] - ray.org_x[k]) * ix;
    const float y0 = (low[1] - ray.org_y[k]) * iy, y1 = (high[1] - ray.org_y[k]) * iy;
    const float z0 = (low[2] - ray.org_z[k]) * iz, z1 = (high[2] - ray.org_z[k]) * iz;
    const float xn = x0 < x1 ? x0 : x1, xf = x0 < x1 ? x1 : x0;
    const float yn = y0 < y1 ? y0 : y1, yf = y0 < y1 ? y1 : y0;
    const float zn = z0 < z1 ? z0 : z1, zf = z0 < z1 ? z1 : z0;
    float in = xn > yn ? xn : yn, out = xf < yf ? xf : yf;
    in = in > zn ? in : zn;
    out = out < zf ? out : zf;
    in = in > 0.0f ? in : 0.0f;
    out = out < ray.tfar[k] ? out : ray.tfar[k];
    valid[k] = in <= out ? valid[k] : 0;
  }
}

}  // namespace

Bounds bounds_of(const scenes::Mesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Bounds b{mesh.vertices.front(), mesh.vertices.front()};
  for (const Eigen::Vector3f& v : mesh.vertices) {
    b.low = b.low.cwiseMin(v);
    b.high = b.high.cwiseMax(v);
  }
  b.low.array() -= around_bounds_m;
  b.high.array() += around_bounds_m;
  return b;
}

float diamond_angle(float x, float y) {
  const float size = std::abs(x) + std::abs(y);
  if (size == 0) return 0;
  const float a = y / size;
  return x < 0 ? 2 - a : a < 0 ? 4 + a : a;
}

bool Shade::covers(const TileView& view) const {
  if (view.z_low > z_high || view.z_high < z_low) return false;
  if (all_round) return true;
  const float apart = wrapped(view.angle - angle);
  const float low = apart + view.angle_low, high = apart + view.angle_high;
  // Both ranges may reach round the back.
  return (low <= angle_high && high >= angle_low) || (low - 4 <= angle_high && high - 4 >= angle_low) ||
         (low + 4 <= angle_high && high + 4 >= angle_low);
}

namespace {

/// Corners of the bounds at one time, seen from the batch's centre.
struct Corners {
  std::array<Vector3d, 8> at;
};

Corners corners_of(const Bounds& bounds, const Frame& frame, const Vector3d& from) {
  Corners corners;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3f c(k & 1 ? bounds.high.x() : bounds.low.x(), k & 2 ? bounds.high.y() : bounds.low.y(),
                            k & 4 ? bounds.high.z() : bounds.low.z());
    corners.at[static_cast<std::size_t>(k)] = frame.R * c.cast<double>() + frame.p - from;
  }
  return corners;
}

/// Least horizontal distance of the bounds from the batch's centre, not above the true one: along the line to their
/// middle, and along their own axes.
double horizontal_distance(const Corners& corners, const Frame& frame) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& c : corners.at) middle += c / 8;
  double distance = 0;
  for (Eigen::Vector2d axis : {Eigen::Vector2d(middle.head<2>()), Eigen::Vector2d(frame.R.col(0).head<2>()),
                               Eigen::Vector2d(frame.R.col(1).head<2>())}) {
    const double length = axis.norm();
    if (length < 1e-9) continue;
    axis /= length;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& c : corners.at) {
      low = std::min(low, axis.dot(c.head<2>()));
      high = std::max(high, axis.dot(c.head<2>()));
    }
    distance = std::max({distance, low, -high});
  }
  return distance;
}

/// What the part hides at one time; `spare_m` is added on all sides.
Shade shade_at(const Corners& corners, double distance_m, double spare_m) {
  Shade shade;
  double top = -std::numeric_limits<double>::infinity(), bottom = -top, farthest = 0;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& c : corners.at) {
    top = std::max(top, c.z() + spare_m);
    bottom = std::min(bottom, c.z() - spare_m);
    farthest = std::max(farthest, c.head<2>().norm() + spare_m);
    middle += c / 8;
  }
  const double near = distance_m - spare_m;
  shade.nearest_m = static_cast<float>(std::max(0.0, near));
  const auto slope = [](double z, double r) { return static_cast<float>(z / std::hypot(z, r)); };
  constexpr float rounding = 1e-5f;
  if (near < 0.05) {  // the rays start above, below or within it
    shade.all_round = true;
    shade.z_high = top > 0 ? 1 : slope(top, farthest) + rounding;
    shade.z_low = bottom < 0 ? -1 : slope(bottom, farthest) - rounding;
    return shade;
  }
  shade.z_high = slope(top, top > 0 ? near : farthest) + rounding;
  shade.z_low = slope(bottom, bottom < 0 ? near : farthest) - rounding;
  shade.angle = diamond_angle(static_cast<float>(middle.x()), static_cast<float>(middle.y()));
  // A turn of an angle turns the diamond angle by as much, or less.
  const auto spread = static_cast<float>(std::asin(std::min(1.0, spare_m / distance_m))) + rounding;
  for (const Vector3d& c : corners.at) {
    const float apart = wrapped(diamond_angle(static_cast<float>(c.x()), static_cast<float>(c.y())) - shade.angle);
    shade.angle_low = std::min(shade.angle_low, apart - spread);
    shade.angle_high = std::max(shade.angle_high, apart + spread);
  }
  return shade;
}

}  // namespace

namespace {

// 64 bins of the directions' height; what is steeper shares the first and the last.
constexpr float z_bins_per_1 = 64, z_middle = 32;

int z_bin(float z) {
  return std::clamp(static_cast<int>(z * z_bins_per_1 + z_middle), 0, 63);
}

std::uint64_t z_bins_of(const Shade& shade) {
  const int low = z_bin(shade.z_low), high = z_bin(shade.z_high);
  return (~std::uint64_t{0} >> (63 - (high - low))) << low;
}

int sector_below(float angle) {
  return static_cast<int>(std::floor(angle * (Shades::sectors / 4)));
}

}  // namespace

namespace {

/// What a part hides from a batch, as it is at the middle of the batch's time, with what it moves until its ends as
/// spare.
Shade shade_of(const MovingPart& part, const BatchBounds& batch) {
  const Frame frame = part.track.at(0.5 * (batch.t_first_ns + batch.t_last_ns));
  double spare_m = batch.radius_m;
  if (!part.track.still()) {
    const double radius_m =
        static_cast<double>(part.bounds.low.cwiseAbs().cwiseMax(part.bounds.high.cwiseAbs()).norm());
    double moved_m = 0;
    for (const double t_ns : {batch.t_first_ns, batch.t_last_ns}) {
      const Frame then = part.track.at(t_ns);
      moved_m = std::max(moved_m, (then.p - frame.p).norm() + (then.R - frame.R).norm() * radius_m);
    }
    // Between the middle and an end nothing is farther off the straight way than the bow of its acceleration; twice
    // that, since corners of the bounds may lie outside of the actor's sphere.
    const double half_s = 0.5e-9 * (batch.t_last_ns - batch.t_first_ns);
    spare_m += moved_m + 2 * part.acceleration_m_s2 * half_s * half_s / 8 + 1e-3;
  }
  const Corners corners = corners_of(part.bounds, frame, batch.centre_m);
  return shade_at(corners, horizontal_distance(corners, frame), spare_m);
}

/// Calls visit(sector) for every sector that the shade reaches into.
template <class Visit>
void for_sectors(const Shade& shade, const Visit& visit) {
  const int first = shade.all_round ? 0 : sector_below(shade.angle + shade.angle_low);
  const int end = shade.all_round ? Shades::sectors - 1 : sector_below(shade.angle + shade.angle_high);
  for (int k = first; k <= std::min(end, first + Shades::sectors - 1); ++k)
    visit(static_cast<std::size_t>(((k % Shades::sectors) + Shades::sectors) % Shades::sectors));
}

}  // namespace

Whereabouts whereabouts_of(const std::vector<MovingPart>& parts, const Vector3d& centre_m, double span_ns) {
  Whereabouts result{centre_m, {}};
  const BatchBounds all{centre_m, Whereabouts::near_m, 0, span_ns};
  for (const MovingPart& part : parts) {
    std::uint64_t sectors = 0;
    for_sectors(shade_of(part, all), [&](std::size_t sector) { sectors |= std::uint64_t{1} << sector; });
    result.sectors.push_back(sectors);
  }
  return result;
}

void cast_shades(const std::vector<MovingPart>& parts, const Whereabouts& whereabouts, const BatchBounds& batch,
                 double reach_m, Shades& shades) {
  shades.clear();
  const bool known = whereabouts.holds(batch);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (known && (whereabouts.sectors[i] & batch.sectors) == 0) continue;
    Shade shade = shade_of(parts[i], batch);
    if (static_cast<double>(shade.nearest_m) > reach_m) continue;
    shade.part = static_cast<std::uint32_t>(i);
    shade.z_bins = z_bins_of(shade);
    const auto index = static_cast<std::uint32_t>(shades.all.size());
    for_sectors(shade, [&](std::size_t sector) {
      shades.in_sector[sector].push_back(index);
      shades.z_bins[sector] |= shade.z_bins;
    });
    shades.all.push_back(shade);
  }
  shades.seen_by.assign(shades.all.size(), 0);
}

namespace {

TARMAC_VECTOR_LOOP void bins_of(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                                int* __restrict sector, int* __restrict bin) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < tile; ++k) {
    const float size = (x[k] < 0 ? -x[k] : x[k]) + (y[k] < 0 ? -y[k] : y[k]);
    const float a = y[k] / (size > 0 ? size : 1.0f);
    const float angle = x[k] < 0 ? 2.0f - a : (a < 0 ? 4.0f + a : a);
    const int s = static_cast<int>(angle * (Shades::sectors / 4));
    sector[k] = s < Shades::sectors ? s : Shades::sectors - 1;
    const int b = static_cast<int>(z[k] * z_bins_per_1 + z_middle);
    bin[k] = b < 0 ? 0 : b > 63 ? 63 : b;
  }
}

struct Extent {
  double low, high;
};

TARMAC_VECTOR_LOOP Extent extent_of(std::size_t count, const double* __restrict values) {
  constexpr std::size_t lanes = 8;  // extremes of each lane, then of all: nothing that depends on an order
  double low[lanes], high[lanes];
  for (std::size_t l = 0; l < lanes; ++l) low[l] = high[l] = values[0];
  std::size_t k = 0;
  for (; k + lanes <= count; k += lanes)
    for (std::size_t l = 0; l < lanes; ++l) {
      const double v = values[k + l];
      low[l] = v < low[l] ? v : low[l];
      high[l] = v > high[l] ? v : high[l];
    }
  for (; k < count; ++k) {
    low[0] = values[k] < low[0] ? values[k] : low[0];
    high[0] = values[k] > high[0] ? values[k] : high[0];
  }
  for (std::size_t l = 1; l < lanes; ++l) {
    low[0] = low[l] < low[0] ? low[l] : low[0];
    high[0] = high[l] > high[0] ? high[l] : high[0];
  }
  return {low[0], high[0]};
}

}  // namespace

BatchBounds bounds_of(const Rays& rays, const Vector3d& base) {
  BatchBounds batch;
  if (rays.size() == 0) return batch;
  Vector3d low, high;
  const std::vector<double>* axes[3] = {&rays.ox, &rays.oy, &rays.oz};
  for (int k = 0; k < 3; ++k) {
    const Extent extent = extent_of(rays.size(), axes[k]->data());
    low[k] = extent.low;
    high[k] = extent.high;
  }
  const auto [first, last] = std::minmax_element(rays.t_ns.begin(), rays.t_ns.end());
  batch.centre_m = base + 0.5 * (low + high);
  batch.radius_m = 0.5 * (high - low).norm() + 1e-4;
  batch.t_first_ns = *first;
  batch.t_last_ns = *last;
  batch.sectors = 0;
  constexpr std::size_t block = SweepTracer::tile;
  for (std::size_t first_ray = 0; first_ray < rays.size(); first_ray += block) {
    alignas(64) float x[block] = {}, y[block] = {}, z[block] = {};
    alignas(64) int sector[block], bin[block];
    const std::size_t count = std::min(block, rays.size() - first_ray);
    for (std::size_t k = 0; k < count; ++k) {
      x[k] = static_cast<float>(rays.dx[first_ray + k]);
      y[k] = static_cast<float>(rays.dy[first_ray + k]);
    }
    bins_of(x, y, z, sector, bin);
    for (std::size_t k = 0; k < count; ++k) batch.sectors |= std::uint64_t{1} << sector[k];
  }
  return batch;
}

void Shades::clear() {
  all.clear();
  for (auto& list : in_sector) list.clear();
  z_bins.fill(0);
  tile = 0;
}

namespace {
TARMAC_VECTOR_LOOP void diamond_angles(const float* __restrict x, const float* __restrict y, float* __restrict angle) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < tile; ++k) {
    const float size = (x[k] < 0 ? -x[k] : x[k]) + (y[k] < 0 ? -y[k] : y[k]);
    const float a = y[k] / (size > 0 ? size : 1.0f);
    angle[k] = x[k] < 0 ? 2.0f - a : (a < 0 ? 4.0f + a : a);
  }
}
}  // namespace

void candidates_of(const RTCRay16& packed, const int* valid, Shades& shades, std::vector<std::uint32_t>& candidates) {
  candidates.clear();
  alignas(64) int sector[tile], bin[tile];
  bins_of(packed.dir_x, packed.dir_y, packed.dir_z, sector, bin);
  std::uint64_t sectors = 0, bins = 0;
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const std::uint64_t counts = valid[lane] != 0 ? 1 : 0;
    sectors |= counts << sector[lane];
    bins |= counts << bin[lane];
  }
  const std::uint32_t number = ++shades.tile;
  for (; sectors != 0; sectors &= sectors - 1) {
    const auto k = static_cast<std::size_t>(__builtin_ctzll(sectors));
    if ((shades.z_bins[k] & bins) == 0) continue;
    for (const std::uint32_t index : shades.in_sector[k]) {
      if ((shades.all[index].z_bins & bins) == 0 || shades.seen_by[index] == number) continue;
      shades.seen_by[index] = number;
      candidates.push_back(index);
    }
  }
}

TileView view_of(const RTCRay16& packed, const int* valid, const Rays& rays, const std::uint32_t* lanes) {
  alignas(64) float angles[tile];
  diamond_angles(packed.dir_x, packed.dir_y, angles);
  TileView view;
  bool first = true;
  std::int32_t t_first = 0, t_last = 0;
  for (std::size_t lane = 0; lane < tile; ++lane) {
    if (valid[lane] == 0) continue;
    const float z = packed.dir_z[lane];
    const std::int32_t t = rays.t_ns[lanes[lane]];
    if (first) {
      view = {0, 0, angles[lane], 0, 0, z, z};
      t_first = t_last = t;
      first = false;
      continue;
    }
    const float apart = wrapped(angles[lane] - view.angle);
    view.angle_low = std::min(view.angle_low, apart);
    view.angle_high = std::max(view.angle_high, apart);
    view.z_low = std::min(view.z_low, z);
    view.z_high = std::max(view.z_high, z);
    t_first = std::min(t_first, t);
    t_last = std::max(t_last, t);
  }
  view.t_first_ns = t_first;
  view.t_last_ns = t_last;
  return view;
}

void load_lanes(const TileView& view, const Vector3d& base, const Rays& rays, const std::uint32_t* lanes,
                LaneRays& loaded) {
  const double span_ns = view.t_last_ns - view.t_first_ns, per_ns = span_ns > 0 ? 1 / span_ns : 0;
  std::uint32_t used = lanes[0];
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const std::uint32_t i = lanes[lane] == SweepTracer::no_ray ? used : lanes[lane];
    used = i;
    loaded.ox[lane] = base.x() + rays.ox[i];
    loaded.oy[lane] = base.y() + rays.oy[i];
    loaded.oz[lane] = base.z() + rays.oz[i];
    loaded.dx[lane] = rays.dx[i], loaded.dy[lane] = rays.dy[i], loaded.dz[lane] = rays.dz[i];
    loaded.share[lane] = (rays.t_ns[i] - view.t_first_ns) * per_ns;
  }
}

namespace {

void set_frames(const MovingPart& part, const TileView& view, TileFrames& frames) {
  if (frames.t_first_ns == view.t_first_ns && frames.t_last_ns == view.t_last_ns) return;
  if (part.track.still() && frames.t_first_ns >= 0) return;
  entries_of(part.track.at(view.t_first_ns), frames.first);
  std::fill_n(frames.change, 12, 0.0);
  if (!part.track.still() && view.t_last_ns > view.t_first_ns) {
    entries_of(part.track.at(view.t_last_ns), frames.change);
    for (int k = 0; k < 12; ++k) frames.change[k] -= frames.first[k];
  }
  frames.t_first_ns = view.t_first_ns;
  frames.t_last_ns = view.t_last_ns;
}

}  // namespace

bool to_part(const MovingPart& part, Shade& shade, const TileView& view, const LaneRays& rays, const RTCRayHit16& world,
             RTCRayHit16& local, int* valid) {
  LaneFrames frames;
  const double span_ns = view.t_last_ns - view.t_first_ns;
  if (part.track.still() || span_ns <= straight_ns) {
    set_frames(part, view, shade.frames);
    blend(shade.frames.first, shade.frames.change, rays.share, frames.row);
  } else {
    for (std::size_t lane = 0; lane < tile; ++lane)
      set_lane(frames, lane, part.track.at(view.t_first_ns + rays.share[lane] * span_ns));
  }
  turn_rays(rays, frames.row, local.ray);
  std::copy_n(world.ray.tfar, tile, local.ray.tfar);
  meet_bounds(local.ray, part.bounds.low.data(), part.bounds.high.data(), valid);
  int any = 0;
  for (std::size_t lane = 0; lane < tile; ++lane) any |= valid[lane];
  if (any == 0) return false;
  std::fill_n(local.ray.tnear, tile, 0.0f);
  std::fill_n(local.ray.time, tile, 0.0f);
  std::fill_n(local.ray.mask, tile, ~0u);
  std::fill_n(local.ray.id, tile, 0u);
  std::fill_n(local.ray.flags, tile, 0u);
  std::fill_n(local.hit.geomID, tile, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(local.hit.instID[0], tile, RTC_INVALID_GEOMETRY_ID);
  return true;
}

}  // namespace tarmac::sim::raycast
