#include "sim/lidar/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

Footprint::Footprint(const Profile& profile, int rays) : weight_{1} {
  for (const double angle : angles_around(rays)) {
    horizontal_rad_.push_back(0.5e-3 * profile.divergence_mrad[0] * offset * std::cos(angle));
    vertical_rad_.push_back(0.5e-3 * profile.divergence_mrad[1] * offset * std::sin(angle));
    weight_.push_back(std::exp(-ln_2 * offset * offset));
  }
  double sum = 0;
  for (const double w : weight_) sum += w;
  for (double& w : weight_) w /= sum;
}

BeamTable Footprint::table(const BeamTable& centre, std::size_t k) const {
  BeamTable result;
  for (std::size_t i = 0; i < centre.size(); ++i)
    result.push_back(turned_aside(beam_of(centre, i), horizontal_rad_[k], vertical_rad_[k]));
  return result;
}

std::uint8_t Footprint::sides(std::size_t k) const {
  const double horizontal = horizontal_rad_[k], vertical = vertical_rad_[k];
  constexpr double beside = 1e-9;  // sines of multiples of 180 degrees are not quite 0
  return static_cast<std::uint8_t>((horizontal > beside    ? side::left
                                    : horizontal < -beside ? side::right
                                                           : 0) |
                                   (vertical > beside    ? side::above
                                    : vertical < -beside ? side::below
                                                         : 0));
}

std::vector<Above> beams_above(const FiringTable& firing, const BeamTable& beams) {
  constexpr double same_row = 1e-4;
  std::vector<Above> above(beams.size());
  for (std::size_t c = 0; c < beams.size(); ++c) {
    double next = std::numeric_limits<double>::infinity();  // z of the next row
    for (const double z : beams.z)
      if (z > beams.z[c] + same_row) next = std::min(next, z);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t other = 0; other < beams.size(); ++other) {
      if (std::abs(beams.z[other] - next) > same_row) continue;
      const double lag = (azimuth_rad(beams, c) - azimuth_rad(beams, other)) / firing.step_rad(),
                   whole = std::round(lag);
      if (std::abs(lag - whole) >= nearest) continue;
      nearest = std::abs(lag - whole);
      above[c] = {static_cast<std::int64_t>(whole), static_cast<std::int32_t>(other)};
    }
  }
  return above;
}

std::vector<std::vector<Beside>> beams_beside(const FiringTable& firing, const BeamTable& beams,
                                              const Profile& profile) {
  constexpr double widths = 1.5, leak = 0.01;
  constexpr int channels_off = 2;
  std::vector<std::vector<Beside>> result(beams.size());
  if (profile.divergence_mrad.empty() || firing.beams_change()) return result;
  const double width = 1e-3 * std::max(profile.divergence_mrad[0], profile.divergence_mrad[1]), most = widths * width;
  for (std::size_t c = 0; c < beams.size(); ++c)
    for (std::size_t other = 0; other < beams.size(); ++other) {
      if (std::abs(static_cast<int>(firing.ring(other)) - static_cast<int>(firing.ring(c))) > channels_off) continue;
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
