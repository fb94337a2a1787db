#include "estimators/blocks/elastic_sampler.h"

#include <utility>

namespace tarmac::estimators {
namespace {

/// Fisher and Yates. A draw of 128 bits serves two exchanges; 64 bits against the few points of a sweep leave no bias
/// that could be seen.
void shuffle(std::vector<std::uint32_t>& items, const core::RandomStream& random, std::uint32_t sweep) {
  std::array<std::uint32_t, 4> bits{};
  for (std::size_t n = items.size(); n > 1; --n) {
    if (n % 2 == 0 || n == items.size()) bits = random.bits(n / 2, sweep);
    const std::size_t half = n % 2 == 0 ? 0 : 2;
    const std::uint64_t draw = (std::uint64_t{bits[half]} << 32) | bits[half + 1];
    const auto j = static_cast<std::size_t>((static_cast<unsigned __int128>(draw) * n) >> 64);
    std::swap(items[n - 1], items[j]);
  }
}

}  // namespace

ElasticSampler::ElasticSampler(std::int64_t seed)
    : choice_(static_cast<std::uint64_t>(seed), "ct-icp/sample"),
      order_(static_cast<std::uint64_t>(seed), "ct-icp/order"),
      keypoint_order_(static_cast<std::uint64_t>(seed), "ct-icp/keypoints") {}

void ElasticSampler::thin_out(const core::LidarSweep& sweep, const Limits& limits) {
  sweep_ = static_cast<std::uint32_t>(sweep.index);
  points_m_.resize(sweep.size());
  candidates_.clear();
  const double low2 = limits.min_range_m * limits.min_range_m, high2 = limits.max_range_m * limits.max_range_m;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    points_m_[i] = sweep.point(i);
    const double range2 = points_m_[i].squaredNorm();
    // Written so that NaN fails.
    if (range2 > low2 && range2 < high2) candidates_.push_back(static_cast<std::uint32_t>(i));
  }
  shuffle(candidates_, choice_, sweep_);
  sampler_.sample(points_m_, candidates_, limits.cell_m, sample_);
  shuffle(sample_, order_, sweep_);
}

void ElasticSampler::choose_keypoints(double cell_m) {
  sampler_.sample(points_m_, sample_, cell_m, keypoints_);
  // In the table's order, neighbouring cells may follow each other; a limited number shall come from everywhere.
  shuffle(keypoints_, keypoint_order_, sweep_);
}

}  // namespace tarmac::estimators
