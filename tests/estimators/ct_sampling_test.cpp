#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "estimators/blocks/elastic_sampler.h"
#include "tests/estimators/room_world.h"

namespace tarmac::estimators {
namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_of(const core::LidarSweep& sweep, std::uint32_t i, double cell_m) {
  const Voxel v = voxel_of(sweep.point(i), cell_m);
  return {v.x, v.y, v.z};
}

const ElasticSampler::Limits kLimits{.min_range_m = 0, .max_range_m = 100, .cell_m = 0.5};

TEST(ElasticSampler, KeepsOnePointOfEveryCellAndOneKeypointOfEveryLargeOne) {
  const core::LidarSweep sweep = tests::sweep_of(tests::Room(), 3, tests::still());
  ElasticSampler sampler(0);
  sampler.thin_out(sweep, kLimits);
  sampler.choose_keypoints(1.5);
  std::set<Cell> all, sampled, large, chosen;
  for (std::uint32_t i = 0; i < sweep.size(); ++i) all.insert(cell_of(sweep, i, 0.5));
  for (const std::uint32_t i : sampler.sample()) {
    EXPECT_TRUE(sampled.insert(cell_of(sweep, i, 0.5)).second);
    large.insert(cell_of(sweep, i, 1.5));
  }
  EXPECT_EQ(sampled, all);
  const std::set<std::uint32_t> sample(sampler.sample().begin(), sampler.sample().end());
  for (const std::uint32_t i : sampler.keypoints()) {
    EXPECT_TRUE(sample.contains(i));
    EXPECT_TRUE(chosen.insert(cell_of(sweep, i, 1.5)).second);
  }
  EXPECT_EQ(chosen, large);
}

TEST(ElasticSampler, DrawsAreNamedBySeedAndSweep) {
  core::LidarSweep sweep = tests::sweep_of(tests::Room(), 3, tests::still());
  const auto sample_of = [&](std::int64_t seed) {
    ElasticSampler sampler(seed);
    sampler.thin_out(sweep, kLimits);
    return sampler.sample();
  };
  const std::vector<std::uint32_t> first = sample_of(0);
  EXPECT_EQ(sample_of(0), first);
  EXPECT_NE(sample_of(1), first);
  sweep.index = 4;
  EXPECT_NE(sample_of(0), first);
}

// 16 points in one cell, 4,000 sweeps: 250 times each, give or take 15.3 (one sigma); five sigma pass.
TEST(ElasticSampler, EveryPointOfACellIsAsLikely) {
  core::LidarSweep sweep;
  for (int i = 0; i < 16; ++i) sweep.push_back({5.0F + 0.01F * static_cast<float>(i), 5, 5}, i, 0, 0);
  std::map<std::uint32_t, int> count;
  ElasticSampler sampler(0);
  for (sweep.index = 0; sweep.index < 4000; ++sweep.index) {
    sampler.thin_out(sweep, kLimits);
    ASSERT_EQ(sampler.sample().size(), 1U);
    ++count[sampler.sample()[0]];
  }
  ASSERT_EQ(count.size(), 16U);
  for (const auto& [point, n] : count) EXPECT_NEAR(n, 250, 77) << "point " << point;
}

TEST(ElasticSampler, RangeLimitsAreStrictAndNothingElseGetsThrough) {
  core::LidarSweep sweep;
  for (const float x : {1.0F, 2.0F, 50.0F, 100.0F, 120.0F, NAN}) sweep.push_back({x, 0, 0}, 0, 0, 0);
  ElasticSampler sampler(0);
  sampler.thin_out(sweep, {.min_range_m = 1, .max_range_m = 100, .cell_m = 0.5});
  std::vector<std::uint32_t> kept = sampler.sample();
  std::sort(kept.begin(), kept.end());
  EXPECT_EQ(kept, (std::vector<std::uint32_t>{1, 2}));
  sweep = {};
  sampler.thin_out(sweep, kLimits);
  sampler.choose_keypoints(1.5);
  EXPECT_TRUE(sampler.keypoints().empty());
}

}  // namespace
}  // namespace tarmac::estimators
