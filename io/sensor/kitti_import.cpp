#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "io/sensor/plain.h"
#include "io/sensor/sweep_files.h"
#include "io/sensor/text_lines.h"

namespace tarmac::io {
namespace {

using core::LidarSweep;
using core::Time;

constexpr const char* derived_times = "point times derived from azimuth, clockwise from the rear";

std::vector<Time> read_times(const std::filesystem::path& file) {
  std::vector<Time> times;
  TextLines lines(file, ' ');
  for (TextLine line; lines.next(line);) {
    if (line.fields.size() != 1) line.fail(fmt::format("{} fields: expected 1 (seconds)", line.fields.size()));
    const Time t = line.seconds_at(0, "time");
    if (!times.empty() && t <= times.back())
      line.fail("time is not after the line before it: expected ascending times");
    times.push_back(t);
  }
  if (times.empty()) throw core::InputError(fmt::format("{}: holds no time: expected one a sweep", file.string()));
  return times;
}

/// A stamp stands for the middle of its sweep, when the sensor faces forward, so sweeps meet half way between stamps.
/// Boundary k begins sweep k; the first and the last sweep are as long as their neighbour's half on the inner side.
std::vector<Time> sweep_boundaries(const std::vector<Time>& times) {
  const std::size_t n = times.size();
  const auto half = [&](std::size_t k) { return n > 1 ? (times[k + 1] - times[k]) / 2 : core::Duration(50'000'000); };
  std::vector<Time> boundaries = {times.front() - half(0)};
  for (std::size_t k = 0; k + 1 < n; ++k) boundaries.push_back(times[k] + half(k));
  boundaries.push_back(times.back() + half(n > 1 ? n - 2 : 0));
  return boundaries;
}

/// 0 at the rear, 1/4 on the left, 1/2 ahead, towards 1 at the rear again. x forward, y left.
double turn_from_rear(float x_m, float y_m) {
  if (!std::isfinite(x_m) || !std::isfinite(y_m)) return 0;
  const double turn = 0.5 - std::atan2(static_cast<double>(y_m), static_cast<double>(x_m)) / (2 * std::numbers::pi);
  return std::clamp(turn, 0.0, 1.0);
}

LidarSweep read_sweep(const std::filesystem::path& file, std::size_t k, Time begin, Time next_begin) {
  const std::vector<float> records = read_float_records(file, 4, "x, y, z, reflectance as float32");
  LidarSweep sweep;
  sweep.index = static_cast<std::int64_t>(k);
  sweep.begin = begin;
  sweep.end = next_begin - core::Duration(1);  // the last firing comes before the next sweep's first
  const double span_ns = static_cast<double>((sweep.end - sweep.begin).count());
  sweep.reserve(records.size() / 4);
  for (std::size_t i = 0; i < records.size(); i += 4) {
    const float* r = records.data() + i;
    const auto t_ns = static_cast<std::int32_t>(std::llround(turn_from_rear(r[0], r[1]) * span_ns));
    sweep.push_back({r[0], r[1], r[2]}, t_ns, 0, r[3]);
  }
  return sweep;
}

void check_spans(const std::vector<Time>& boundaries, const std::filesystem::path& times_file) {
  for (std::size_t k = 1; k < boundaries.size(); ++k) {
    if (boundaries[k] - boundaries[k - 1] <= std::chrono::seconds(2)) continue;
    throw core::InputError(
        fmt::format("{}: times around line {} are more than 2 s apart: expected one sweep a line, each "
                    "shorter than that",
                    times_file.string(), k));
  }
}

}  // namespace

std::string import_kitti(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress) {
  const std::filesystem::path clouds = folder / "velodyne", times_file = folder / "times.txt";
  const std::vector<Time> times = read_times(times_file);
  check_count(clouds, ".bin", times.size(), times_file);
  const std::vector<Time> boundaries = sweep_boundaries(times);
  check_spans(boundaries, times_file);

  core::Rig rig;
  rig.calibrated = false;
  rig.lidars.resize(1);
  rig.lidars[0].model = fmt::format("unknown ({})", derived_times);
  rig.lidars[0].sweep_rate_hz = rate_hz(times, rig.lidars[0].sweep_rate_hz);
  core::RecordingWriter writer(recording_folder, rig);
  for (std::size_t k = 0; k < times.size(); ++k) {
    writer.write(read_sweep(clouds / numbered(k, ".bin"), k, boundaries[k], boundaries[k + 1]));
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(times.size()), derived_times);
  }
  return writer.finish();
}

}  // namespace tarmac::io
