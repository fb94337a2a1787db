#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace tarmac::core {
namespace {

/// All bounds below are 5 sigma or rarer (chance below 1e-6) of a right generator, with fixed seeds.
constexpr double five_sigma = 5;

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

std::vector<float> float_normals(const RandomStream& stream, std::size_t n, std::uint64_t first = 0) {
  std::vector<float> out(n);
  stream.normals(first, out);
  return out;
}

/// Largest distance between the sample's distribution and cdf, times sqrt(n): above 2.6 has chance 2.7e-6.
template <class T, class Cdf>
double kolmogorov_smirnov(std::vector<T> sample, const Cdf& cdf) {
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  double worst = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double p = cdf(static_cast<double>(sample[i]));
    worst = std::max({worst, std::abs(p - static_cast<double>(i) / n), std::abs(p - static_cast<double>(i + 1) / n)});
  }
  return worst * std::sqrt(n);
}
constexpr double ks_limit = 2.6;

template <class T>
void expect_standard_normal_moments(const std::vector<T>& x) {
  const double n = static_cast<double>(x.size());
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (const T value : x) {
    const double v = static_cast<double>(value);
    m1 += v / n;
    m2 += v * v / n;
    m3 += v * v * v / n;
    m4 += v * v * v * v / n;
  }
  // Variances of the powers of a standard normal: 1, 2, 15, 96.
  EXPECT_LT(std::abs(m1), five_sigma * std::sqrt(1 / n));
  EXPECT_LT(std::abs(m2 - 1), five_sigma * std::sqrt(2 / n));
  EXPECT_LT(std::abs(m3), five_sigma * std::sqrt(15 / n));
  EXPECT_LT(std::abs(m4 - 3), five_sigma * std::sqrt(96 / n));
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum / static_cast<double>(a.size());
}

TEST(RandomStream, FloatNormalsAreStandardNormal) {
  const std::vector<float> x = float_normals(RandomStream(1, "test/normals"), 1000000);
  expect_standard_normal_moments(x);
  EXPECT_LT(kolmogorov_smirnov(x, normal_cdf), ks_limit);
}

TEST(RandomStream, FloatNormalsHaveTheirTails) {
  const std::size_t n = 8000000;
  const std::vector<float> x = float_normals(RandomStream(2, "test/tails"), n);
  for (const double limit : {3.0, 4.0, 4.5, 5.0}) {
    for (const double sign : {-1.0, 1.0}) {
      const auto beyond = [&](float v) { return sign * static_cast<double>(v) > limit; };
      const double seen = static_cast<double>(std::count_if(x.begin(), x.end(), beyond));
      const double expected = static_cast<double>(n) * normal_cdf(-limit);
      EXPECT_NEAR(seen, expected, five_sigma * std::sqrt(expected)) << "beyond " << sign * limit;
    }
  }
  EXPECT_TRUE(std::all_of(x.begin(), x.end(), [](float v) { return std::isfinite(v); }));
}

TEST(RandomStream, FloatNormalsOfAPairAndOfNeighboursAreIndependent) {
  const std::size_t n = 1000000;
  const std::vector<float> x = float_normals(RandomStream(3, "test/pairs"), n);
  for (const std::size_t lag : {1u, 2u, 3u, 4u, 8u, 256u}) {
    std::vector<float> a(x.begin(), x.end() - static_cast<std::ptrdiff_t>(lag)),
        b(x.begin() + static_cast<std::ptrdiff_t>(lag), x.end());
    EXPECT_LT(std::abs(correlation(a, b)), five_sigma / std::sqrt(static_cast<double>(a.size()))) << lag;
    // Squares too: the two of a Box-Muller pair share their radius, whose square must not show.
    for (auto* v : {&a, &b}) std::for_each(v->begin(), v->end(), [](float& y) { y = y * y - 1; });
    EXPECT_LT(std::abs(correlation(a, b)), five_sigma * 2 / std::sqrt(static_cast<double>(a.size()))) << lag;
  }
}

TEST(RandomStream, ScalarDrawsAreStandardNormalAndUniform) {
  const RandomStream stream(4, "test/scalar");
  std::vector<double> normals, uniforms;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    normals.push_back(stream.normal(i));
    uniforms.push_back(stream.uniform(i, 1));
  }
  expect_standard_normal_moments(normals);
  EXPECT_LT(kolmogorov_smirnov(normals, normal_cdf), ks_limit);
  EXPECT_LT(kolmogorov_smirnov(uniforms, [](double u) { return u; }), ks_limit);
}

TEST(RandomStream, FloatUniformsFillTheOpenUnitInterval) {
  const RandomStream stream(5, "test/uniforms");
  std::vector<float> u(1000000);
  stream.uniforms(0, u);
  EXPECT_GT(*std::min_element(u.begin(), u.end()), 0.0f);
  EXPECT_LT(*std::max_element(u.begin(), u.end()), 1.0f);
  EXPECT_LT(kolmogorov_smirnov(u, [](double v) { return v; }), ks_limit);
  // Chi-squared over 1000 cells: mean 999, standard deviation sqrt(2 * 999).
  std::vector<double> cells(1000, 0);
  for (const float v : u) ++cells[static_cast<std::size_t>(v * 1000.0f) % 1000];
  double chi2 = 0;
  for (const double seen : cells) chi2 += (seen - 1000) * (seen - 1000) / 1000;
  EXPECT_NEAR(chi2, 999, five_sigma * std::sqrt(2 * 999.0));
}

TEST(RandomStream, DrawsDoNotDependOnHowTheRangeIsCut) {
  const RandomStream stream(6, "test/cuts");
  constexpr std::uint64_t first = 12345;
  constexpr std::size_t n = 2000;
  std::vector<float> whole(n), whole_uniforms(n);
  stream.normals(first, whole);
  stream.uniforms(first, whole_uniforms);
  for (const std::size_t cut : {1u, 2u, 3u, 5u, 7u, 64u, 255u, 256u, 257u, 1999u}) {
    std::vector<float> pieces(n), uniform_pieces(n);
    for (std::size_t at = 0; at < n; at += cut) {
      const std::size_t size = std::min(cut, n - at);
      stream.normals(first + at, std::span<float>(pieces).subspan(at, size));
      stream.uniforms(first + at, std::span<float>(uniform_pieces).subspan(at, size));
    }
    EXPECT_EQ(pieces, whole) << "cut into pieces of " << cut;
    EXPECT_EQ(uniform_pieces, whole_uniforms) << "cut into pieces of " << cut;
  }
}

TEST(RandomStream, AnEmptyRangeIsNothing) {
  const RandomStream stream(6, "test/empty");
  EXPECT_NO_THROW(stream.normals(3, {}));
  EXPECT_NO_THROW(stream.uniforms(3, {}));
}

TEST(RandomStream, DrawsFarOutAreDrawsLikeAnyOther) {
  const RandomStream stream(7, "test/far");
  const std::vector<float> x = float_normals(stream, 100000, 1ull << 40);
  expect_standard_normal_moments(x);
  // The index's high word counts: 2^34 draws = 2^32 blocks later comes another number.
  EXPECT_NE(float_normals(stream, 4, 0), float_normals(stream, 4, 1ull << 34));
  EXPECT_NE(stream.bits(0), stream.bits(1ull << 32));
}

TEST(RandomStream, SameSeedAndNameGiveTheSameDrawsAndOthersOthers) {
  const std::vector<float> x = float_normals(RandomStream(8, "lidar0/range_noise"), 1000);
  EXPECT_EQ(x, float_normals(RandomStream(8, "lidar0/range_noise"), 1000));
  EXPECT_NE(x, float_normals(RandomStream(9, "lidar0/range_noise"), 1000));
  EXPECT_NE(x, float_normals(RandomStream(8, "lidar1/range_noise"), 1000));
  EXPECT_NE(x, float_normals(RandomStream(8, "lidar0/dropout"), 1000));
}

TEST(RandomStream, StreamsThatDifferInNameOrSeedAreUncorrelated) {
  constexpr std::size_t n = 200000;
  const std::vector<float> x = float_normals(RandomStream(10, "imu0/gyro"), n);
  for (const RandomStream& other :
       {RandomStream(11, "imu0/gyro"), RandomStream(10, "imu1/gyro"), RandomStream(10, "imu0/gyrp")}) {
    EXPECT_LT(std::abs(correlation(x, float_normals(other, n))), five_sigma / std::sqrt(static_cast<double>(n)));
  }
}

TEST(RandomStream, ManyNamesAndSeedsHaveFirstDrawsThatAllDiffer) {
  std::set<std::array<std::uint32_t, 4>> seen;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (int k = 0; k < 100; ++k) seen.insert(RandomStream(seed, "sensor" + std::to_string(k)).bits(0));
  }
  EXPECT_EQ(seen.size(), 10000u);
}

TEST(RandomStream, KindsOfDrawDoNotShareBits) {
  const RandomStream stream(12, "test/kinds");
  constexpr std::size_t n = 200000;
  std::vector<float> uniforms(n);
  stream.uniforms(0, uniforms);
  for (float& u : uniforms) u = (u - 0.5f) * std::sqrt(12.0f);
  EXPECT_LT(std::abs(correlation(uniforms, float_normals(stream, n))), five_sigma / std::sqrt(static_cast<double>(n)));
  EXPECT_NE(stream.uniform(0, 0), stream.uniform(0, 1));
}

TEST(RandomStream, SingleDrawsAndBatchesAgreeAlsoAcrossTheCountersCarry) {
  // A single draw takes one block, which Random123's own code makes; a batch goes four blocks at a time, across the
  // carry into the counter's upper word too.
  const RandomStream stream(9, "test/batches");
  for (const std::uint64_t first : {0ull, 5ull, (1ull << 34) - 150, (1ull << 36) - 2}) {
    const std::vector<float> batch = float_normals(stream, 400, first);
    for (std::size_t k = 0; k < batch.size(); ++k)
      ASSERT_EQ(batch[k], float_normals(stream, 1, first + k)[0]) << first << " " << k;
  }
}

}  // namespace
}  // namespace tarmac::core
