// The part of the pictures that is arithmetic: rectangles, scales, colours.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "reports/stills.h"

namespace tarmac::reports {

namespace {

/// The largest of 1, 2, 5 x 10^n that is <= value (direction -1), or the smallest >= value (+1).
double round_125(double value, int direction) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  const double steps[] = {1, 2, 5, 10};
  const double slack = 1e-9;
  if (direction > 0) {
    for (const double step : steps) {
      if (step * decade >= value * (1 - slack)) return step * decade;
    }
    return 10 * decade;
  }
  double best = decade;
  for (const double step : steps) {
    if (step * decade <= value * (1 + slack)) best = step * decade;
  }
  return best;
}

double quantile(std::vector<double>& values, double share) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

Eigen::Vector3d point_from(const std::string& option, const std::string& text) {
  Eigen::Vector3d point;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int k = 0; k < 3; ++k) {
    const auto [rest, error] = std::from_chars(at, end, point[k]);
    const bool ends_well = k < 2 ? rest != end && *rest == ',' : rest == end;
    if (error != std::errc{} || !ends_well || !std::isfinite(point[k])) {
      throw core::InputError(
          fmt::format("{} {}: expected three numbers in metres with commas and no blanks between, such as 12,-30,1.7",
                      option, text));
    }
    at = k < 2 ? rest + 1 : rest;
  }
  return point;
}

void check(const EyeView& view) {
  if (!((view.look_at_m - view.eye_m).norm() >= 1e-3))
    throw core::InputError("--eye and --look-at are the same place: move one of them by a millimetre or more");
  if (view.eye_m.cwiseAbs().maxCoeff() > 1e5 || view.look_at_m.cwiseAbs().maxCoeff() > 1e5)
    throw core::InputError("--eye, --look-at: more than 100 km away from the origin, where no scene reaches");
  if (!(view.height_deg > 0 && view.height_deg < 180))
    throw core::InputError(fmt::format("height_deg {}: expected an angle between 0 and 180", view.height_deg));
}

TopView top_view(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, int width_px) {
  const double m_per_px = (max_m.x() - min_m.x()) / width_px;
  const int height_px = std::max(1, static_cast<int>(std::lround((max_m.y() - min_m.y()) / m_per_px)));
  const double middle_y_m = 0.5 * (min_m.y() + max_m.y()), half_m = 0.5 * m_per_px * height_px;
  return {{min_m.x(), middle_y_m - half_m}, {max_m.x(), middle_y_m + half_m}, width_px, height_px};
}

ErrorScale error_scale(const std::vector<const metrics::MapSample*>& maps) {
  std::vector<double> lows_m, highs_m;
  for (const auto* map : maps) {
    std::vector<double> errors_m;
    for (std::size_t i = 0; i < map->error_m.size(); ++i) {
      const bool moving = i < map->moving.size() && map->moving[i];
      if (!moving && std::isfinite(map->error_m[i])) errors_m.push_back(map->error_m[i]);
    }
    if (errors_m.empty()) continue;
    lows_m.push_back(quantile(errors_m, 0.25));
    highs_m.push_back(quantile(errors_m, 0.99));
  }
  if (lows_m.empty()) return {};
  const double smallest_m = 1e-6;  // a replay of the truth has errors of 0, which no logarithm takes
  const double low_m = round_125(std::max(smallest_m, quantile(lows_m, 0.5)), -1);
  const double high_m = round_125(std::max(smallest_m, quantile(highs_m, 0.5)), +1);
  return {std::min(low_m, high_m / 10), high_m};
}

double place_on(const ErrorScale& scale, double error_m) {
  if (std::isnan(error_m)) return error_m;
  if (error_m <= scale.low_m) return 0;
  return std::min(1.0, std::log(error_m / scale.low_m) / std::log(scale.high_m / scale.low_m));
}

Eigen::Vector3f error_color(double place) {
  if (std::isnan(place)) return {0.5f, 0.5f, 0.5f};
  // From a calm blue over green and yellow to orange-red: ordered for every kind of colour vision, and bright enough on
  // the dark ground of the maps. Knots are sRGB; between them straight lines.
  static const Eigen::Vector3f knots[] = {{0.227f, 0.369f, 0.659f}, {0.180f, 0.545f, 0.659f}, {0.353f, 0.702f, 0.573f},
                                          {0.725f, 0.820f, 0.443f}, {0.992f, 0.820f, 0.376f}, {0.969f, 0.549f, 0.259f},
                                          {0.886f, 0.282f, 0.251f}};
  constexpr int kLast = static_cast<int>(std::size(knots)) - 1;
  const double x = std::clamp(place, 0.0, 1.0) * kLast;
  const int below = std::min(static_cast<int>(x), kLast - 1);
  const float share = static_cast<float>(x - below);
  return (1 - share) * knots[below] + share * knots[below + 1];
}

}  // namespace tarmac::reports
