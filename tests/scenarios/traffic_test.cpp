// Shipped scenarios: nothing that moves runs into anything, and where it would, the scenario is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "io/world/mesh_readers.h"
#include "scenarios/scenario.h"
#include "scenes/registry.h"
#include "sim/simulate.h"
#include "sim/truth/motion.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::tests {
namespace {

sim::SimulationInput world_of(const scenarios::Scenario& scenario) {
  io::world::install_mesh_readers();
  sim::SimulationInput input;
  input.scenario_name = scenario.name;
  input.duration = scenario.duration();
  input.scene = std::make_shared<const scenes::Scene>(scenes::make_scene(scenario.scene, input.seed));
  input.motion = sim::truth::make_motion(scenario.motion, scenario.duration(), input.scene->ground, input.seed);
  input.body = sim::truth::body_box(scenario.motion);
  input.rig = scenario.rig;
  input.faults = scenario.faults;
  return input;
}

class ShippedTraffic : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedTraffic, RunsIntoNothing) {
  EXPECT_NO_THROW(sim::check(world_of(scenarios::load_scenario(GetParam(), {}))));
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedTraffic, testing::ValuesIn(scenarios::list_scenarios({TARMAC_SCENARIOS})),
                         [](const auto& scenario) {
                           std::string name = scenario.param.stem().string();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Traffic, AFuelTruckThatStaysOnTheVehiclesLaneIsRefusedWithItsLineItsTimeAndItsPlace) {
  std::string text = core::read_file(std::filesystem::path(TARMAC_SCENARIOS) / "bus-and-fuel.yaml");
  const std::size_t truck = text.find("- kind: fuel-truck");
  ASSERT_NE(truck, std::string::npos);
  const std::size_t rest = text.find("rest_s: 4", truck);
  ASSERT_NE(rest, std::string::npos);
  text.replace(rest, 9, "rest_s: 400");
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(truck), '\n');
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "head-on.yaml";
  core::write_file(file, text);
  try {
    sim::check(world_of(scenarios::load_scenario(file, {})));
    FAIL() << "nothing was refused";
  } catch (const core::InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file.string() + ":" + std::to_string(line) +
                                    ": actor fuel-truck-3 runs into the ego vehicle"))
        << message;
    EXPECT_NE(message.find(" s, near x "), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace tarmac::tests
