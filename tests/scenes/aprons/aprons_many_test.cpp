/// Pier, remote stands, open apron, hangar and cargo yard: the laws of every scene that take many scenes to test.
#include <gtest/gtest.h>

#include <iostream>

#include "scenes/pier/layout.h"
#include "tests/scenes/laws.h"

namespace tarmac::scenes {
namespace {

using namespace tests;

const std::vector<std::string> kinds{"open-apron", "pier", "remote-stand", "hangar", "cargo-yard"};

class Apron : public testing::TestWithParam<std::string> {};

TEST_P(Apron, IsSoundAndOfModestSize) {
  const Scene scene = make_scene(laws::node_of(GetParam()), 1);
  laws::every_triangle_is_sound(scene);
  laws::instances_are_sound(scene);
  laws::solids_are_closed_and_face_outward(scene);
  laws::ground_faces_up(scene);
  std::cout << scene.triangle_count() << " triangles in " << scene.instances.size() << " instances\n";
  EXPECT_LT(scene.triangle_count(), 800'000U);
}

TEST_P(Apron, SeedDecidesTheBytes) {
  laws::seed_decides_the_bytes(GetParam());
}

std::string name_of_case(const testing::TestParamInfo<std::string>& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, Apron, testing::ValuesIn(kinds), name_of_case);

const std::map<std::string, std::string> paving{{"slab_size_m", "10"},  {"crossfall_percent", "0.7"},
                                                {"undulation_mm", "3"}, {"slab_tilt_mm", "0"},
                                                {"relief_rms_mm", "4"}, {"joint_depth_mm", "1"}};

std::map<std::string, std::string> and_paving(std::map<std::string, std::string> options) {
  options.insert(paving.begin(), paving.end());
  return options;
}

TEST(OpenApron, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene(
      "open-apron", and_paving({{"clutter_per_ha", "9"}, {"facade_distance_m", "30"}, {"with_markings", "false"}}));
}

TEST(Pier, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene("pier",
                                       and_paving({{"stands_per_side", "1"},
                                                   {"both_sides", "true"},
                                                   {"codes", "E"},
                                                   {"pitch_c_m", "45"},
                                                   {"pitch_e_m", "80"},
                                                   {"pier_width_m", "36"},
                                                   {"pier_length_m", "200"},
                                                   {"occupied_share", "0"},
                                                   {"equipment_density", "2"},
                                                   {"with_hall", "false"}}),
                                       {{"stands_per_side", "2"}, {"codes", "CE"}, {"both_sides", "false"}});
}

TEST(RemoteStand, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene(
      "remote-stand", and_paving({{"types", "[e190]"}, {"occupied_share", "0"}, {"equipment_density", "2"}}),
      {{"types", "[a320]"}});
}

TEST(Hangar, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene("hangar", and_paving({{"width_m", "60"},
                                                             {"depth_m", "55"},
                                                             {"door_width_m", "45"},
                                                             {"door_height_m", "14.5"},
                                                             {"eaves_m", "18"},
                                                             {"frame_pitch_m", "6"},
                                                             {"aircraft", "none"},
                                                             {"with_docking", "false"},
                                                             {"cabinets", "10"},
                                                             {"loose_items", "3"}}));
}

TEST(CargoYard, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene("cargo-yard", and_paving({{"shed_length_m", "150"},
                                                                 {"shed_height_m", "12"},
                                                                 {"fill_share", "0.2"},
                                                                 {"stacked_share", "1"},
                                                                 {"dolly_trains", "2"},
                                                                 {"truck_share", "0"},
                                                                 {"with_fence", "false"},
                                                                 {"freighter", "none"}}));
}

TEST(Aprons, ResolvedOptionsReadBackAsTheSameScene) {
  laws::resolved_options_make_the_same_scene("open-apron", "clutter_per_ha: 2.5\nfacade_distance_m: 0\n");
  laws::resolved_options_make_the_same_scene("remote-stand", "types: [a320, e190]\nundulation_mm: 5\n");
}

std::size_t instances_of(const Scene& scene, Label label) {
  return static_cast<std::size_t>(
      std::ranges::count_if(scene.instances, [&](const Instance& i) { return i.label == label; }));
}

TEST(Pier, HasABridgeAtEachStandAndAircraftOnTheShareThatIsOccupied) {
  const PierOptions defaults;
  const auto stands = pier_layout(defaults).stands.size();
  EXPECT_EQ(stands, 2U * static_cast<std::size_t>(defaults.stands_per_side));
  std::size_t aircraft = 0;
  constexpr int seeds = 6;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Scene scene = make_scene(laws::node_of("pier"), seed);
    EXPECT_EQ(instances_of(scene, Label::jet_bridge), stands);
    aircraft += instances_of(scene, Label::aircraft);
  }
  // Binomial, 48 stands at 0.8: three standard deviations are 8.3.
  EXPECT_NEAR(static_cast<double>(aircraft), 0.8 * seeds * static_cast<double>(stands), 8.3);
  EXPECT_EQ(instances_of(make_scene(laws::node_of("pier", "occupied_share: 0\n"), 1), Label::aircraft), 0U);
}

}  // namespace
}  // namespace tarmac::scenes
