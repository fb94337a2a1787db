#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/merged_sweeps.h"
#include "io/sensor/calibration.h"
#include "io/sensor/plain.h"
#include "io/sensor/sweep_files.h"
#include "io/sensor/text_lines.h"

namespace tarmac::io {
namespace {

using core::LidarSweep;

/// A stamps file says that the folder is whole, so it goes first and comes back last.
void empty_plain_folder(const std::filesystem::path& folder) {
  make_folder(folder / "lidar");
  std::filesystem::remove(folder / "lidar" / "stamps.txt");
  remove_numbered(folder / "lidar", ".bin");
  remove_numbered(folder / "lidar", ".ring");
  std::filesystem::remove(folder / "imu.csv");
  std::filesystem::remove(folder / "calibration.yaml");
}

std::vector<float> plain_records(const LidarSweep& sweep) {
  std::vector<float> records;
  records.reserve(5 * sweep.size());
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    // Seconds as float32: half a step at 0.1 s is 3.7 ns, which is what this format loses.
    const float t_s = static_cast<float>(static_cast<double>(sweep.t_ns[i]) * 1e-9);
    records.insert(records.end(), {sweep.x_m[i], sweep.y_m[i], sweep.z_m[i], sweep.intensity[i], t_s});
  }
  return records;
}

std::string imu_csv(const std::vector<core::ImuSample>& samples) {
  std::string text = "t_ns,gx,gy,gz,ax,ay,az\n";
  for (const core::ImuSample& s : samples) {
    const Eigen::Vector3d &g = s.gyro_rad_s, &a = s.accel_m_s2;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n", core::to_ns(s.t), g.x(), g.y(), g.z(), a.x(),
                   a.y(), a.z());
  }
  return text;
}

void check_sensors(const core::Rig& rig, const char* format) {
  if (!rig.lidars.empty() && rig.imus.size() <= 1) return;
  throw core::InputError(fmt::format("{} holds one LiDAR and at most one IMU; the recording has {} and {}", format,
                                     rig.lidars.size(), rig.imus.size()));
}

/// What these formats take for the LiDAR's sweeps: of several LiDARs they are merged, in the body's frame.
class OneLidar {
 public:
  explicit OneLidar(const core::Recording& recording) : recording_(recording) {
    if (recording.rig().lidars.size() > 1) merged_.emplace(recording);
  }
  const core::Rig& rig() const { return merged_ ? merged_->rig() : recording_.rig(); }
  LidarSweep sweep(std::size_t k) const { return merged_ ? merged_->sweep(k) : recording_.sweep(k); }

 private:
  const core::Recording& recording_;
  std::optional<core::MergedSweeps> merged_;
};

void report(const core::Progress& progress, std::size_t done, std::size_t all) {
  if (progress) progress(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1)), "sweeps");
}

}  // namespace

void export_plain(const core::Recording& recording, const std::filesystem::path& folder,
                  const core::Progress& progress) {
  check_sensors(recording.rig(), "the plain format");
  const OneLidar lidar(recording);
  const core::Rig& rig = lidar.rig();
  empty_plain_folder(folder);
  // Without calibration nothing is claimed: reading the folder back then gives an uncalibrated rig again.
  if (rig.calibrated) core::write_file(folder / "calibration.yaml", calibration_text(rig));
  if (!rig.imus.empty()) core::write_file(folder / "imu.csv", imu_csv(recording.imu()));

  std::string stamps;
  for (std::size_t k = 0; k < recording.sweep_count(); ++k) {
    const LidarSweep sweep = lidar.sweep(k);
    core::write_file(folder / "lidar" / numbered(k, ".bin"), bytes_of(plain_records(sweep)));
    core::write_file(folder / "lidar" / numbered(k, ".ring"), bytes_of(sweep.ring));
    stamps += fmt::format("{} {}\n", core::to_ns(sweep.begin), core::to_ns(sweep.end));
    report(progress, k + 1, recording.sweep_count());
  }
  core::write_file(folder / "lidar" / "stamps.txt", stamps);
}

void export_kitti(const core::Recording& recording, const std::filesystem::path& folder,
                  const core::Progress& progress) {
  check_sensors(recording.rig(), "KITTI's layout");
  const OneLidar lidar(recording);
  const std::filesystem::path clouds = folder / "velodyne";
  make_folder(clouds);
  std::filesystem::remove(folder / "times.txt");
  remove_numbered(clouds, ".bin");

  std::string times;
  for (std::size_t k = 0; k < recording.sweep_count(); ++k) {
    const LidarSweep sweep = lidar.sweep(k);
    std::vector<float> records;
    records.reserve(4 * sweep.size());
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      records.insert(records.end(), {sweep.x_m[i], sweep.y_m[i], sweep.z_m[i], sweep.intensity[i]});
    }
    core::write_file(clouds / numbered(k, ".bin"), bytes_of(records));
    times += seconds_text(sweep.begin + (sweep.end - sweep.begin) / 2) + "\n";
    report(progress, k + 1, recording.sweep_count());
  }
  core::write_file(folder / "times.txt", times);
}

}  // namespace tarmac::io
