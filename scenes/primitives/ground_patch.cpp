#include "scenes/primitives/ground_patch.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

void add_ground_patch(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                      double cell_m, double lift_m) {
  const auto cells = [&](int axis) {
    return std::max(1, static_cast<int>(std::ceil((high[axis] - low[axis]) / cell_m - 1e-9)));
  };
  const int nx = cells(0), ny = cells(1);
  std::vector<std::uint32_t> grid;
  grid.reserve(static_cast<std::size_t>((nx + 1) * (ny + 1)));
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double x = low.x() + (high.x() - low.x()) * i / nx, y = low.y() + (high.y() - low.y()) * j / ny;
      grid.push_back(b.vertex({x, y, ground.height_m(x, y) + lift_m}));
    }
  }
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (nx + 1) + i)]; };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      if ((i + j) % 2 == 0) {
        b.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      } else {
        b.quad(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), at(i, j));
      }
    }
  }
}

}  // namespace tarmac::scenes
