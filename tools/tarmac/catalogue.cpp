// `tarmac list` and `tarmac describe`: what there is, and one thing in full.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "estimators/registry.h"
#include "metrics/registry.h"
#include "scenarios/sweep_file.h"
#include "scenes/actors/actors.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/equipment/equipment.h"
#include "scenes/registry.h"
#include "sim/simulate.h"
#include "sim/truth/function_class.h"
#include "sim/truth/motion.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/pictures.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

struct Entry {
  std::string name, summary;
};

/// A kind of thing that can be listed and described.
struct Kind {
  const char* plural;
  const char* singular;
  std::function<std::vector<Entry>()> list;
  std::function<std::string(const std::string& name)> describe;
};

std::string options_text(const std::vector<core::OptionDescription>& options) {
  if (options.empty()) return "no options\n";
  std::string text = "options:\n";
  for (const core::OptionDescription& o : options) {
    text += fmt::format("  {:<32} {}", o.name, o.meaning);
    if (!o.default_value.empty()) text += fmt::format(" (default {}", o.default_value);
    if (!o.allowed.empty()) text += fmt::format("{}{}", o.default_value.empty() ? " (" : "; ", o.allowed);
    if (!o.default_value.empty() || !o.allowed.empty()) text += ")";
    text += "\n";
  }
  return text;
}

[[noreturn]] void unknown(const char* kind, const std::string& name, const std::vector<Entry>& known) {
  std::vector<std::string> names;
  std::string all;
  for (const Entry& entry : known) {
    names.push_back(entry.name);
    all += (all.empty() ? "" : ", ") + entry.name;
  }
  const std::string guess = core::did_you_mean(name, names);
  throw core::InputError(fmt::format("{} '{}': there is none of that name{}; known are {}", kind, name,
                                     guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess), all));
}

std::vector<Entry> scenario_entries() {
  std::vector<Entry> entries;
  for (const auto& file : scenarios::list_scenarios(scenario_folders())) {
    entries.push_back({file.stem().string(), scenarios::load_scenario(file, {}).why});
  }
  return entries;
}

std::string describe_scenario(const std::string& name) {
  const auto scenario = scenarios::load_scenario(scenarios::find_scenario(name, scenario_folders()), {});
  return resolve_scenario(scenario, static_cast<std::uint64_t>(scenario.seed), {});
}

std::vector<Entry> sweep_entries() {
  std::vector<Entry> entries;
  for (const auto& file : scenarios::list_beside_scenarios("sweeps", scenario_folders())) {
    entries.push_back({file.stem().string(), scenarios::load_sweep(file).why});
  }
  return entries;
}

/// What each block runs, and how many cells that makes.
std::string describe_sweep(const std::string& name) {
  const auto file = scenarios::find_beside_scenarios(name, "sweeps", scenario_folders());
  const scenarios::SweepFile sweep = scenarios::load_sweep(file);
  struct Block {
    std::string name;
    std::set<std::string> scenarios, cases;
    std::set<std::uint64_t> seeds;
    std::vector<std::string> estimators;
    std::size_t cells = 0;
  };
  std::vector<Block> blocks;
  for (const scenarios::SweepCell& cell : sweep.cells) {
    if (blocks.empty() || blocks.back().name != cell.block) blocks.emplace_back().name = cell.block;
    Block& block = blocks.back();
    block.scenarios.insert(std::filesystem::path(cell.scenario).stem().string());
    block.cases.insert(cell.case_name);
    block.seeds.insert(cell.seed);
    if (std::find(block.estimators.begin(), block.estimators.end(), cell.estimator) == block.estimators.end()) {
      block.estimators.push_back(cell.estimator);
    }
    ++block.cells;
  }
  std::string text = fmt::format("{}: {}\n", sweep.name, sweep.why);
  for (const Block& block : blocks) {
    text += fmt::format("  {:<24} {} cells: {}; {} case(s) x {} seed(s); {}\n", block.name, block.cells,
                        fmt::join(block.scenarios, ", "), block.cases.size(), block.seeds.size(),
                        fmt::join(block.estimators, ", "));
  }
  return text + fmt::format("{} cells in all\n", sweep.cells.size());
}

std::vector<Entry> gate_entries() {
  std::vector<Entry> entries;
  for (const auto& file : scenarios::list_beside_scenarios("gates", scenario_folders())) {
    entries.push_back({file.stem().string(), core::ConfigNode::load(file.string()).child("why").scalar_or("")});
  }
  return entries;
}

std::string describe_gate(const std::string& name) {
  return core::read_file(scenarios::find_beside_scenarios(name, "gates", scenario_folders()));
}

std::vector<Entry> scene_entries() {
  std::vector<Entry> entries;
  for (const auto* scene : scenes::scenes()) entries.push_back({scene->name, scene->summary});
  return entries;
}

std::string describe_scene(const std::string& name) {
  for (const auto* scene : scenes::scenes()) {
    if (name != scene->name) continue;
    const auto built = scenes::make_scene(core::ConfigNode::parse("kind: " + name + "\n", "describe scene " + name), 1);
    return fmt::format(
        "{}: {}\n{} triangles after instancing, {} materials, {} actors\n{}", scene->name, scene->summary,
        built.triangle_count(), built.materials.size(), built.actors.size(),
        options_text(scene->describe()) + "of every kind, " + options_text(scenes::describe_common_options()));
  }
  unknown("scene", name, scene_entries());
}

std::vector<Entry> actor_entries() {
  std::vector<Entry> entries;
  for (const scenes::ActorKindSummary& kind : scenes::actor_summaries()) entries.push_back({kind.name, kind.summary});
  return entries;
}

std::string describe_actor(const std::string& name) {
  for (const Entry& entry : actor_entries())
    if (entry.name == name)
      return fmt::format("{}: {}\none entry of a scene's `actors:` list\n{}", name, entry.summary,
                         options_text(scenes::describe_actor(name)));
  unknown("actor", name, actor_entries());
}

std::vector<Entry> aircraft_entries() {
  std::vector<Entry> entries;
  for (const std::string& name : scenes::aircraft_names())
    entries.push_back({name, scenes::aircraft_type(name).summary});
  return entries;
}

std::string describe_aircraft(const std::string& name) {
  const scenes::AircraftType& t = scenes::aircraft_type(name);
  std::string text = fmt::format(
      "{}: {}\nICAO code {}; length {} m, span {} m, height {} to {} m, cabin floor {} m above ground, {} engines\n",
      t.name, t.summary, t.icao_code, t.length_m, t.span_m, t.height_min_m, t.height_max_m, t.floor_z_m,
      2 * t.engines.size());
  text += fmt::format("nose gear {} m aft of the nose tip\n", t.nose_gear.x_m);
  for (const auto& gear : t.main_gear) {
    text +=
        fmt::format("main gear {} m aft, track {} m, {} wheels a leg\n", gear.x_m, 2 * gear.half_track_m, gear.wheels);
  }
  for (std::size_t k = 0; k < t.doors.size(); ++k) {
    const auto& door = t.doors[k];
    text += fmt::format("door {}: {} m aft, {} x {} m, sill {:.2f} m above ground, {}\n", k, door.x_m, door.width_m,
                        door.height_m, t.floor_z_m + door.sill_m,
                        door.side == 0  ? "both sides"
                        : door.side > 0 ? "left"
                                        : "right");
  }
  return text;
}

std::vector<Entry> equipment_entries() {
  std::vector<Entry> entries;
  for (const auto& entry : scenes::equipment()) entries.push_back({entry.name, entry.summary});
  return entries;
}

std::string describe_equipment(const std::string& name) {
  const auto& entry = scenes::equipment_entry(name);
  return fmt::format("{}: {}\n{} x {} x {} m, label {}, {} triangles\n", entry.name, entry.summary, entry.length_m,
                     entry.width_m, entry.height_m, scenes::name_of(entry.label),
                     scenes::make_equipment(name).triangles.size());
}

std::vector<Entry> motion_entries() {
  std::vector<Entry> entries;
  for (const std::string& kind : sim::truth::motion_kinds())
    entries.push_back({kind, sim::truth::motion_summary(kind)});
  return entries;
}

std::vector<Entry> catalogue_entries(const std::vector<sim::CatalogueEntry>& catalogue) {
  std::vector<Entry> entries;
  for (const auto& entry : catalogue) entries.push_back({entry.name, entry.summary});
  return entries;
}

std::vector<Entry> fault_entries() {
  return {{"lidar", "clock, stamps, point times, lost data and mounting of the LiDAR"},
          {"imu", "clock, stamps, lost samples and mounting of the IMU"}};
}

/// The options of one sensor's faults, by the names that --set takes.
std::string describe_fault(const std::string& name) {
  std::vector<core::OptionDescription> options;
  for (core::OptionDescription& option : sim::describe_fault_options()) {
    if (!option.name.starts_with(name + ".")) continue;
    option.name = "faults." + option.name;
    options.push_back(std::move(option));
  }
  if (options.empty()) unknown("fault", name, fault_entries());
  return options_text(options);
}

std::vector<Entry> estimator_entries() {
  std::vector<Entry> entries;
  for (const auto* entry : estimators::estimators()) entries.push_back({entry->name, entry->summary});
  return entries;
}

std::string describe_estimator(const std::string& name) {
  const auto* entry = estimators::find_estimator(name);
  if (!entry) unknown("estimator", name, estimator_entries());
  const char* needs = entry->needs == estimators::Needs::lidar ? "LiDAR"
                      : entry->needs == estimators::Needs::imu ? "IMU"
                                                               : "LiDAR and IMU";
  return fmt::format("{}: {}\nsource: {}\nneeds: {}\n{}", entry->name, entry->summary, entry->source, needs,
                     options_text(entry->describe()));
}

std::vector<Entry> metric_entries() {
  std::vector<Entry> entries;
  for (const auto& metric : metrics::metrics()) entries.push_back({metric.name, metric.meaning});
  return entries;
}

std::string describe_metric(const std::string& name) {
  const auto* metric = metrics::find_metric(name);
  if (!metric) unknown("metric", name, metric_entries());
  return fmt::format("{} [{}]: {}\nalignment: {}\n{} is better\nsource: {}\n", metric->name, metric->unit,
                     metric->meaning, metric->alignment, metric->lower_is_better ? "lower" : "higher", metric->source);
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"scenarios", "scenario", scenario_entries, describe_scenario},
      {"sweeps", "sweep", sweep_entries, describe_sweep},
      {"gates", "gate", gate_entries, describe_gate},
      {"scenes", "scene", scene_entries, describe_scene},
      {"actors", "actor", actor_entries, describe_actor},
      {"aircraft", "aircraft", aircraft_entries, describe_aircraft},
      {"equipment", "equipment", equipment_entries, describe_equipment},
      {"motions", "motion", motion_entries,
       [](const std::string& name) {
         return fmt::format("{}: {}\nfunction class: {}\n{}", name, sim::truth::motion_summary(name),
                            sim::truth::motion_function_class(name), options_text(sim::truth::describe_motion(name)));
       }},
      {"sensors", "sensor", [] { return catalogue_entries(sim::lidar_catalogue()); }, sim::describe_lidar},
      {"imus", "imu", [] { return catalogue_entries(sim::imu_catalogue()); }, sim::describe_imu},
      {"faults", "fault", fault_entries, describe_fault},
      {"estimators", "estimator", estimator_entries, describe_estimator},
      {"metrics", "metric", metric_entries, describe_metric}};
  return all;
}

}  // namespace

int list_command(const std::string& wanted, const CommonArguments& common) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  bool any = false;
  for (const Kind& kind : kinds()) {
    if (!wanted.empty() && wanted != kind.plural && wanted != kind.singular) continue;
    any = true;
    const std::vector<Entry> entries = kind.list();
    if (common.json) {
      json[kind.plural] = nlohmann::ordered_json::array();
      for (const Entry& entry : entries)
        json[kind.plural].push_back({{"name", entry.name}, {"summary", entry.summary}});
      continue;
    }
    if (wanted.empty()) fmt::print("{}:\n", kind.plural);
    for (const Entry& entry : entries)
      fmt::print("{}{:<30} {}\n", wanted.empty() ? "  " : "", entry.name, entry.summary);
  }
  if (!any) {
    std::vector<Entry> known;
    for (const Kind& kind : kinds()) known.push_back({kind.plural, ""});
    unknown("list", wanted, known);
  }
  if (common.json) fmt::print("{}\n", json.dump(1));
  return 0;
}

int describe_command(const DescribeArguments& arguments, const CommonArguments&) {
  check_picture(arguments);
  for (const Kind& kind : kinds()) {
    if (arguments.kind != kind.singular && arguments.kind != kind.plural) continue;
    if (arguments.name == "all") {
      for (const Entry& entry : kind.list()) fmt::print("{}", kind.describe(entry.name));
    } else {
      fmt::print("{}", kind.describe(arguments.name));
    }
    if (!arguments.picture.empty()) {
      DescribeArguments wanted = arguments;
      wanted.kind = kind.singular;
      draw_picture(wanted);
    }
    return 0;
  }
  std::vector<Entry> known;
  for (const Kind& kind : kinds()) known.push_back({kind.singular, ""});
  unknown("describe", arguments.kind, known);
}

}  // namespace tarmac::tools
