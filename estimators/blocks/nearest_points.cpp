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

}  // namespace

NearestPointsFinder::NearestPointsFinder(const VoxelMap& map, const NearestSearch& search)
    : map_(map), settings_(search) {
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

int NearestPointsFinder::search(const Eigen::Vector3d& query, double radius2_m2, Candidate* kept) const {
  const double cell = map_.voxel_size_m();
  const Voxel own = voxel_of(query, cell);
  const Axis x(query.x(), own.x, cell, settings_.reach), y(query.y(), own.y, cell, settings_.reach),
      z(query.z(), own.z, cell, settings_.reach);
  // The slack covers rounding of the cells' faces.
  const double slack = 1e-9 * cell * cell;
  const double qx = query.x(), qy = query.y(), qz = query.z();
  const int wanted = settings_.max_points;
  double bound2 = radius2_m2;
  int count = 0;
  for (const Cell& c : cells_) {
    if (x.d2(c.x) + y.d2(c.y) + z.d2(c.z) > bound2 + slack) continue;
    const VoxelMap::Points points = map_.points_in({x.at(c.x), y.at(c.y), z.at(c.z)});
    for (int p = 0; p < points.count; ++p) {
      const double dx = points.x_m[p] - qx, dy = points.y_m[p] - qy, dz = points.z_m[p] - qz;
      const double d2 = dx * dx + dy * dy + dz * dz;
      // The radius itself is within; once enough are kept, only nearer ones count.
      if (!(d2 < bound2 || (count < wanted && d2 == bound2))) continue;
      // A sorted row: with twenty or so to keep, moving a few up is cheaper than a heap.
      int k = count < wanted ? count++ : wanted - 1;
      for (; k > 0 && kept[k - 1].distance2_m2 > d2; --k) kept[k] = kept[k - 1];
      kept[k] = {d2, points.x_m + p, points.y_m + p, points.z_m + p};
      if (count == wanted) bound2 = kept[wanted - 1].distance2_m2;
    }
  }
  return count;
}

void NearestPointsFinder::find(const Eigen::Vector3d& query, NearestPoints& found, double expected_m) const {
  found.count = 0;
  if (!has_voxel(query, map_.voxel_size_m())) return;
  std::array<Candidate, NearestPoints::kCapacity> kept;
  const double radius2 = settings_.radius_m * settings_.radius_m, expected2 = expected_m * expected_m;
  int count = 0;
  if (expected2 < radius2) count = search(query, expected2, kept.data());
  if (count < settings_.max_points) count = search(query, radius2, kept.data());
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    found.distance2_m2[k] = kept[k].distance2_m2;
    found.x_m[k] = *kept[k].x_m - query.x();
    found.y_m[k] = *kept[k].y_m - query.y();
    found.z_m[k] = *kept[k].z_m - query.z();
  }
  found.count = count;
}

}  // namespace tarmac::estimators
