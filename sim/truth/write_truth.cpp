#include "sim/truth/write_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/config.h"
#include "core/files.h"
#include "sim/truth/function_class.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

constexpr Duration tum_period{1'000'000};

std::string faults_as_json(const std::vector<Fault>& faults) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Fault& fault : faults) {
    list.push_back({{"kind", fault.kind},
                    {"sensor", fault.sensor},
                    {"detail", fault.detail},
                    {"parameters", nlohmann::ordered_json(fault.parameters)}});
  }
  return nlohmann::ordered_json{{"faults", list}}.dump(2) + "\n";
}

std::string motion_as_yaml(const std::string& resolved_motion) {
  const std::string block = "motion:\n" + resolved_motion;
  const ConfigNode node = ConfigNode::parse(block, "the resolved motion");
  const std::string kind = node.child("motion").child("kind").scalar("kind");
  return fmt::format("function_class: \"{}\"\n{}", motion_function_class(kind), block);
}

void append_tum_line(std::string& text, Time t, const SE3& T) {
  const std::int64_t ns = to_ns(t);
  const Eigen::Vector3d p = T.translation();
  const Eigen::Vector4d q = se3::quat_xyzw(T);
  fmt::format_to(std::back_inserter(text), "{}.{:09} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f}\n",
                 ns / 1'000'000'000, ns % 1'000'000'000, p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]);
}

void for_each_tum_part(const SmoothTrajectory& motion, const std::function<void(std::string_view)>& take) {
  constexpr std::size_t part_bytes = 1 << 20;
  std::string text = "# timestamp tx ty tz qx qy qz qw (T_world_body)\n";
  for (Time t = motion.begin(); t < motion.end(); t += tum_period) {
    append_tum_line(text, t, motion.pose(t));
    if (text.size() < part_bytes) continue;
    take(text);
    text.clear();
  }
  append_tum_line(text, motion.end(), motion.pose(motion.end()));
  take(text);
}

}  // namespace

std::string motion_as_tum(const SmoothTrajectory& motion) {
  std::string whole;
  for_each_tum_part(motion, [&](std::string_view part) { whole += part; });
  return whole;
}

void write_truth(const std::filesystem::path& folder, const std::string& resolved_scenario,
                 const std::string& resolved_motion, const SmoothTrajectory& motion, const Rig& rig,
                 const std::vector<Fault>& faults) {
  std::filesystem::create_directories(folder);
  write_file(folder / "motion.yaml", motion_as_yaml(resolved_motion));
  // Part by part: of half an hour this is a quarter of a gigabyte.
  write_file_in_parts(folder / "truth.tum", [&](const WritePart& write) { for_each_tum_part(motion, write); });
  write_file(folder / "rig.json", rig_to_json(rig) + "\n");
  write_file(folder / "faults.json", faults_as_json(faults));
  // Last: load_ground_truth starts from it.
  write_file(folder / "scenario.yaml", resolved_scenario);
}

}  // namespace tarmac::sim::truth
