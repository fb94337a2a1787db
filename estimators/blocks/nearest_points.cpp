#include "estimators/blocks/nearest_points.h"

#include <algorithm>
#include <stdexcept>

namespace tarmac::estimators {
namespace {

/// One axis of a query: index of and squared distance to the cells in reach, the farther ones of each pair at +k.
struct Axis {
  static constexpr int kMaxReach = 8;
  std::array<std::int32_t, 2 * kMaxReach + 1> index;
  std::array<double, 2 * kMaxReach + 1> distance2;

  Axis(double q, std::int32_t own, double cell, int reach) {
    const double above_face = q - own * cell, below_face = (own + 1) * cell - q;
    const int towards_near = above_face < below_face ? -1 : 1;
    const double near = std::max(0.0, std::min(above_face, below_face)), far = std::max(above_face, below_face);
    set(0, own, 0);
    for (int k = 1; k <= reach; ++k) {
      set(-k, own + towards_near * k, near + (k - 1) * cell);
      set(k, own - towards_near * k, far + (k - 1) * cell);
    }
  }
  void set(int step, std::int32_t i, double distance) {
    const auto slot = static_cast<std::size_t>(step + kMaxReach);
    index[slot] = i;
    distance2[slot] = distance * distance;
  }
  std::int32_t at(int step) const { return index[static_cast<std::size_t>(step + kMaxReach)]; }
  double d2(int step) const { return distance2[static_cast<std::size_t>(step + kMaxReach)]; }
};

/// Keeps the nearest in a sorted row: with twenty or so to keep, moving a few up is cheaper than a heap.
void keep(NearestPoints& found, int max_points, double d2, double dx, double dy, double dz) {
  int k = found.count < max_points ? found.count++ : max_points - 1;
  for (; k > 0 && found.distance2_m2[static_cast<std::size_t>(k - 1)] > d2; --k) {
    const auto to = static_cast<std::size_t>(k), from = to - 1;
    found.distance2_m2[to] = found.distance2_m2[from];
    found.x_m[to] = found.x_m[from];
    found.y_m[to] = found.y_m[from];
    found.z_m[to] = found.z_m[from];
  }
  const auto i = static_cast<std::size_t>(k);
  found.distance2_m2[i] = d2;
  found.x_m[i] = dx;
  found.y_m[i] = dy;
  found.z_m[i] = dz;
}

}  // namespace

NearestPointsFinder::NearestPointsFinder(const VoxelMap& map, const NearestSearch& search)
    : map_(map), search_(search) {
  if (search.max_points < 1 || search.max_points > NearestPoints::kCapacity || search.reach < 1 ||
      search.reach > Axis::kMaxReach) {
    throw std::invalid_argument("NearestSearch: 1 to 64 points, 1 to 8 voxels each way");
  }
  const int r = search.reach;
  for (int x = -r; x <= r; ++x) {
    for (int y = -r; y <= r; ++y) {
      for (int z = -r; z <= r; ++z) {
        cells_.push_back({static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), static_cast<std::int8_t>(z)});
      }
    }
  }
  // By the distance from a query in the middle between a cell's centre and its corner: a good order for any query.
  const auto cost = [](const Cell& c) {
    double sum = 0;
    for (const int step : {int{c.x}, int{c.y}, int{c.z}}) {
      const double d = step == 0 ? 0 : (step < 0 ? -step - 0.75 : step - 0.25);
      sum += d * d;
    }
    return sum;
  };
  std::stable_sort(cells_.begin(), cells_.end(), [&](const Cell& a, const Cell& b) { return cost(a) < cost(b); });
}

void NearestPointsFinder::find(const Eigen::Vector3d& query, NearestPoints& found) const {
  found.count = 0;
  const double cell = map_.voxel_size_m();
  if (!has_voxel(query, cell)) return;
  const Voxel own = voxel_of(query, cell);
  const Axis x(query.x(), own.x, cell, search_.reach), y(query.y(), own.y, cell, search_.reach),
      z(query.z(), own.z, cell, search_.reach);
  const double radius2 = search_.radius_m * search_.radius_m;
  // The slack covers rounding of the cells' faces.
  const double slack = 1e-9 * cell * cell;
  double bound2 = radius2;
  const double qx = query.x(), qy = query.y(), qz = query.z();
  for (const Cell& c : cells_) {
    if (x.d2(c.x) + y.d2(c.y) + z.d2(c.z) > bound2 + slack) continue;
    const VoxelMap::Points points = map_.points_in({x.at(c.x), y.at(c.y), z.at(c.z)});
    for (int k = 0; k < points.count; ++k) {
      const double dx = points.x_m[k] - qx, dy = points.y_m[k] - qy, dz = points.z_m[k] - qz;
      const double d2 = dx * dx + dy * dy + dz * dz;
      if (!(d2 < bound2 || (d2 <= radius2 && found.count < search_.max_points))) continue;
      keep(found, search_.max_points, d2, dx, dy, dz);
      if (found.count == search_.max_points) {
        bound2 = std::min(radius2, found.distance2_m2[static_cast<std::size_t>(search_.max_points - 1)]);
      }
    }
  }
}

}  // namespace tarmac::estimators
