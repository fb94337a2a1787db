#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/sensor/calibration.h"
#include "io/sensor/plain.h"
#include "io/sensor/sweep_files.h"
#include "io/sensor/text_lines.h"

namespace tarmac::io {
namespace {

using core::ImuSample;
using core::LidarSweep;
using core::Time;

/// int32 nanoseconds reach this far from a sweep's begin.
constexpr double longest_t_s = 2.147;

struct Stamps {
  std::vector<Time> begin, end;
};

Stamps read_stamps(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    throw core::InputError(
        fmt::format("{}: missing; expected a line 'begin end' in integer ns for each sweep", file.string()));
  }
  Stamps stamps;
  TextLines lines(file, ' ');
  for (TextLine line; lines.next(line);) {
    if (line.fields.size() != 2) {
      line.fail(fmt::format("{} fields: expected 2 (begin and end of the sweep, integer ns)", line.fields.size()));
    }
    stamps.begin.push_back(core::time_from_ns(line.integer_at(0, "begin")));
    stamps.end.push_back(core::time_from_ns(line.integer_at(1, "end")));
    if (stamps.end.back() < stamps.begin.back()) line.fail("the sweep ends before it begins");
  }
  if (stamps.begin.empty()) throw core::InputError(fmt::format("{}: holds no sweep", file.string()));
  return stamps;
}

/// A point without a position may lack its time too: it stays in the sweep, at the sweep's begin.
std::int32_t point_time_ns(const std::filesystem::path& file, std::size_t i, const float* record) {
  const double t_s = record[4];
  if (std::abs(t_s) <= longest_t_s) return static_cast<std::int32_t>(std::llround(t_s * 1e9));
  const bool position = std::isfinite(record[0]) && std::isfinite(record[1]) && std::isfinite(record[2]);
  if (!position && !std::isfinite(t_s)) return 0;
  throw core::InputError(
      fmt::format("{}: point {}: t is {}: expected seconds since the sweep's begin, at most {}; is it "
                  "absolute or in another unit?",
                  file.string(), i, t_s, longest_t_s));
}

void read_points(const std::filesystem::path& file, LidarSweep& sweep) {
  const std::vector<float> records = read_float_records(file, 5, "x, y, z, intensity, t as float32");
  const std::size_t n = records.size() / 5;
  sweep.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const float* r = records.data() + 5 * i;
    sweep.push_back({r[0], r[1], r[2]}, point_time_ns(file, i, r), 0, r[3]);
  }
}

void read_rings(const std::filesystem::path& file, LidarSweep& sweep) {
  const std::vector<std::uint16_t> rings = read_uint16(file);
  if (rings.size() != sweep.size()) {
    throw core::InputError(fmt::format("{}: {} rings: expected {}, one a point of the .bin file", file.string(),
                                       rings.size(), sweep.size()));
  }
  sweep.ring = rings;
}

std::vector<ImuSample> read_imu(const std::filesystem::path& file) {
  static constexpr std::string_view header = "t_ns,gx,gy,gz,ax,ay,az";
  static constexpr const char* names[] = {"gx", "gy", "gz", "ax", "ay", "az"};
  std::vector<ImuSample> samples;
  TextLines lines(file, ',');
  TextLine line;
  if (!lines.next(line))
    throw core::InputError(fmt::format("{}: empty: expected the header {}", file.string(), header));
  if (line.text != header) line.fail(fmt::format("'{}': expected the header {}", line.text, header));
  while (lines.next(line)) {
    if (line.fields.size() != 7) line.fail(fmt::format("{} fields: expected 7 ({})", line.fields.size(), header));
    ImuSample sample;
    sample.t = core::time_from_ns(line.integer_at(0, "t_ns"));
    for (std::size_t k = 0; k < 3; ++k) {
      sample.gyro_rad_s[static_cast<Eigen::Index>(k)] = line.number_at(1 + k, names[k]);
      sample.accel_m_s2[static_cast<Eigen::Index>(k)] = line.number_at(4 + k, names[3 + k]);
    }
    samples.push_back(sample);
  }
  return samples;
}

/// Nothing is known but what the stamps tell: body = LiDAR frame, and the IMU's pose on it is not known.
core::Rig uncalibrated_rig(const Stamps& stamps, bool with_imu, const std::vector<ImuSample>& samples) {
  core::Rig rig;
  rig.calibrated = false;
  rig.lidars.resize(1);
  rig.lidars[0].model = "unknown";
  rig.lidars[0].sweep_rate_hz = rate_hz(stamps.begin, rig.lidars[0].sweep_rate_hz);
  if (with_imu) {
    std::vector<Time> times;
    for (const ImuSample& sample : samples) times.push_back(sample.t);
    rig.imus.resize(1);
    rig.imus[0].model = "unknown";
    rig.imus[0].rate_hz = rate_hz(times, 0);
  }
  return rig;
}

/// A ring file for every sweep or for none: a lost one must not read as ring 0.
bool has_rings(const std::filesystem::path& lidar, std::size_t sweeps) {
  if (count_numbered(lidar, ".ring") == 0) return false;
  check_count(lidar, ".ring", sweeps, lidar / "stamps.txt");
  return true;
}

/// One chunk a second, so that a reader need not take the whole run into memory.
void write_imu(core::RecordingWriter& writer, const std::vector<ImuSample>& samples) {
  std::size_t first = 0;
  for (std::size_t i = 1; i <= samples.size(); ++i) {
    const bool full = i == samples.size() || samples[i].t - samples[first].t >= std::chrono::seconds(1);
    if (!full) continue;
    writer.write(0, {samples.data() + first, i - first});
    first = i;
  }
}

}  // namespace

bool is_plain(const std::filesystem::path& folder) {
  const std::filesystem::path lidar = folder / "lidar";
  return std::filesystem::exists(lidar / "stamps.txt") || count_numbered(lidar, ".bin") > 0;
}

std::string import_plain(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress) {
  const std::filesystem::path lidar = folder / "lidar";
  const Stamps stamps = read_stamps(lidar / "stamps.txt");
  const std::size_t sweeps = stamps.begin.size();
  check_count(lidar, ".bin", sweeps, lidar / "stamps.txt");
  const bool rings = has_rings(lidar, sweeps);

  const bool with_imu = std::filesystem::exists(folder / "imu.csv");
  const std::vector<ImuSample> samples = with_imu ? read_imu(folder / "imu.csv") : std::vector<ImuSample>{};
  const std::filesystem::path calibration = folder / "calibration.yaml";
  const core::Rig rig = std::filesystem::exists(calibration) ? read_calibration(calibration, with_imu)
                                                             : uncalibrated_rig(stamps, with_imu, samples);

  core::RecordingWriter writer(recording_folder, rig);
  for (std::size_t k = 0; k < sweeps; ++k) {
    LidarSweep sweep;
    sweep.index = static_cast<std::int64_t>(k);
    sweep.begin = stamps.begin[k];
    sweep.end = stamps.end[k];
    read_points(lidar / numbered(k, ".bin"), sweep);
    if (rings) read_rings(lidar / numbered(k, ".ring"), sweep);
    writer.write(sweep);
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(sweeps), "sweeps");
  }
  if (with_imu) write_imu(writer, samples);
  return writer.finish();
}

}  // namespace tarmac::io
