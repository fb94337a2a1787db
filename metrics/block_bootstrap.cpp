#include "metrics/block_bootstrap.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "metrics/statistics.h"

namespace tarmac::metrics {

std::vector<std::vector<int>> block_bootstrap(std::size_t n, const BootstrapSettings& settings, std::string_view name) {
  std::vector<std::vector<int>> draws(settings.replicates, std::vector<int>(n, 0));
  if (n == 0) return draws;
  const core::RandomStream stream(1, name);
  const std::size_t block = std::clamp<std::size_t>(settings.block, 1, n), starts = n - block + 1;
  const std::size_t blocks = (n + block - 1) / block;
  for (std::size_t r = 0; r < settings.replicates; ++r) {
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto start =
          std::min(starts - 1, static_cast<std::size_t>(stream.uniform(r * blocks + b) * static_cast<double>(starts)));
      for (std::size_t i = start; i < start + block; ++i) ++draws[r][i];
    }
  }
  return draws;
}

Bootstrapped bootstrapped(double value, std::vector<double> replicates) {
  std::erase_if(replicates, [](double x) { return !std::isfinite(x); });
  Bootstrapped result{value, 0, value, value};
  if (replicates.size() < 2) return result;
  const double m = mean(replicates);
  double sum = 0;
  for (const double x : replicates) sum += (x - m) * (x - m);
  result.sigma = std::sqrt(sum / static_cast<double>(replicates.size() - 1));
  result.low = quantile(replicates, 0.025);
  result.high = quantile(replicates, 0.975);
  return result;
}

}  // namespace tarmac::metrics
