/// tarmac-estimate-placebo: tarmac-estimate with a recording that differs in nothing that matters. What its results
/// differ by from tarmac-estimate's is the noise of the comparison: a gate that calls it a regression is wrong.
///
/// The points of every sweep are given in another order (a permutation drawn from TARMAC_PLACEBO_SEED), and every point
/// of the first sweep is moved by one float32 step along each axis. A recording holds float32, so the 1e-9 m that one
/// would like to move it by cannot be written down: the step is 1e-9 m at a centimetre and 1e-6 m at ten metres.
///
/// It is a test's program: what it reads from the environment, tarmac-estimate does not know.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/random.h"
#include "core/recording.h"
#include "tools/estimate/program.h"

namespace {

using tarmac::core::InputError;
using tarmac::core::LidarSweep;
using tarmac::core::RandomStream;
using tarmac::core::Recording;
using tarmac::core::RecordingWriter;

std::uint64_t number_from_environment(const char* name) {
  const char* text = std::getenv(name);
  std::uint64_t number = 0;
  if (text) {
    const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
    if (error == std::errc() && *end == '\0') return number;
  }
  throw InputError(fmt::format("{}: expected a whole number in the environment, got {}", name,
                               text ? fmt::format("'{}'", text) : "nothing"));
}

/// How many points in a row may change places: all of the sweep, unless TARMAC_PLACEBO_BLOCK says so.
std::size_t block_size() {
  if (!std::getenv("TARMAC_PLACEBO_BLOCK")) return std::numeric_limits<std::size_t>::max();
  return std::max<std::size_t>(1, number_from_environment("TARMAC_PLACEBO_BLOCK"));
}

/// A permutation of 0..n-1 by Fisher and Yates, inside of blocks of `block` entries, with draws of their own for every
/// sweep.
std::vector<std::size_t> permutation(std::size_t n, std::size_t block, std::uint64_t seed, const LidarSweep& sweep) {
  const RandomStream draws(seed, fmt::format("placebo/order/{}/{}", sweep.sensor, sweep.index));
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i) {
    const std::size_t first = (i - 1) / block * block, choices = i - first;
    const auto j = static_cast<std::size_t>(draws.uniform(i) * static_cast<double>(choices));
    std::swap(order[i - 1], order[first + std::min(j, choices - 1)]);
  }
  return order;
}

template <class T>
void reorder(const std::vector<std::size_t>& order, std::vector<T>& values) {
  std::vector<T> moved(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) moved[i] = values[order[i]];
  values = std::move(moved);
}

LidarSweep perturbed(LidarSweep sweep, std::uint64_t seed, bool first) {
  const std::vector<std::size_t> order = permutation(sweep.size(), block_size(), seed, sweep);
  for (auto* axis : {&sweep.x_m, &sweep.y_m, &sweep.z_m}) {
    reorder(order, *axis);
    if (!first) continue;
    for (float& value : *axis) value = std::nextafter(value, std::numeric_limits<float>::infinity());
  }
  reorder(order, sweep.t_ns);
  reorder(order, sweep.ring);
  reorder(order, sweep.intensity);
  return sweep;
}

/// The changed recording lies beside the results while it is read, and is gone afterwards.
class Placebo {
 public:
  ~Placebo() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  Recording operator()(const Recording& recording, const std::filesystem::path& output) {
    const std::uint64_t seed = number_from_environment("TARMAC_PLACEBO_SEED");
    folder_ = output / "placebo-recording";
    RecordingWriter writer(folder_, recording.rig());
    for (std::size_t lidar = 0; lidar < recording.rig().lidars.size(); ++lidar)
      for (std::size_t i = 0; i < recording.sweep_count(lidar); ++i)
        writer.write(perturbed(recording.sweep(i, lidar), seed, i == 0));
    for (std::size_t imu = 0; imu < recording.rig().imus.size(); ++imu) writer.write(imu, recording.imu(imu));
    writer.finish();
    return Recording::open(folder_);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace

int main(int argc, char** argv) {
  Placebo placebo;
  return tarmac::tools::estimate_program(argc, argv, std::ref(placebo));
}
