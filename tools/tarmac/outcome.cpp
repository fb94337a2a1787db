#include "tools/tarmac/outcome.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::tools {

using Json = nlohmann::ordered_json;

void save_outcome(const std::filesystem::path& folder, const Outcome& o) {
  const Json json = {{"estimator", o.estimator}, {"status", o.status},
                     {"message", o.message},     {"wall_s", o.wall_s},
                     {"cpu_s", o.cpu_s},         {"peak_memory_mb", o.peak_memory_mb},
                     {"threads", o.threads},     {"recording_hash", o.recording_hash}};
  core::write_file(folder / "outcome.json", json.dump(2) + "\n");
}

Outcome load_outcome(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "outcome.json";
  try {
    const Json json = Json::parse(core::read_file(file));
    Outcome o;
    o.estimator = json.at("estimator").get<std::string>();
    o.status = json.at("status").get<std::string>();
    o.message = json.at("message").get<std::string>();
    o.wall_s = json.at("wall_s").get<double>();
    o.cpu_s = json.at("cpu_s").get<double>();
    o.peak_memory_mb = json.at("peak_memory_mb").get<double>();
    o.threads = json.at("threads").get<int>();
    o.recording_hash = json.at("recording_hash").get<std::string>();
    return o;
  } catch (const nlohmann::json::exception& error) {
    throw core::DamagedFile(
        fmt::format("{}: cannot be read: {}; run the estimator again", file.string(), error.what()));
  }
}

bool has_outcome(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(folder / "outcome.json");
}

}  // namespace tarmac::tools
