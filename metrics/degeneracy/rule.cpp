#include "metrics/degeneracy/rule.h"

#include <algorithm>

namespace tarmac::metrics {

const char* name_of(DegeneracyClass c) {
  constexpr std::array<const char*, 4> names{"ok", "weak", "degenerate", "unknown"};
  return names[static_cast<std::size_t>(c)];
}

DegeneracyRule DegeneracyRule::pose(double normal_noise_rad) {
  const double degenerate = std::max(1e-3, 4 * normal_noise_rad * normal_noise_rad);
  return {degenerate, std::max(1e-2, degenerate)};
}

DegeneracyRule DegeneracyRule::difference(double normal_noise_rad) {
  const double degenerate = std::max(5e-5, normal_noise_rad * normal_noise_rad / 3);
  return {degenerate, std::max(5e-4, degenerate)};
}

DegeneracyClass Classifier::operator()(const std::optional<double>& lambda_min) {
  if (!lambda_min) return last_ = DegeneracyClass::unknown;
  const bool was_degenerate = last_ == DegeneracyClass::degenerate;
  const bool was_weak = was_degenerate || last_ == DegeneracyClass::weak;
  if (*lambda_min < rule_.degenerate_below * (was_degenerate ? rule_.hysteresis : 1))
    last_ = DegeneracyClass::degenerate;
  else if (*lambda_min < rule_.weak_below * (was_weak ? rule_.hysteresis : 1))
    last_ = DegeneracyClass::weak;
  else
    last_ = DegeneracyClass::ok;
  return last_;
}

core::Vector6 weak_shares(const Spectrum& spectrum, double limit) {
  const double bound = spectrum.min() < limit ? limit : 2 * spectrum.min();
  core::Vector6 shares = core::Vector6::Zero();
  for (int i = 0; i < 6; ++i)
    if (spectrum.values[i] <= bound) shares += spectrum.vectors.col(i).cwiseAbs2();
  return shares;
}

std::string weak_directions(const core::Vector6& shares) {
  std::string text;
  for (int k = 0; k < 6; ++k) {
    if (shares[k] < 0.5) continue;
    if (!text.empty()) text += " + ";
    text += kDirectionNames[static_cast<std::size_t>(k)];
  }
  if (!text.empty()) return text;
  Eigen::Index largest = 0;
  shares.maxCoeff(&largest);
  return kDirectionNames[static_cast<std::size_t>(largest)];
}

}  // namespace tarmac::metrics
