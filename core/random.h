/// Random draws that have names: counter-based (Philox4x32-10, Salmon et al. 2011), so that the same draw comes out in
/// any order, on any thread, and adding an effect or a sensor changes no other's draws.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tarmac::core {

/// One named stream, such as {seed, "lidar0/range_noise"}. Stateless: draw i is a pure function of (seed, name, i).
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// 128 random bits for draw (i, j).
  std::array<std::uint32_t, 4> bits(std::uint64_t i, std::uint32_t j = 0) const;
  /// Uniform in (0, 1).
  double uniform(std::uint64_t i, std::uint32_t j = 0) const;
  /// Standard normal in double (Box-Muller).
  double normal(std::uint64_t i, std::uint32_t j = 0) const;
  /// Uniforms in (0, 1) and standard normals for draws first, first+1, ...: float, fast, own log and sincos, hence the
  /// same bytes on every machine. normals(first, out)[k] does not depend on how the range is cut into calls.
  void uniforms(std::uint64_t first, std::span<float> out) const;
  void normals(std::uint64_t first, std::span<float> out) const;

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint32_t name_hash_;
};

}  // namespace tarmac::core
