#include "scenes/actors/acceleration_table.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {
namespace {

constexpr double sample_s = 0.01;
constexpr int samples_per_cell = 5;
constexpr double cell_s = samples_per_cell * sample_s;
constexpr double spare = 1.05;

/// The largest of `values` about index k, with half the second difference for what lies between them.
double peak(const std::vector<double>& values, std::size_t k) {
  const double here = values[k];
  if (k == 0 || k + 1 >= values.size()) return here;
  return std::max({here, values[k - 1], values[k + 1]}) + 0.5 * std::abs(values[k - 1] - 2 * here + values[k + 1]);
}

}  // namespace

AccelerationTable::AccelerationTable(const Pose& pose, std::span<const Course::Span> moves) {
  for (const Course::Span& span : moves) stretches_.push_back(sampled(pose, span));
}

AccelerationTable::Stretch AccelerationTable::sampled(const Pose& pose, const Course::Span& span) const {
  // Two samples more on either side: the first and the last difference need neighbours.
  const double first_s = span.begin_s - 2 * sample_s;
  const auto count = static_cast<std::size_t>(std::ceil((span.end_s - span.begin_s) / sample_s)) + 6;
  std::vector<core::SE3> T(count);
  for (std::size_t k = 0; k < count; ++k) T[k] = pose(first_s + static_cast<double>(k) * sample_s);
  std::vector<double> origin(count, 0), rotation(count, 0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const Eigen::Vector3d a = (T[k + 1].translation() - 2 * T[k].translation() + T[k - 1].translation());
    const Eigen::Vector3d w0 = core::so3::log(T[k - 1].linear().transpose() * T[k].linear()) / sample_s;
    const Eigen::Vector3d w1 = core::so3::log(T[k].linear().transpose() * T[k + 1].linear()) / sample_s;
    origin[k] = a.norm() / (sample_s * sample_s);
    rotation[k] = (w1 - w0).norm() / sample_s + std::max(w0.squaredNorm(), w1.squaredNorm());
  }
  // Before t = 0 nobody asks, and an actor that is under way then has no pose: what comes after stands for it.
  std::size_t whole = 1;
  while (whole + 2 < count && first_s + static_cast<double>(whole - 1) * sample_s < 0) ++whole;
  std::fill_n(origin.begin(), whole, origin[whole]);
  std::fill_n(rotation.begin(), whole, rotation[whole]);
  Stretch stretch{span.begin_s, span.end_s, {}};
  for (std::size_t k = 2; k + 2 < count; k += samples_per_cell) {
    Cell cell{0, 0};
    for (std::size_t j = k - 1; j <= std::min(count - 2, k + samples_per_cell); ++j) {
      cell.origin_m_s2 = std::max(cell.origin_m_s2, static_cast<float>(spare * peak(origin, j)));
      cell.rotation_1_s2 = std::max(cell.rotation_1_s2, static_cast<float>(spare * peak(rotation, j)));
    }
    stretch.cells.push_back(cell);
  }
  return stretch;
}

double AccelerationTable::bound_m_s2(double t0_s, double t1_s, double radius_m) const {
  double bound = 0;
  for (const Stretch& stretch : stretches_) {
    if (t1_s < stretch.begin_s || t0_s > stretch.end_s) continue;
    const auto last = static_cast<std::ptrdiff_t>(stretch.cells.size()) - 1;
    const auto cell_at = [&](double t_s) {
      return std::clamp(static_cast<std::ptrdiff_t>(std::floor((t_s - stretch.begin_s) / cell_s)), std::ptrdiff_t{0},
                        last);
    };
    for (std::ptrdiff_t k = cell_at(t0_s); k <= cell_at(t1_s); ++k) {
      const Cell& cell = stretch.cells[static_cast<std::size_t>(k)];
      bound =
          std::max(bound, static_cast<double>(cell.origin_m_s2) + static_cast<double>(cell.rotation_1_s2) * radius_m);
    }
  }
  return bound;
}

}  // namespace tarmac::scenes
