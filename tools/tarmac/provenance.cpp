#include "tools/tarmac/provenance.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "core/files.h"
#include "tools/tarmac/build_info.h"

namespace tarmac::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

Json machine_json() {
  utsname system{};
  uname(&system);
  return {{"cpu", cpu_name()},
          {"cores", std::thread::hardware_concurrency()},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)}};
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace

void save_provenance(const std::filesystem::path& file, const Provenance& p) {
  const BuildInfo build = build_info();
  const Json json = {{"scenario", p.scenario},
                     {"seed", p.seed},
                     {"scenario_hash", p.scenario_hash},
                     {"recording_hash", p.recording_hash},
                     {"recording", p.recording},
                     {"truth", p.truth},
                     {"command", p.command},
                     {"options", p.options},
                     {"build",
                      {{"version", build.version},
                       {"commit", build.commit},
                       {"compiler", build.compiler},
                       {"type", build.build_type},
                       {"isa", p.isa}}},
                     {"machine", machine_json()},
                     {"threads", p.threads},
                     {"simulate",
                      {{"wall_s", p.simulate_wall_s},
                       {"real_time_factor", p.simulate_real_time_factor},
                       {"mrays_per_s", p.simulate_mrays_per_s}}},
                     {"made_at", utc_now()}};
  core::write_file(file, json.dump(2) + "\n");
}

Provenance load_provenance(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(core::read_file(file));
    Provenance p;
    p.scenario = json.at("scenario").get<std::string>();
    p.seed = json.at("seed").get<std::uint64_t>();
    p.scenario_hash = json.at("scenario_hash").get<std::string>();
    p.recording_hash = json.at("recording_hash").get<std::string>();
    p.recording = json.at("recording").get<std::string>();
    p.truth = json.at("truth").get<std::string>();
    p.command = json.at("command").get<std::string>();
    p.options = json.at("options").get<std::string>();
    p.isa = json.at("build").at("isa").get<std::string>();
    p.threads = json.at("threads").get<int>();
    p.simulate_wall_s = json.at("simulate").at("wall_s").get<double>();
    p.simulate_real_time_factor = json.at("simulate").at("real_time_factor").get<double>();
    p.simulate_mrays_per_s = json.at("simulate").at("mrays_per_s").get<double>();
    return p;
  } catch (const nlohmann::json::exception& error) {
    throw core::DamagedFile(fmt::format("{}: cannot be read: {}; make the run again", file.string(), error.what()));
  }
}

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-+=.,/:@%") == std::string::npos;
    if (!command.empty()) command += ' ';
    if (plain) {
      command += word;
      continue;
    }
    command += '\'';
    for (const char c : word) {
      if (c == '\'') {
        command += "'\\''";
      } else {
        command += c;
      }
    }
    command += '\'';
  }
  return command;
}

}  // namespace tarmac::tools
