#include "sim/truth/ground_truth.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "scenes/registry.h"
#include "sim/truth/motion.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

/// The keys of scenario.yaml that the motion hangs on; the file holds others, which are not ours to check.
struct Basics {
  std::string name;
  std::int64_t seed = 0;
  double duration_s = 0;
  void visit(OptionVisitor& v) {
    v("name", name, "of the scenario");
    v("seed", seed, "of all random draws");
    v("duration_s", duration_s, "of the motion", {.above = 0});
  }
};

Basics read_basics(const ConfigNode& scenario) {
  for (const char* key : {"name", "seed", "duration_s", "scene", "motion"}) {
    if (!scenario.child(key).present()) {
      scenario.fail_at(key, "is missing: a truth folder's scenario.yaml is written by the simulator, in full");
    }
  }
  Basics basics;
  scenario.read(basics, scenario.keys());
  return basics;
}

std::vector<Fault> faults_from_json(const std::string& text, const std::string& where) {
  try {
    std::vector<Fault> faults;
    const nlohmann::json json = nlohmann::json::parse(text);
    for (const auto& entry : json.at("faults")) {
      faults.push_back({entry.at("kind").get<std::string>(), entry.at("sensor").get<std::string>(),
                        entry.at("detail").get<std::string>(),
                        entry.value("parameters", std::map<std::string, double>())});
    }
    return faults;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: the fault log cannot be read: {}", where, error.what()));
  }
}

}  // namespace

ChunkData to_chunk(const PointLabels& labels) {
  std::vector<std::uint8_t> label(labels.label.size());
  for (std::size_t i = 0; i < label.size(); ++i) label[i] = static_cast<std::uint8_t>(labels.label[i]);
  ChunkData chunk;
  chunk.add(std::span<const std::uint8_t>(label));
  chunk.add(std::span<const std::uint32_t>(labels.instance));
  chunk.add(std::span<const std::uint8_t>(labels.moving));
  chunk.add(std::span<const std::int32_t>(labels.t_ns));
  chunk.add_value(to_ns(labels.begin));
  chunk.add_value(to_ns(labels.end));
  std::vector<std::uint8_t> kind(label.size());
  for (std::size_t i = 0; i < kind.size(); ++i) kind[i] = static_cast<std::uint8_t>(labels.kind_of(i));
  chunk.add(std::span<const std::uint8_t>(kind));
  if (!labels.has_point_truth()) return chunk;
  chunk.add(std::span<const double>(labels.true_range_m));
  for (const auto* values : {&labels.normal_x, &labels.normal_y, &labels.normal_z, &labels.cos_incidence})
    chunk.add(std::span<const float>(*values));
  return chunk;
}

void PointLabels::keep_only(const std::vector<std::size_t>& kept) {
  const auto keep = [&](auto& values) {
    if (values.empty()) return;  // a column that was not asked for
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  keep(label);
  keep(instance);
  keep(moving);
  keep(t_ns);
  keep(kind);
  keep(true_range_m);
  for (auto* values : {&normal_x, &normal_y, &normal_z, &cos_incidence}) keep(*values);
}

const char* name_of(ReturnKind kind) {
  static constexpr std::array names{"surface", "mixed",      "edge", "dirt",      "transmitted", "ghost",
                                    "glint",   "retro_halo", "self", "saturated", "noise"};
  return names.at(static_cast<std::size_t>(kind));
}

namespace {

constexpr std::size_t kKindColumn = 6;  // those before it were there from the first version on

void check_length(std::size_t length, const PointLabels& labels, const char* column) {
  if (length != labels.label.size())
    throw DamagedFile(fmt::format("a chunk of labels has {} values of {} for {} points: they must be equally many",
                                  length, column, labels.label.size()));
}

void read_kinds(const ChunkData& chunk, PointLabels& labels) {
  const auto kind = chunk.column<std::uint8_t>(kKindColumn);
  check_length(kind.size(), labels, "kind");
  labels.kind.reserve(kind.size());
  for (const std::uint8_t value : kind) {
    if (value > static_cast<std::uint8_t>(ReturnKind::noise))
      throw DamagedFile(fmt::format("a chunk of labels has a point of kind {}, which is none", value));
    labels.kind.push_back(static_cast<ReturnKind>(value));
  }
}

void read_point_truth(const ChunkData& chunk, PointLabels& labels) {
  std::size_t column = kKindColumn + 1;
  labels.true_range_m = chunk.column<double>(column);
  check_length(labels.true_range_m.size(), labels, "true range");
  for (auto* values : {&labels.normal_x, &labels.normal_y, &labels.normal_z, &labels.cos_incidence}) {
    *values = chunk.column<float>(++column);
    check_length(values->size(), labels, "normal or incidence");
  }
}

}  // namespace

PointLabels labels_from_chunk(const ChunkData& chunk, Columns columns) {
  PointLabels labels;
  const auto label = chunk.column<std::uint8_t>(0);
  labels.label.reserve(label.size());
  for (const std::uint8_t value : label) labels.label.push_back(static_cast<scenes::Label>(value));
  labels.instance = chunk.column<std::uint32_t>(1);
  labels.moving = chunk.column<std::uint8_t>(2);
  labels.t_ns = chunk.column<std::int32_t>(3);
  labels.begin = time_from_ns(chunk.value<std::int64_t>(4));
  labels.end = time_from_ns(chunk.value<std::int64_t>(5));
  const std::size_t size = labels.label.size();
  if (labels.instance.size() != size || labels.moving.size() != size || labels.t_ns.size() != size) {
    throw DamagedFile(
        fmt::format("a chunk of labels has columns of {}, {}, {} and {} points: they must be equally long", size,
                    labels.instance.size(), labels.moving.size(), labels.t_ns.size()));
  }
  if (chunk.column_count() > kKindColumn) read_kinds(chunk, labels);
  if (columns == Columns::labels_and_point_truth && chunk.column_count() > kKindColumn + 1)
    read_point_truth(chunk, labels);
  return labels;
}

std::vector<PointLabels> GroundTruth::labels(std::size_t lidar, Columns columns) const {
  const std::filesystem::path file = folder / fmt::format("lidar{}_labels.chunks", lidar);
  if (folder.empty() || !std::filesystem::exists(file)) {
    throw InputError(fmt::format("{}: there are no labels of lidar {}: simulate the scenario again to get them",
                                 file.string(), lidar));
  }
  const ChunkReader reader(file);
  std::vector<PointLabels> sweeps;
  sweeps.reserve(reader.size());
  for (std::size_t i = 0; i < reader.size(); ++i) sweeps.push_back(labels_from_chunk(reader.read(i), columns));
  return sweeps;
}

namespace {

/// The motion is rebuilt by this program; truth.tum was written by the one that traced the rays. Where they differ, the
/// code of a motion has changed since, and the recording would be scored against a drive that never was.
void check_rebuilt(const GroundTruth& truth) {
  const std::filesystem::path file = truth.folder / "truth.tum";
  const std::string text = read_file(file);
  constexpr int kSamples = 16;
  constexpr double kTolerance_m = 1e-9;  // twelve decimals are written
  for (int k = 0; k < kSamples; ++k) {
    std::size_t at = text.size() / kSamples * static_cast<std::size_t>(k);
    if (k > 0) at = text.find('\n', at) + 1;
    while (at < text.size() && text[at] == '#') at = text.find('\n', at) + 1;
    long long seconds = 0, nanoseconds = 0;
    Eigen::Vector3d p;
    if (std::sscanf(text.c_str() + at, "%lld.%9lld %lf %lf %lf", &seconds, &nanoseconds, &p.x(), &p.y(), &p.z()) != 5)
      throw DamagedFile(fmt::format("{}: has no pose at byte {}; simulate again", file.string(), at));
    const Time t = time_from_ns(seconds * 1'000'000'000 + nanoseconds);
    if ((truth.motion->pose(t).translation() - p).norm() > kTolerance_m)
      throw InputError(
          fmt::format("{}: another version of this program made it: its pose at {} ns is not the one that "
                      "this version's motion has; simulate again",
                      file.string(), to_ns(t)));
  }
}

}  // namespace

GroundTruth load_ground_truth(const std::filesystem::path& truth_folder) {
  const std::filesystem::path scenario = truth_folder / "scenario.yaml", rig = truth_folder / "rig.json";
  const std::filesystem::path faults = truth_folder / "faults.json";
  for (const auto& file : {scenario, rig, faults}) {
    if (std::filesystem::is_regular_file(file)) continue;
    throw InputError(fmt::format("{}: is no truth folder, since {} is missing: give the `truth` folder of a simulation",
                                 truth_folder.string(), file.filename().string()));
  }
  GroundTruth truth;
  truth.config = ConfigNode::load(scenario.string());
  const Basics basics = read_basics(truth.config);
  truth.scenario = basics.name;
  truth.seed = static_cast<std::uint64_t>(basics.seed);
  truth.folder = truth_folder;
  truth.rig = rig_from_json(read_file(rig), rig.string());
  truth.faults = faults_from_json(read_file(faults), faults.string());
  const ConfigNode scene = truth.config.child("scene");
  truth.motion = make_motion(truth.config.child("motion"), duration_from_s(basics.duration_s),
                             scenes::make_ground(scene, truth.seed), truth.seed);
  check_rebuilt(truth);
  return truth;
}

}  // namespace tarmac::sim::truth
