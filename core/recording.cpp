#include "core/recording.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/files.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tarmac::core {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormatVersion = 1;

std::string lidar_file(std::size_t k) {
  return fmt::format("lidar{}.chunks", k);
}
std::string imu_file(std::size_t k) {
  return fmt::format("imu{}.chunks", k);
}

LidarSweep sweep_from_chunk(const ChunkData& data, const std::string& where) {
  LidarSweep sweep;
  const auto head = data.column<std::int64_t>(0);
  if (head.size() != 4)
    throw DamagedFile(fmt::format("{}: a sweep's head has {} values, 4 were expected", where, head.size()));
  sweep.index = head[0];
  sweep.begin = time_from_ns(head[1]);
  sweep.end = time_from_ns(head[2]);
  sweep.sensor = static_cast<std::uint16_t>(head[3]);
  sweep.x_m = data.column<float>(1);
  sweep.y_m = data.column<float>(2);
  sweep.z_m = data.column<float>(3);
  sweep.t_ns = data.column<std::int32_t>(4);
  sweep.ring = data.column<std::uint16_t>(5);
  sweep.intensity = data.column<float>(6);
  const std::size_t n = sweep.size();
  if (sweep.y_m.size() != n || sweep.z_m.size() != n || sweep.t_ns.size() != n || sweep.ring.size() != n ||
      sweep.intensity.size() != n) {
    throw DamagedFile(fmt::format("{}: a sweep's columns differ in length", where));
  }
  return sweep;
}

ChunkData imu_chunk(std::span<const ImuSample> samples) {
  std::vector<std::int64_t> t_ns;
  std::vector<double> columns[6];
  for (const ImuSample& s : samples) {
    t_ns.push_back(to_ns(s.t));
    for (int k = 0; k < 3; ++k) {
      columns[k].push_back(s.gyro_rad_s[k]);
      columns[3 + k].push_back(s.accel_m_s2[k]);
    }
  }
  ChunkData data;
  data.add<std::int64_t>(t_ns);
  for (const auto& column : columns) data.add<double>(column);
  return data;
}

void append_imu(std::vector<ImuSample>& out, const ChunkData& data, const std::string& where) {
  const auto t_ns = data.column<std::int64_t>(0);
  std::vector<double> columns[6];
  for (std::size_t k = 0; k < 6; ++k) {
    columns[k] = data.column<double>(k + 1);
    if (columns[k].size() != t_ns.size()) throw DamagedFile(fmt::format("{}: IMU columns differ in length", where));
  }
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    out.push_back({time_from_ns(t_ns[i]),
                   {columns[0][i], columns[1][i], columns[2][i]},
                   {columns[3][i], columns[4][i], columns[5][i]}});
  }
}

std::string recording_hash(const std::string& rig_json, const std::vector<std::uint64_t>& digests) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, rig_json.data(), rig_json.size());
  XXH3_64bits_update(&state, digests.data(), digests.size() * sizeof(std::uint64_t));
  return hex16(XXH3_64bits_digest(&state));
}

}  // namespace

struct RecordingWriter::State {
  std::filesystem::path folder;
  Rig rig;
  std::vector<std::unique_ptr<ChunkWriter>> lidars, imus;
};

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, const Rig& rig)
    : state_(std::make_unique<State>()) {
  state_->folder = folder;
  state_->rig = rig;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  // The manifest goes first: from here on the folder is no recording until finish() has written a new one.
  std::filesystem::remove(folder / "manifest.json", error);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".chunks") std::filesystem::remove(entry.path());
  }
  for (std::size_t k = 0; k < rig.lidars.size(); ++k) {
    state_->lidars.push_back(std::make_unique<ChunkWriter>(folder / lidar_file(k)));
  }
  for (std::size_t k = 0; k < rig.imus.size(); ++k) {
    state_->imus.push_back(std::make_unique<ChunkWriter>(folder / imu_file(k)));
  }
}

RecordingWriter::~RecordingWriter() = default;

ChunkData RecordingWriter::chunk(const LidarSweep& sweep) {
  ChunkData data;
  const std::int64_t head[4] = {sweep.index, to_ns(sweep.begin), to_ns(sweep.end), sweep.sensor};
  data.add<std::int64_t>(head);
  data.add<float>(sweep.x_m);
  data.add<float>(sweep.y_m);
  data.add<float>(sweep.z_m);
  data.add<std::int32_t>(sweep.t_ns);
  data.add<std::uint16_t>(sweep.ring);
  data.add<float>(sweep.intensity);
  return data;
}

void RecordingWriter::write(const LidarSweep& sweep) {
  const ChunkData data = chunk(sweep);
  write_packed(sweep, ChunkWriter::digest(data), ChunkWriter::pack(data));
}

void RecordingWriter::write_packed(const LidarSweep& sweep, std::uint64_t digest, std::span<const std::byte> packed) {
  state_->lidars.at(sweep.sensor)->append(sweep.begin, digest, packed);
}

void RecordingWriter::write(std::size_t imu, std::span<const ImuSample> samples) {
  if (samples.empty()) return;
  state_->imus.at(imu)->append(samples.front().t, imu_chunk(samples));
}

std::string RecordingWriter::finish() {
  std::vector<std::uint64_t> digests;
  Json streams = Json::array();
  const auto finish_stream = [&](ChunkWriter& writer, const std::string& file) {
    digests.push_back(writer.finish());
    streams.push_back({{"file", file}, {"digest", hex16(digests.back())}});
  };
  for (std::size_t k = 0; k < state_->lidars.size(); ++k) finish_stream(*state_->lidars[k], lidar_file(k));
  for (std::size_t k = 0; k < state_->imus.size(); ++k) finish_stream(*state_->imus[k], imu_file(k));
  const std::string rig_json = rig_to_json(state_->rig);
  const std::string hash = recording_hash(rig_json, digests);
  const Json manifest = {{"format", "tarmac-recording"},
                         {"version", kFormatVersion},
                         {"hash", hash},
                         {"streams", streams},
                         {"rig", Json::parse(rig_json)}};
  write_file(state_->folder / "manifest.json", manifest.dump(2) + "\n");
  return hash;
}

struct Recording::State {
  std::filesystem::path folder;
  Rig rig;
  std::string hash;
  std::vector<std::unique_ptr<ChunkReader>> lidars, imus;
};

Recording::Recording() : state_(std::make_unique<State>()) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

Recording Recording::open(const std::filesystem::path& folder) {
  const std::string name = folder.string();
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(
        fmt::format("{}: there is no such folder; a recording is made by `tarmac simulate` or `tarmac import`", name));
  }
  const std::filesystem::path manifest_file = folder / "manifest.json";
  if (!std::filesystem::exists(manifest_file)) {
    throw DamagedFile(fmt::format(
        "{}: no manifest.json, so the recording was never finished (or this is no recording); make it again", name));
  }
  Recording recording;
  State& state = *recording.state_;
  state.folder = folder;
  std::string rig_json;
  try {
    const Json manifest = Json::parse(read_file(manifest_file));
    if (manifest.value("format", "") != "tarmac-recording" || manifest.value("version", 0) != kFormatVersion) {
      throw InputError(fmt::format(
          "{}: format {} version {} is not tarmac-recording version {}; use the Tarmac that wrote it, or make it again",
          manifest_file.string(), manifest.value("format", "?"), manifest.value("version", 0), kFormatVersion));
    }
    state.hash = manifest.at("hash").get<std::string>();
    // The text that was hashed, not what a Rig would be written as: a rotation's last digit may change on the way.
    rig_json = manifest.at("rig").dump(2);
    state.rig = rig_from_json(rig_json, manifest_file.string());
  } catch (const nlohmann::json::exception& error) {
    throw DamagedFile(
        fmt::format("{}: cannot be read: {}; make the recording again", manifest_file.string(), error.what()));
  }
  std::vector<std::uint64_t> digests;
  const auto open_stream = [&](std::vector<std::unique_ptr<ChunkReader>>& readers, const std::string& file) {
    readers.push_back(std::make_unique<ChunkReader>(folder / file));
    digests.push_back(readers.back()->digest());
  };
  for (std::size_t k = 0; k < state.rig.lidars.size(); ++k) open_stream(state.lidars, lidar_file(k));
  for (std::size_t k = 0; k < state.rig.imus.size(); ++k) open_stream(state.imus, imu_file(k));
  if (recording_hash(rig_json, digests) != state.hash) {
    throw DamagedFile(
        fmt::format("{}: its streams do not match the hash in manifest.json; make the recording again", name));
  }
  return recording;
}

const Rig& Recording::rig() const {
  return state_->rig;
}
const std::string& Recording::hash() const {
  return state_->hash;
}

std::size_t Recording::sweep_count(std::size_t lidar) const {
  return lidar < state_->lidars.size() ? state_->lidars[lidar]->size() : 0;
}

LidarSweep Recording::sweep(std::size_t i, std::size_t lidar) const {
  return sweep_from_chunk(state_->lidars.at(lidar)->read(i), (state_->folder / lidar_file(lidar)).string());
}

std::vector<ImuSample> Recording::imu(std::size_t k) const {
  std::vector<ImuSample> samples;
  if (k >= state_->imus.size()) return samples;
  const ChunkReader& reader = *state_->imus[k];
  for (std::size_t i = 0; i < reader.size(); ++i) {
    append_imu(samples, reader.read(i), (state_->folder / imu_file(k)).string());
  }
  return samples;
}

Time Recording::sweep_begin(std::size_t i, std::size_t lidar) const {
  return state_->lidars.at(lidar)->time(i);
}

namespace {

/// IMU samples of one stream, a chunk at a time.
class ImuFeed {
 public:
  ImuFeed(const ChunkReader& reader, std::string name) : reader_(&reader), name_(std::move(name)) { fetch(); }
  bool more() const { return next_ < samples_.size(); }
  const ImuSample& front() const { return samples_[next_]; }
  void pop() {
    if (++next_ == samples_.size()) fetch();
  }

 private:
  void fetch() {
    next_ = 0;
    samples_.clear();
    while (samples_.empty() && chunk_ < reader_->size()) append_imu(samples_, reader_->read(chunk_++), name_);
  }
  const ChunkReader* reader_;
  std::string name_;
  std::vector<ImuSample> samples_;
  std::size_t next_ = 0, chunk_ = 0;
};

/// Sweeps of one stream, one ahead.
struct SweepFeed {
  std::size_t count;
  std::function<LidarSweep(std::size_t)> sweep;
  std::size_t next = 0;
  std::optional<LidarSweep> ahead = {};
  void fetch() {
    if (!ahead && next < count) ahead = sweep(next++);
  }
};

// Streams are merged in their stored order, also where stamps inside a stream go backwards: whoever consumes them must
// see the data as they were delivered.
void merge_streams(std::vector<SweepFeed>& lidars, std::vector<ImuFeed>& imus,
                   const std::function<void(std::size_t, const ImuSample&)>& on_imu,
                   const std::function<void(const LidarSweep&)>& on_sweep) {
  while (true) {
    SweepFeed* lidar = nullptr;
    for (SweepFeed& feed : lidars) {
      feed.fetch();
      if (feed.ahead && (!lidar || feed.ahead->end < lidar->ahead->end)) lidar = &feed;
    }
    std::size_t imu = imus.size();
    for (std::size_t k = 0; k < imus.size(); ++k)
      if (imus[k].more() && (imu == imus.size() || imus[k].front().t < imus[imu].front().t)) imu = k;
    const bool have_imu = imu < imus.size();
    if (!lidar && !have_imu) return;
    if (have_imu && (!lidar || imus[imu].front().t <= lidar->ahead->end)) {
      if (on_imu) on_imu(imu, imus[imu].front());
      imus[imu].pop();
    } else {
      if (on_sweep) on_sweep(*lidar->ahead);
      lidar->ahead.reset();
    }
  }
}

}  // namespace

void Recording::replay(const std::function<void(std::size_t, const ImuSample&)>& on_imu,
                       const std::function<void(const LidarSweep&)>& on_sweep) const {
  std::vector<SweepFeed> lidars;
  for (std::size_t k = 0; k < state_->lidars.size(); ++k)
    lidars.push_back({sweep_count(k), [this, k](std::size_t i) { return sweep(i, k); }});
  std::vector<ImuFeed> imus;
  for (std::size_t k = 0; k < state_->imus.size(); ++k)
    imus.emplace_back(*state_->imus[k], (state_->folder / imu_file(k)).string());
  merge_streams(lidars, imus, on_imu, on_sweep);
}

void Recording::replay(std::size_t count, const std::function<LidarSweep(std::size_t)>& sweep,
                       const std::function<void(std::size_t, const ImuSample&)>& on_imu,
                       const std::function<void(const LidarSweep&)>& on_sweep) const {
  std::vector<SweepFeed> lidars = {{count, sweep}};
  std::vector<ImuFeed> imus;
  for (std::size_t k = 0; k < state_->imus.size(); ++k)
    imus.emplace_back(*state_->imus[k], (state_->folder / imu_file(k)).string());
  merge_streams(lidars, imus, on_imu, on_sweep);
}

}  // namespace tarmac::core
