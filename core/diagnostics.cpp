#include "core/diagnostics.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/chunk_file.h"
#include "core/error.h"
#include "core/files.h"

namespace tarmac::core {
namespace {

ChunkData chunk_of(const SweepDiagnostics& s) {
  ChunkData data;
  const std::int64_t numbers[] = {s.index,
                                  s.iterations,
                                  s.converged,
                                  s.points_in,
                                  s.points_used,
                                  s.residuals,
                                  static_cast<std::int64_t>(s.rows.size())};
  data.add<std::int64_t>(numbers);
  data.add_value(s.scale_m);
  data.add<double>({s.H_data.data(), 36});
  data.add<double>({s.H_prior.data(), 36});
  std::vector<std::int32_t> t_ns;
  std::vector<std::uint16_t> sensor;
  std::vector<float> values;
  for (const ResidualRow& row : s.rows) {
    t_ns.push_back(row.t_ns);
    sensor.push_back(row.sensor);
    values.push_back(row.value);
    values.push_back(row.weight);
    values.insert(values.end(), row.jacobian, row.jacobian + 6);
  }
  data.add<std::int32_t>(t_ns);
  data.add<std::uint16_t>(sensor);
  data.add<float>(values);
  return data;
}

SweepDiagnostics from_chunk(const ChunkData& data, const std::string& where) {
  const auto numbers = data.column<std::int64_t>(0);
  const auto H_data = data.column<double>(2), H_prior = data.column<double>(3);
  const auto t_ns = data.column<std::int32_t>(4);
  const auto sensor = data.column<std::uint16_t>(5);
  const auto values = data.column<float>(6);
  if (numbers.size() != 7 || H_data.size() != 36 || H_prior.size() != 36 || sensor.size() != t_ns.size() ||
      values.size() != 8 * t_ns.size()) {
    throw DamagedFile(fmt::format("{}: a sweep's diagnostics have a wrong shape", where));
  }
  SweepDiagnostics s;
  s.index = numbers[0];
  s.iterations = static_cast<int>(numbers[1]);
  s.converged = numbers[2] != 0;
  s.points_in = static_cast<std::int32_t>(numbers[3]);
  s.points_used = static_cast<std::int32_t>(numbers[4]);
  s.residuals = static_cast<std::int32_t>(numbers[5]);
  s.scale_m = data.value<double>(1);
  s.H_data = Eigen::Map<const Matrix6>(H_data.data());
  s.H_prior = Eigen::Map<const Matrix6>(H_prior.data());
  s.rows.resize(t_ns.size());
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    const float* v = values.data() + 8 * i;
    s.rows[i] = {t_ns[i], v[0], v[1], {v[2], v[3], v[4], v[5], v[6], v[7]}, sensor[i]};
  }
  return s;
}

}  // namespace

DiagnosticsLevel diagnostics_level(const std::string& name) {
  if (name == "none") return DiagnosticsLevel::none;
  if (name == "system") return DiagnosticsLevel::system;
  if (name == "full") return DiagnosticsLevel::full;
  throw InputError(fmt::format("--diagnostics {}: expected none, system or full", name));
}

void save_diagnostics(const std::filesystem::path& file, const std::vector<SweepDiagnostics>& sweeps) {
  std::filesystem::path part = file;
  part += ".part";
  {
    ChunkWriter writer(part);
    for (const SweepDiagnostics& sweep : sweeps) writer.append(Time{}, chunk_of(sweep));
    writer.finish();
  }
  std::filesystem::rename(part, file);
}

std::vector<SweepDiagnostics> load_diagnostics(const std::filesystem::path& file) {
  const ChunkReader reader(file);
  std::vector<SweepDiagnostics> sweeps;
  for (std::size_t i = 0; i < reader.size(); ++i) sweeps.push_back(from_chunk(reader.read(i), file.string()));
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
