#include "sim/lidar/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;

constexpr double ln_2 = std::numbers::ln2;

Vector3d beam_of(const BeamTable& beams, std::size_t c) {
  return {beams.x[c], beams.y[c], beams.z[c]};
}

double azimuth_rad(const BeamTable& beams, std::size_t c) {
  return std::atan2(-beams.y[c], beams.x[c]);  // clockwise
}

/// A beam beside another, `horizontal` and `vertical` radians off.
Vector3d turned_aside(const Vector3d& beam, double horizontal, double vertical) {
  const Vector3d left = Vector3d(-beam.y(), beam.x(), 0).normalized(), up = beam.cross(left);
  return (beam + horizontal * left + vertical * up).normalized();
}

std::vector<double> angles_around(int rays) {
  if (rays == 1) return {};
  if (rays == 3) return {0, std::numbers::pi};
  std::vector<double> angles;
  for (int k = 0; k < rays - 1; ++k) angles.push_back(2 * std::numbers::pi * k / (rays - 1));
  return angles;
}

}  // namespace

Footprint make_footprint(const BeamTable& centre, const Profile& profile, int rays) {
  Footprint result;
  result.weight = {1};
  for (const double angle : angles_around(rays)) {
    const double horizontal = 0.5e-3 * profile.divergence_mrad[0] * Footprint::offset * std::cos(angle);
    const double vertical = 0.5e-3 * profile.divergence_mrad[1] * Footprint::offset * std::sin(angle);
    BeamTable table;
    for (std::size_t c = 0; c < centre.size(); ++c)
      table.push_back(turned_aside(beam_of(centre, c), horizontal, vertical));
    result.around.push_back(std::move(table));
    result.weight.push_back(std::exp(-ln_2 * Footprint::offset * Footprint::offset));
  }
  double sum = 0;
  for (const double w : result.weight) sum += w;
  for (double& w : result.weight) w /= sum;
  return result;
}

std::vector<Above> beams_above(const FiringTable& firing, const BeamTable& beams) {
  std::vector<std::size_t> order(beams.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return beams.z[a] < beams.z[b]; });
  std::vector<Above> above(beams.size());
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const std::size_t c = order[k], next = order[k + 1];
    const double lag_rad = azimuth_rad(beams, c) - azimuth_rad(beams, next);
    above[c] = {std::llround(lag_rad / firing.step_rad()), static_cast<std::int32_t>(next)};
  }
  return above;
}

std::vector<std::vector<Beside>> beams_beside(const FiringTable& firing, const BeamTable& beams,
                                              const Profile& profile) {
  constexpr double widths = 1.5, leak = 0.01;
  constexpr double channels_off = 2;
  std::vector<std::vector<Beside>> result(beams.size());
  if (profile.divergence_mrad.empty()) return result;
  const double width = 1e-3 * std::max(profile.divergence_mrad[0], profile.divergence_mrad[1]), most = widths * width;
  for (std::size_t c = 0; c < beams.size(); ++c)
    for (std::size_t other = 0; other < beams.size(); ++other) {
      if (std::abs(profile.ring[other] - profile.ring[c]) > channels_off) continue;
      const double up = std::asin(beams.z[other]) - std::asin(beams.z[c]);
      if (std::abs(up) > most) continue;
      const double flat = std::cos(std::asin(beams.z[c])), lag = azimuth_rad(beams, c) - azimuth_rad(beams, other);
      const auto low = static_cast<std::int64_t>(std::ceil((lag - most / flat) / firing.step_rad()));
      const auto high = static_cast<std::int64_t>(std::floor((lag + most / flat) / firing.step_rad()));
      for (std::int64_t k = low; k <= high; ++k) {
        if (k == 0 && other == c) continue;
        const double aside = (static_cast<double>(k) * firing.step_rad() - lag) * flat, angle = std::hypot(aside, up);
        if (angle > most) continue;
        const double share = leak * std::exp(-ln_2 * std::pow(2 * angle / width, 2));
        result[c].push_back({k, static_cast<std::int32_t>(other), static_cast<float>(share)});
      }
    }
  return result;
}

}  // namespace tarmac::sim::lidar
