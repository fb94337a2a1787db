/// Cells of a regular grid.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tarmac::estimators {

/// Index of a grid cell: the cell holds the points with floor(p / cell) equal to it, axis by axis.
struct Voxel {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// Cells are counted in 32 bits; beyond this index (half of what fits, so that neighbours fit as well) there is no
/// cell.
inline constexpr double kMaxVoxelIndex = 1 << 30;

/// floor of a value below kMaxVoxelIndex in magnitude. (Without SSE 4.1 std::floor is a call into the library, and this
/// stands in the innermost loops.)
inline std::int32_t floor_to_int(double value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < truncated ? 1 : 0);
}

/// False for points that are not finite or too far away to be counted in cells of that size.
inline bool has_voxel(const Eigen::Vector3d& p, double cell_m) {
  // A comparison with NaN is false.
  return p.cwiseAbs().maxCoeff() < cell_m * kMaxVoxelIndex && p.x() == p.x() && p.y() == p.y() && p.z() == p.z();
}

/// The cell of a point for which has_voxel holds. Divides rather than multiplies with the inverse: a point on a cell's
/// face belongs to the upper cell exactly.
inline Voxel voxel_of(const Eigen::Vector3d& p, double cell_m) {
  return {floor_to_int(p.x() / cell_m), floor_to_int(p.y() / cell_m), floor_to_int(p.z() / cell_m)};
}

/// Teschner et al., Optimized Spatial Hashing (2003), on 32-bit words.
inline std::uint32_t spatial_hash(const Voxel& v) {
  return (static_cast<std::uint32_t>(v.x) * 73856093U) ^ (static_cast<std::uint32_t>(v.y) * 19349669U) ^
         (static_cast<std::uint32_t>(v.z) * 83492791U);
}

}  // namespace tarmac::estimators
