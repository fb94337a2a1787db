/// A recording: what the sensors delivered, and the rig's data sheet; nothing of the truth.
///
/// A folder: manifest.json (written last: format version, data sheet, stream list, hash), and one chunk file per
/// stream: lidar<k>.chunks with one chunk a sweep, imu<k>.chunks with one chunk a second or so.
/// Content carries no scenario name, seed, label, object id, true range, initial pose or realised error.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/chunk_file.h"
#include "core/measurements.h"
#include "core/rig.h"

namespace tarmac::core {

class RecordingWriter {
 public:
  /// Creates the folder, or empties one that holds an earlier recording.
  RecordingWriter(const std::filesystem::path& folder, const Rig& rig);
  ~RecordingWriter();  ///< without finish() the folder has no manifest and is refused as incomplete

  /// A sweep as its chunk, ready to be packed on any thread.
  static ChunkData chunk(const LidarSweep& sweep);
  /// Sweeps of one sensor in order of their begin.
  void write(const LidarSweep& sweep);
  void write_packed(const LidarSweep& sweep, std::uint64_t digest, std::span<const std::byte> packed);
  void write(std::size_t imu, std::span<const ImuSample> samples);
  /// Returns the recording's hash: over decoded values of all streams and the data sheet, 16 hex digits.
  std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class Recording {
 public:
  /// Throws DamagedFile or InputError: no folder, no manifest (incomplete), another format version, a damaged stream.
  static Recording open(const std::filesystem::path& folder);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  const Rig& rig() const;
  const std::string& hash() const;
  std::size_t sweep_count(std::size_t lidar = 0) const;
  /// May be called from several threads.
  LidarSweep sweep(std::size_t i, std::size_t lidar = 0) const;
  /// As stamped, without reading the sweep.
  Time sweep_begin(std::size_t i, std::size_t lidar = 0) const;
  std::vector<ImuSample> imu(std::size_t k = 0) const;
  /// Calls back in order of availability: a sweep at its last firing, an IMU sample at its stamp, IMU first on ties.
  void replay(const std::function<void(std::size_t imu, const ImuSample&)>& on_imu,
              const std::function<void(const LidarSweep&)>& on_sweep) const;
  /// The same with other sweeps in place of the recorded ones: `count` of them, made one after the other.
  void replay(std::size_t count, const std::function<LidarSweep(std::size_t)>& sweep,
              const std::function<void(std::size_t imu, const ImuSample&)>& on_imu,
              const std::function<void(const LidarSweep&)>& on_sweep) const;

 private:
  Recording();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarmac::core
