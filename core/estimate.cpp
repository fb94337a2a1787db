// trajectory.bin is a chunk file (docs/formats.md): a head chunk, then one chunk a segment of `causal` and of `final`,
// then one chunk of sweep results.
#include "core/estimate.h"

#include <fmt/format.h>

#include <cmath>

#include "core/chunk_file.h"
#include "core/error.h"

namespace tarmac::core {
namespace {

constexpr std::int64_t kFormatVersion = 2;
constexpr std::size_t kPoseValues = 12;  ///< rotation column by column, then translation

void append_pose(std::vector<double>& out, const SE3& T) {
  // Copies: the blocks of the 4x4 that a pose is stored in are not contiguous.
  const Eigen::Matrix3d R = T.linear();
  const Eigen::Vector3d p = T.translation();
  out.insert(out.end(), R.data(), R.data() + 9);
  out.insert(out.end(), p.data(), p.data() + 3);
}

SE3 pose_at(const std::vector<double>& values, std::size_t i) {
  SE3 T = SE3::Identity();
  T.linear() = Eigen::Map<const Eigen::Matrix3d>(values.data() + i * kPoseValues);
  T.translation() = Eigen::Map<const Eigen::Vector3d>(values.data() + i * kPoseValues + 9);
  return T;
}

ChunkData segment_chunk(const Segment& segment) {
  ChunkData data;
  data.add_value(static_cast<std::uint8_t>(segment.model));
  const std::int64_t span[2] = {to_ns(segment.t0), to_ns(segment.t1)};
  data.add<std::int64_t>(span);
  std::vector<double> poses;
  for (const SE3& T : segment.poses) append_pose(poses, T);
  data.add<double>(poses);
  std::vector<std::int64_t> times;
  for (const Time t : segment.times) times.push_back(to_ns(t));
  data.add<std::int64_t>(times);
  std::vector<double> twists;
  for (const Vector6& twist : segment.twists) twists.insert(twists.end(), twist.data(), twist.data() + 6);
  data.add<double>(twists);
  return data;
}

/// How many poses and twists a model of so many times has; splines: any order from 4 to 6.
bool fits(const Segment& segment) {
  const std::size_t poses = segment.poses.size(), times = segment.times.size(), twists = segment.twists.size();
  switch (segment.model) {
    case SegmentModel::two_pose_slerp:
    case SegmentModel::two_pose_screw:
      return poses == 2 && times == 0 && twists == 0;
    case SegmentModel::held:
      return poses == 1 && times == 0 && twists == 0;
    case SegmentModel::sampled_screw:
    case SegmentModel::sampled_slerp:
    case SegmentModel::sampled_hold:
      return poses >= 1 && poses == times && twists == 0;
    case SegmentModel::spline_split:
    case SegmentModel::spline_se3:
      return times >= poses + 4 && times <= poses + 6 && 2 * poses >= times && twists == 0;
    case SegmentModel::gp_wnoa:
      return poses >= 2 && poses == times && twists == poses;
    case SegmentModel::gp_wnoj:
      return poses >= 2 && poses == times && twists == 2 * poses;
    case SegmentModel::gp_singer:
      return poses >= 2 && poses == times && twists == 2 * poses + 1;
  }
  return false;
}

Segment segment_from_chunk(const ChunkData& data, const std::string& where) {
  const auto fail = [&](const char* what) { throw DamagedFile(fmt::format("{}: a segment {}", where, what)); };
  Segment segment;
  const std::uint8_t model = data.value<std::uint8_t>(0);
  if (model < 1 || model > 11) fail("has an unknown model");
  segment.model = static_cast<SegmentModel>(model);
  const auto span = data.column<std::int64_t>(1);
  const auto values = data.column<double>(2);
  if (span.size() != 2 || values.empty() || values.size() % kPoseValues != 0) fail("has a wrong shape");
  for (const double value : values) {
    if (!std::isfinite(value)) fail("has a pose that is not finite");
  }
  segment.t0 = time_from_ns(span[0]);
  segment.t1 = time_from_ns(span[1]);
  for (std::size_t i = 0; i < values.size() / kPoseValues; ++i) segment.poses.push_back(pose_at(values, i));
  for (const std::int64_t t_ns : data.column<std::int64_t>(3)) segment.times.push_back(time_from_ns(t_ns));
  const auto twists = data.column<double>(4);
  if (twists.size() % 6 != 0) fail("has a wrong shape");
  for (std::size_t i = 0; i < twists.size() / 6; ++i) {
    segment.twists.push_back(Eigen::Map<const Vector6>(twists.data() + 6 * i));
    if (!segment.twists.back().allFinite()) fail("has a velocity that is not finite");
  }
  if (!fits(segment)) fail("has a wrong number of poses, times or velocities");
  for (std::size_t i = 1; i < segment.times.size(); ++i) {
    if (segment.times[i] <= segment.times[i - 1]) fail("has times that do not ascend");
  }
  return segment;
}

ChunkData head_chunk(const Estimate& e) {
  ChunkData data;
  const std::int64_t numbers[] = {kFormatVersion,
                                  static_cast<std::int64_t>(e.status),
                                  e.gravity_aligned,
                                  e.has_causal,
                                  e.has_final,
                                  static_cast<std::int64_t>(e.causal.segments().size()),
                                  static_cast<std::int64_t>(e.final.segments().size())};
  data.add<std::int64_t>(numbers);
  data.add<char>(e.estimator);
  data.add<char>(e.message);
  return data;
}

ChunkData sweeps_chunk(const std::vector<SweepResult>& sweeps) {
  std::vector<std::int64_t> numbers;
  std::vector<double> poses;
  for (const SweepResult& s : sweeps) {
    numbers.insert(numbers.end(),
                   {s.index, to_ns(s.begin), to_ns(s.end), to_ns(s.reference), static_cast<std::int64_t>(s.status)});
    append_pose(poses, s.T_map_body);
  }
  ChunkData data;
  data.add<std::int64_t>(numbers);
  data.add<double>(poses);
  return data;
}

std::vector<SweepResult> sweeps_from_chunk(const ChunkData& data, const std::string& where) {
  const auto numbers = data.column<std::int64_t>(0);
  const auto poses = data.column<double>(1);
  if (numbers.size() % 5 != 0 || poses.size() != numbers.size() / 5 * kPoseValues) {
    throw DamagedFile(fmt::format("{}: the sweep results have a wrong shape", where));
  }
  for (const double value : poses) {
    if (!std::isfinite(value)) throw DamagedFile(fmt::format("{}: a sweep's pose is not finite", where));
  }
  std::vector<SweepResult> sweeps;
  for (std::size_t i = 0; i < numbers.size() / 5; ++i) {
    const std::int64_t* n = numbers.data() + 5 * i;
    if (n[4] < 0 || n[4] > 4) throw DamagedFile(fmt::format("{}: sweep {} has an unknown status", where, n[0]));
    sweeps.push_back({n[0], time_from_ns(n[1]), time_from_ns(n[2]), time_from_ns(n[3]), static_cast<SweepStatus>(n[4]),
                      pose_at(poses, i)});
  }
  return sweeps;
}

std::string text_of(const std::vector<char>& characters) {
  return {characters.begin(), characters.end()};
}

}  // namespace

const char* name_of(SweepStatus status) {
  switch (status) {
    case SweepStatus::ok:
      return "ok";
    case SweepStatus::initialising:
      return "initialising";
    case SweepStatus::lost:
      return "lost";
    case SweepStatus::empty:
      return "empty";
    case SweepStatus::out_of_order:
      return "out_of_order";
  }
  return "unknown";
}

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::ok:
      return "ok";
    case RunStatus::not_initialised:
      return "not_initialised";
    case RunStatus::failed:
      return "failed";
  }
  return "unknown";
}

void save_estimate(const std::filesystem::path& file, const Estimate& estimate) {
  std::filesystem::path part = file;
  part += ".part";
  {
    ChunkWriter writer(part);
    writer.append(Time{}, head_chunk(estimate));
    for (const auto* trajectory : {&estimate.causal, &estimate.final}) {
      for (const Segment& segment : trajectory->segments()) writer.append(segment.t0, segment_chunk(segment));
    }
    writer.append(Time{}, sweeps_chunk(estimate.sweeps));
    writer.finish();
  }
  std::filesystem::rename(part, file);
}

Estimate load_estimate(const std::filesystem::path& file) {
  const std::string where = file.string();
  const ChunkReader reader(file);
  if (reader.size() < 2) throw DamagedFile(fmt::format("{}: too few chunks for an estimate", where));
  const ChunkData head = reader.read(0);
  const auto numbers = head.column<std::int64_t>(0);
  if (numbers.size() != 7 || numbers[0] != kFormatVersion || numbers[1] < 0 || numbers[1] > 2 || numbers[5] < 0 ||
      numbers[6] < 0 || static_cast<std::uint64_t>(numbers[5] + numbers[6] + 2) != reader.size()) {
    throw DamagedFile(fmt::format("{}: its head is not that of an estimate of version {}", where, kFormatVersion));
  }
  Estimate e;
  e.status = static_cast<RunStatus>(numbers[1]);
  e.gravity_aligned = numbers[2] != 0;
  e.has_causal = numbers[3] != 0;
  e.has_final = numbers[4] != 0;
  e.estimator = text_of(head.column<char>(1));
  e.message = text_of(head.column<char>(2));
  std::size_t chunk = 1;
  for (auto [trajectory, count] : {std::pair{&e.causal, numbers[5]}, std::pair{&e.final, numbers[6]}}) {
    for (std::int64_t i = 0; i < count; ++i) trajectory->append(segment_from_chunk(reader.read(chunk++), where));
  }
  e.sweeps = sweeps_from_chunk(reader.read(chunk), where);
  return e;
}

}  // namespace tarmac::core
