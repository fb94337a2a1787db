#include "core/random.h"

#include <Random123/philox.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/vector_loop.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define TARMAC_HAS_AVX2_FUNCTIONS
#endif

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tarmac::core {
namespace {

/// Last counter word: keeps the scalar draws and the two kinds of batches apart.
enum Kind : std::uint32_t { kScalar = 0, kUniforms = 1, kNormals = 2 };

using Philox = r123::Philox4x32;

Philox::ctr_type block(const std::array<std::uint32_t, 2>& key, std::uint32_t name_hash, std::uint64_t i,
                       std::uint32_t j, Kind kind) {
  const Philox::ctr_type counter = {{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i >> 32), j,
                                     name_hash + static_cast<std::uint32_t>(kind)}};
  return Philox()(counter, Philox::key_type{{key[0], key[1]}});
}

/// The middle of the 2^-32 wide cell: never 0; in float the topmost cells round to 1.
inline float unit_float(std::uint32_t bits) {
  return (static_cast<float>(bits) + 0.5f) * 0x1p-32f;
}

/// Natural logarithm of u in (0, 1] without libm, so that every machine has the same bits: u = 2^e m with m in
/// [sqrt(1/2), sqrt(2)), log m = 2 atanh z with z = (m - 1)/(m + 1), |z| < 0.172; the series' rest is below 3e-9.
inline float log_unit(float u) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(u);
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  const float z = (m - 1.0f) / (m + 1.0f), z2 = z * z;
  const float series = 1.0f + z2 * (1.0f / 3 + z2 * (1.0f / 5 + z2 * (1.0f / 7 + z2 * (1.0f / 9))));
  return static_cast<float>(exponent) * 0.693147182f + 2.0f * z * series;
}

/// cos and sin of a full turn times bits/2^32: the top two bits (after rounding) are the quadrant, the rest an angle in
/// [-pi/4, pi/4], where Taylor polynomials are exact to float.
inline void cos_sin_turn(std::uint32_t bits, float& c, float& s) {
  const std::uint32_t quadrant = (bits + 0x20000000u) >> 30;
  const float x = static_cast<float>(static_cast<std::int32_t>(bits - (quadrant << 30))) *
                  static_cast<float>(2 * std::numbers::pi * 0x1p-32);
  const float x2 = x * x;
  const float sin_x = x * (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
  const float cos_x = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  const bool swap = quadrant & 1u;
  const float a = swap ? sin_x : cos_x, b = swap ? cos_x : sin_x;
  c = (quadrant == 1 || quadrant == 2) ? -a : a;
  s = (quadrant >= 2) ? -b : b;
}

constexpr std::size_t kBatchBlocks = 64;  ///< blocks of four draws whose arithmetic is vectorised together

struct BlockRange {
  std::uint32_t key[2];
  std::uint32_t counter_low, counter_high, counter_name;  ///< of the first block; none carries into the upper word
  std::size_t blocks;
};

/// Philox over many blocks; of each, words 0 and 2 into `radius_bits` and words 1 and 3 into `angle_bits`.
void blocks_one_by_one(const BlockRange& range, std::size_t first, std::uint32_t* radius_bits,
                       std::uint32_t* angle_bits) {
  for (std::size_t k = first; k < range.blocks; ++k) {
    const Philox::ctr_type counter = {
        {range.counter_low + static_cast<std::uint32_t>(k), range.counter_high, 0, range.counter_name}};
    const auto b = Philox()(counter, Philox::key_type{{range.key[0], range.key[1]}});
    radius_bits[2 * k] = b[0];
    angle_bits[2 * k] = b[1];
    radius_bits[2 * k + 1] = b[2];
    angle_bits[2 * k + 1] = b[3];
  }
}

#ifdef TARMAC_HAS_AVX2_FUNCTIONS
/// The same bits, four blocks side by side: a word in the lower half of each 64-bit lane, what is above it ignored.
__attribute__((target("avx2"))) std::size_t blocks_by_fours(const BlockRange& range, std::uint32_t* radius_bits,
                                                            std::uint32_t* angle_bits) {
  const __m256i m0 = _mm256_set1_epi64x(PHILOX_M4x32_0), m1 = _mm256_set1_epi64x(PHILOX_M4x32_1);
  std::size_t k = 0;
  for (; k + 4 <= range.blocks; k += 4) {
    __m256i c0 = _mm256_add_epi32(_mm256_set1_epi64x(range.counter_low + static_cast<std::uint32_t>(k)),
                                  _mm256_set_epi64x(3, 2, 1, 0));
    __m256i c1 = _mm256_set1_epi64x(range.counter_high), c2 = _mm256_setzero_si256();
    __m256i c3 = _mm256_set1_epi64x(range.counter_name);
    std::uint32_t key0 = range.key[0], key1 = range.key[1];
    for (int round = 0; round < 10; ++round) {
      const __m256i p0 = _mm256_mul_epu32(c0, m0), p1 = _mm256_mul_epu32(c2, m1);
      c0 = _mm256_xor_si256(_mm256_srli_epi64(p1, 32), _mm256_xor_si256(c1, _mm256_set1_epi64x(key0)));
      c2 = _mm256_xor_si256(_mm256_srli_epi64(p0, 32), _mm256_xor_si256(c3, _mm256_set1_epi64x(key1)));
      c1 = p1;
      c3 = p0;
      key0 += PHILOX_W32_0;
      key1 += PHILOX_W32_1;
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(radius_bits + 2 * k),
                        _mm256_blend_epi32(c0, _mm256_slli_epi64(c2, 32), 0xaa));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(angle_bits + 2 * k),
                        _mm256_blend_epi32(c1, _mm256_slli_epi64(c3, 32), 0xaa));
  }
  return k;
}
#endif

void blocks_of(const BlockRange& range, std::uint32_t* radius_bits, std::uint32_t* angle_bits) {
  std::size_t done = 0;
#ifdef TARMAC_HAS_AVX2_FUNCTIONS
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  if (has_avx2) done = blocks_by_fours(range, radius_bits, angle_bits);
#endif
  blocks_one_by_one(range, done, radius_bits, angle_bits);
}

TARMAC_VECTOR_LOOP void box_muller(std::size_t pairs, const std::uint32_t* __restrict radius_bits,
                                   const std::uint32_t* __restrict angle_bits, float* __restrict draws) {
  for (std::size_t k = 0; k < pairs; ++k) {
    const float radius = std::sqrt(-2.0f * log_unit(unit_float(radius_bits[k])));
    float c, s;
    cos_sin_turn(angle_bits[k], c, s);
    draws[2 * k] = radius * c;
    draws[2 * k + 1] = radius * s;
  }
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  const std::uint64_t key = XXH3_64bits_withSeed(name.data(), name.size(), seed);
  key_ = {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
  name_hash_ = XXH32(name.data(), name.size(), 0x7a12ac00u);
}

std::array<std::uint32_t, 4> RandomStream::bits(std::uint64_t i, std::uint32_t j) const {
  const auto b = block(key_, name_hash_, i, j, kScalar);
  return {b[0], b[1], b[2], b[3]};
}

double RandomStream::uniform(std::uint64_t i, std::uint32_t j) const {
  const auto b = bits(i, j);
  const std::uint64_t wide = (static_cast<std::uint64_t>(b[0]) << 32) | b[1];
  return (static_cast<double>(wide >> 11) + 0.5) * 0x1p-53;
}

double RandomStream::normal(std::uint64_t i, std::uint32_t j) const {
  const auto b = bits(i, j);
  const std::uint64_t first = (static_cast<std::uint64_t>(b[0]) << 32) | b[1];
  const std::uint64_t second = (static_cast<std::uint64_t>(b[2]) << 32) | b[3];
  const double u = (static_cast<double>(first >> 11) + 0.5) * 0x1p-53;
  const double v = (static_cast<double>(second >> 11) + 0.5) * 0x1p-53;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

void RandomStream::uniforms(std::uint64_t first, std::span<float> out) const {
  for (std::size_t k = 0; k < out.size();) {
    const std::uint64_t draw = first + k;
    const auto b = block(key_, name_hash_, draw / 4, 0, kUniforms);
    for (std::size_t lane = draw % 4; lane < 4 && k < out.size(); ++lane, ++k) {
      out[k] = std::min(unit_float(b[lane]), 0x1.fffffep-1f);
    }
  }
}

void RandomStream::normals(std::uint64_t first, std::span<float> out) const {
  // Block k/4 holds draws 4(k/4) .. +3: two Box-Muller pairs. Whole blocks are made and the wanted part copied out.
  float draws[4 * kBatchBlocks];
  std::uint32_t radius_bits[2 * kBatchBlocks], angle_bits[2 * kBatchBlocks];
  std::size_t done = 0;
  while (done < out.size()) {
    const std::uint64_t first_block = (first + done) / 4, last_block = (first + out.size() - 1) / 4;
    const std::uint64_t before_carry = (std::uint64_t{1} << 32) - (first_block & 0xffffffffu);
    const std::size_t blocks = std::min<std::uint64_t>({kBatchBlocks, last_block - first_block + 1, before_carry});
    blocks_of({{key_[0], key_[1]},
               static_cast<std::uint32_t>(first_block),
               static_cast<std::uint32_t>(first_block >> 32),
               name_hash_ + kNormals,
               blocks},
              radius_bits, angle_bits);
    box_muller(2 * blocks, radius_bits, angle_bits, draws);
    const std::size_t skip = (first + done) % 4, take = std::min(4 * blocks - skip, out.size() - done);
    std::copy_n(draws + skip, take, out.begin() + static_cast<std::ptrdiff_t>(done));
    done += take;
  }
}

}  // namespace tarmac::core
