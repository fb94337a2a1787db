#include "core/diagnostics.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/chunk_file.h"
#include "core/error.h"
#include "core/files.h"

namespace tarmac::core {
namespace {

/// Four columns: times, sensors, points, and value, weight, jacobian one after the other.
void add_rows(const std::vector<ResidualRow>& rows, ChunkData& data) {
  std::vector<std::int32_t> t_ns;
  std::vector<std::uint16_t> sensor;
  std::vector<std::uint32_t> point;
  std::vector<float> values;
  t_ns.reserve(rows.size());
  sensor.reserve(rows.size());
  point.reserve(rows.size());
  values.reserve(8 * rows.size());
  for (const ResidualRow& row : rows) {
    t_ns.push_back(row.t_ns);
    sensor.push_back(row.sensor);
    point.push_back(row.point);
    values.push_back(row.value);
    values.push_back(row.weight);
    values.insert(values.end(), row.jacobian, row.jacobian + 6);
  }
  data.add<std::int32_t>(t_ns);
  data.add<std::uint16_t>(sensor);
  data.add<std::uint32_t>(point);
  data.add<float>(values);
}

[[noreturn]] void wrong_shape(const std::string& where) {
  throw DamagedFile(fmt::format("{}: a sweep's diagnostics have a wrong shape", where));
}

std::vector<ResidualRow> rows_of(const ChunkData& data, std::size_t column, const std::string& where) {
  const auto t_ns = data.column<std::int32_t>(column);
  const auto sensor = data.column<std::uint16_t>(column + 1);
  const auto point = data.column<std::uint32_t>(column + 2);
  const auto values = data.column<float>(column + 3);
  if (sensor.size() != t_ns.size() || point.size() != t_ns.size() || values.size() != 8 * t_ns.size())
    wrong_shape(where);
  std::vector<ResidualRow> rows(t_ns.size());
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    const float* v = values.data() + 8 * i;
    rows[i] = {t_ns[i], v[0], v[1], {v[2], v[3], v[4], v[5], v[6], v[7]}, sensor[i], point[i]};
  }
  return rows;
}

ChunkData chunk_of(const SweepDiagnostics& s) {
  ChunkData data;
  const std::int64_t numbers[] = {s.index,       s.iterations, s.converged,       s.points_in,
                                  s.points_used, s.residuals,  s.rows_are_surface};
  data.add<std::int64_t>(numbers);
  data.add_value(s.scale_m);
  data.add<double>({s.H_data.data(), 36});
  data.add<double>({s.H_prior.data(), 36});
  add_rows(s.rows, data);
  add_rows(s.surface, data);
  data.add<double>({s.covariance.data(), 36});
  return data;
}

SweepDiagnostics from_chunk(const ChunkData& data, const std::string& where) {
  const auto numbers = data.column<std::int64_t>(0);
  const auto H_data = data.column<double>(2), H_prior = data.column<double>(3);
  if (numbers.size() != 7 || H_data.size() != 36 || H_prior.size() != 36) wrong_shape(where);
  SweepDiagnostics s;
  s.index = numbers[0];
  s.iterations = static_cast<int>(numbers[1]);
  s.converged = numbers[2] != 0;
  s.points_in = static_cast<std::int32_t>(numbers[3]);
  s.points_used = static_cast<std::int32_t>(numbers[4]);
  s.residuals = static_cast<std::int32_t>(numbers[5]);
  s.rows_are_surface = numbers[6] != 0;
  s.scale_m = data.value<double>(1);
  s.H_data = Eigen::Map<const Matrix6>(H_data.data());
  s.H_prior = Eigen::Map<const Matrix6>(H_prior.data());
  s.rows = rows_of(data, 4, where);
  s.surface = rows_of(data, 8, where);
  const auto covariance = data.column<double>(12);
  if (covariance.size() != 36) wrong_shape(where);
  s.covariance = Eigen::Map<const Matrix6>(covariance.data());
  return s;
}

std::filesystem::path part_of(const std::filesystem::path& file) {
  std::filesystem::path part = file;
  part += ".part";
  return part;
}

}  // namespace

DiagnosticsLevel diagnostics_level(const std::string& name) {
  if (name == "none") return DiagnosticsLevel::none;
  if (name == "system") return DiagnosticsLevel::system;
  if (name == "full") return DiagnosticsLevel::full;
  throw InputError(fmt::format("--diagnostics {}: expected none, system or full", name));
}

DiagnosticsWriter::DiagnosticsWriter(const std::filesystem::path& file)
    : file_(file), writer_(std::make_unique<ChunkWriter>(part_of(file))) {}

DiagnosticsWriter::~DiagnosticsWriter() = default;

void DiagnosticsWriter::append(const SweepDiagnostics& sweep) {
  writer_->append(Time{}, chunk_of(sweep));
}

void DiagnosticsWriter::finish() {
  writer_->finish();
  writer_.reset();
  std::filesystem::rename(part_of(file_), file_);
}

DiagnosticsReader::DiagnosticsReader(const std::filesystem::path& file)
    : file_(file), reader_(std::make_unique<ChunkReader>(file)) {}

DiagnosticsReader::~DiagnosticsReader() = default;

std::size_t DiagnosticsReader::size() const {
  return reader_->size();
}

SweepDiagnostics DiagnosticsReader::read(std::size_t i) const {
  return from_chunk(reader_->read(i), file_.string());
}

void save_diagnostics(const std::filesystem::path& file, const std::vector<SweepDiagnostics>& sweeps) {
  DiagnosticsWriter writer(file);
  for (const SweepDiagnostics& sweep : sweeps) writer.append(sweep);
  writer.finish();
}

std::vector<SweepDiagnostics> load_diagnostics(const std::filesystem::path& file) {
  const DiagnosticsReader reader(file);
  std::vector<SweepDiagnostics> sweeps;
  for (std::size_t i = 0; i < reader.size(); ++i) sweeps.push_back(reader.read(i));
  return sweeps;
}

void save_timing(const std::filesystem::path& file, const RunTiming& timing) {
  using Json = nlohmann::ordered_json;
  Json sweeps = Json::array();
  for (const SweepTiming& s : timing.sweeps) {
    Json stages = Json::object();
    for (const auto& [name, ms] : s.stages_ms) stages[name] = ms;
    sweeps.push_back({{"index", s.index}, {"wall_ms", s.wall_ms}, {"cpu_ms", s.cpu_ms}, {"stages_ms", stages}});
  }
  const Json json = {{"threads", timing.threads},
                     {"wall_s", timing.wall_s},
                     {"cpu_s", timing.cpu_s},
                     {"peak_memory_mb", timing.peak_memory_mb},
                     {"sweeps", sweeps}};
  write_file(file, json.dump(1) + "\n");
}

RunTiming load_timing(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::ordered_json::parse(read_file(file));
    RunTiming timing;
    timing.threads = json.at("threads").get<int>();
    timing.wall_s = json.at("wall_s").get<double>();
    timing.cpu_s = json.at("cpu_s").get<double>();
    timing.peak_memory_mb = json.at("peak_memory_mb").get<double>();
    for (const auto& entry : json.at("sweeps")) {
      SweepTiming s;
      s.index = entry.at("index").get<std::int64_t>();
      s.wall_ms = entry.at("wall_ms").get<double>();
      s.cpu_ms = entry.at("cpu_ms").get<double>();
      for (const auto& [name, ms] : entry.at("stages_ms").items()) s.stages_ms.emplace_back(name, ms.get<double>());
      timing.sweeps.push_back(std::move(s));
    }
    return timing;
  } catch (const nlohmann::json::exception& error) {
    throw DamagedFile(fmt::format("{}: cannot be read as timing: {}", file.string(), error.what()));
  }
}

}  // namespace tarmac::core
