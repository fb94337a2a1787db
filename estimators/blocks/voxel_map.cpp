#include "estimators/blocks/voxel_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tarmac::estimators {
namespace {

/// A neighbour voxel by axis: 0 the same, 1 across the nearer face, 2 across the farther one.
struct Step {
  std::uint8_t x, y, z;
};

/// The 26 neighbours, most promising first: a voxel's distance from the query grows along the list, roughly.
constexpr std::array<Step, 26> neighbour_steps() {
  std::array<Step, 26> steps{};
  std::size_t n = 0;
  for (int cost = 1; cost <= 6; ++cost) {
    for (std::uint8_t x = 0; x < 3; ++x) {
      for (std::uint8_t y = 0; y < 3; ++y) {
        for (std::uint8_t z = 0; z < 3; ++z) {
          if (x + y + z == cost) steps[n++] = {x, y, z};
        }
      }
    }
  }
  return steps;
}
constexpr std::array<Step, 26> kNeighbourSteps = neighbour_steps();

/// One axis of a query: where each of the three steps leads and the squared distance to that slab of voxels.
struct Axis {
  std::array<std::int32_t, 3> index;
  std::array<double, 3> distance2;

  Axis(double q, std::int32_t i, double cell) : index{}, distance2{} {
    const double below = q - i * cell, above = (i + 1) * cell - q;
    const bool nearer_below = below < above;
    const double near = std::max(0.0, std::min(below, above)), far = std::max(below, above);
    index = {i, nearer_below ? i - 1 : i + 1, nearer_below ? i + 1 : i - 1};
    distance2 = {0.0, near * near, far * far};
  }
};

bool adjacent(const Voxel& a, const Voxel& b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

}  // namespace

VoxelMap::VoxelMap(double voxel_size_m, int max_points) : VoxelMap(voxel_size_m, max_points, 0) {
  // Squared as it stands: rounding the root and squaring it again would move the bound.
  min_distance2_m2_ = voxel_size_m * voxel_size_m / max_points;
}

VoxelMap::VoxelMap(double voxel_size_m, int max_points, double min_distance_m)
    : voxel_size_m_(voxel_size_m),
      min_distance2_m2_(min_distance_m * min_distance_m),
      max_points_(max_points),
      capacity_((static_cast<std::size_t>(max_points) + 1) / 2 * 2),
      stride_(3 * capacity_),
      table_(1024) {}

std::size_t VoxelMap::home(const Voxel& v) const {
  // The spatial hash leaves patterns in its low bits; a multiplication carries all of them to the high ones.
  return (spatial_hash(v) * std::uint64_t{0x9E3779B97F4A7C15} >> 32) & (table_.size() - 1);
}

std::int32_t VoxelMap::find(const Voxel& v) const {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t slot = home(v);; slot = (slot + 1) & mask) {
    const Entry& entry = table_[slot];
    if (entry.block == kNone || entry.voxel == v) return entry.block;
  }
}

std::int32_t VoxelMap::insert_voxel(const Voxel& v) {
  if (2 * (voxel_count_ + 1) > table_.size()) grow();
  std::int32_t b = 0;
  if (free_.empty()) {
    b = static_cast<std::int32_t>(counts_.size());
    counts_.push_back(0);
    coordinates_.resize(coordinates_.size() + stride_);
    births_.resize(births_.size() + capacity_);
  } else {
    b = free_.back();
    free_.pop_back();
    counts_[static_cast<std::size_t>(b)] = 0;
  }
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = home(v);
  while (table_[slot].block != kNone) slot = (slot + 1) & mask;
  table_[slot] = {v, b};
  ++voxel_count_;
  return b;
}

void VoxelMap::grow() {
  std::vector<Entry> old(2 * table_.size());
  old.swap(table_);
  const std::size_t mask = table_.size() - 1;
  for (const Entry& entry : old) {
    if (entry.block == kNone) continue;
    std::size_t slot = home(entry.voxel);
    while (table_[slot].block != kNone) slot = (slot + 1) & mask;
    table_[slot] = entry;
  }
}

void VoxelMap::erase_entry(std::size_t hole) {
  // Backward shift: whoever was pushed beyond the hole and may sit in it moves up, so that no search stops short.
  const std::size_t mask = table_.size() - 1;
  for (std::size_t slot = (hole + 1) & mask; table_[slot].block != kNone; slot = (slot + 1) & mask) {
    const std::size_t pushed_by = (slot - home(table_[slot].voxel)) & mask;
    if (pushed_by >= ((slot - hole) & mask)) {
      table_[hole] = table_[slot];
      hole = slot;
    }
  }
  table_[hole].block = kNone;
}

Eigen::Vector3d VoxelMap::point(std::int32_t b, int k) const {
  const double* x = block(b) + k;
  return {x[0], x[capacity_], x[2 * capacity_]};
}

bool VoxelMap::too_near(std::int32_t b, const Eigen::Vector3d& p) const {
  for (int k = 0; k < counts_[static_cast<std::size_t>(b)]; ++k) {
    if ((point(b, k) - p).squaredNorm() < min_distance2_m2_) return true;
  }
  return false;
}

bool VoxelMap::add(const Eigen::Vector3d& p, std::int32_t birth) {
  if (!has_voxel(p, voxel_size_m_)) return false;
  const Voxel voxel = voxel_of(p, voxel_size_m_);
  std::int32_t b = find(voxel);
  if (b == kNone) {
    b = insert_voxel(voxel);
  } else if (counts_[static_cast<std::size_t>(b)] == max_points_ || too_near(b, p)) {
    return false;
  }
  births_[static_cast<std::size_t>(b) * capacity_ + static_cast<std::size_t>(counts_[static_cast<std::size_t>(b)])] =
      birth;
  double* x = block(b) + counts_[static_cast<std::size_t>(b)]++;
  x[0] = p.x();
  x[capacity_] = p.y();
  x[2 * capacity_] = p.z();
  return true;
}

void VoxelMap::remove_far(const Eigen::Vector3d& centre, double radius_m) {
  const double radius2 = radius_m * radius_m;
  for (std::size_t slot = 0; slot < table_.size();) {
    const std::int32_t b = table_[slot].block;
    if (b == kNone || (point(b, 0) - centre).squaredNorm() < radius2) {
      ++slot;
      continue;
    }
    free_.push_back(b);
    --voxel_count_;
    erase_entry(slot);  // may have moved another entry into this slot: look at it again
  }
}

void VoxelMap::search_block(std::int32_t b, const Eigen::Vector3d& q, Neighbour& best) const {
  const int count = counts_[static_cast<std::size_t>(b)];
  const double *x = block(b), *y = x + capacity_, *z = y + capacity_;
  int nearest = -1;
  for (int k = 0; k < count; ++k) {
    const double dx = x[k] - q.x(), dy = y[k] - q.y(), dz = z[k] - q.z();
    const double distance2 = dx * dx + dy * dy + dz * dz;
    if (distance2 < best.distance2_m2) {
      best.distance2_m2 = distance2;
      nearest = k;
    }
  }
  if (nearest < 0) return;
  best.found = true;
  best.point = point(b, nearest);
}

VoxelMap::Neighbour VoxelMap::nearest(const Eigen::Vector3d& q, double below_m2, const Eigen::Vector3d* hint) const {
  Neighbour best;
  best.distance2_m2 = below_m2;
  if (!has_voxel(q, voxel_size_m_)) return best;
  const Voxel own = voxel_of(q, voxel_size_m_);
  if (hint != nullptr && adjacent(own, voxel_of(*hint, voxel_size_m_))) {
    const double distance2 = (*hint - q).squaredNorm();
    if (distance2 < below_m2) best = {true, distance2, *hint};
  }
  if (const std::int32_t b = find(own); b != kNone) search_block(b, q, best);
  const Axis x(q.x(), own.x, voxel_size_m_), y(q.y(), own.y, voxel_size_m_), z(q.z(), own.z, voxel_size_m_);
  // A voxel whose nearest corner is no nearer than the best so far holds nothing better. The slack covers rounding of
  // the voxels' faces.
  const double slack = 1e-9 * voxel_size_m_ * voxel_size_m_;
  for (const Step step : kNeighbourSteps) {
    if (x.distance2[step.x] + y.distance2[step.y] + z.distance2[step.z] > best.distance2_m2 + slack) continue;
    const std::int32_t b = find({x.index[step.x], y.index[step.y], z.index[step.z]});
    if (b != kNone) search_block(b, q, best);
  }
  return best;
}

void VoxelMap::gather(const Eigen::Vector3d& q, double radius_m, std::int32_t latest_birth,
                      std::vector<Eigen::Vector3d>& points) const {
  if (!has_voxel(q, voxel_size_m_)) return;
  const Voxel own = voxel_of(q, voxel_size_m_);
  for (std::int32_t dx = -1; dx <= 1; ++dx) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dz = -1; dz <= 1; ++dz) {
        const std::int32_t b = find({own.x + dx, own.y + dy, own.z + dz});
        if (b == kNone) continue;
        const std::int32_t* births = births_.data() + static_cast<std::size_t>(b) * capacity_;
        // In order of birth: the rest of the voxel is younger still.
        for (int k = 0; k < counts_[static_cast<std::size_t>(b)] && births[k] <= latest_birth; ++k) {
          const Eigen::Vector3d p = point(b, k);
          if ((p - q).squaredNorm() < radius_m * radius_m) points.push_back(p);
        }
      }
    }
  }
}

std::vector<std::vector<Eigen::Vector3d>> VoxelMap::voxels() const {
  std::vector<std::vector<Eigen::Vector3d>> all;
  for (const Entry& entry : table_) {
    if (entry.block == kNone) continue;
    std::vector<Eigen::Vector3d>& points = all.emplace_back();
    for (int k = 0; k < counts_[static_cast<std::size_t>(entry.block)]; ++k) points.push_back(point(entry.block, k));
  }
  return all;
}

}  // namespace tarmac::estimators
