// The scenes that are controls from elsewhere, held to the laws of all scenes.
#include "tests/scenes/laws.h"

#include <iostream>

namespace tarmac::scenes {
namespace {

namespace laws = tests::laws;

struct Kind {
  std::string name;
  std::map<std::string, std::string> other;       ///< a value unlike the default for every option
  std::string some;                               ///< options for the round trip
  std::map<std::string, std::string> small = {};  ///< options that keep the scene small
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"corridor",
       {{"length_m", "60"},
        {"width_m", "4"},
        {"height_m", "3"},
        {"door_pitch_m", "0"},
        {"light_pitch_m", "0"},
        {"features_per_10m", "0"},
        {"floor_undulation_mm", "0"}},
       "length_m: 50\ndoor_pitch_m: 4\n"},
      {"warehouse",
       {{"aisles", "2"},
        {"aisle_width_m", "4"},
        {"bays", "6"},
        {"levels", "2"},
        {"level_height_m", "2.2"},
        {"fill", "0.3"},
        {"load_variation", "0"},
        {"staged_pallets", "0"},
        {"docks", "2"},
        {"column_pitch_m", "0"},
        {"floor_undulation_mm", "0"}},
       "aisles: 2\nbays: 6\nfill: 0.5\n"},
      {"urban-block",
       {{"block_x_m", "60"},
        {"block_y_m", "50"},
        {"outlook_m", "30"},
        {"carriageway_m", "7"},
        {"sidewalk_m", "3.5"},
        {"kerb_mm", "80"},
        {"storeys", "3"},
        {"parked_share", "0.2"},
        {"tree_pitch_m", "0"},
        {"lamp_pitch_m", "0"},
        {"crossfall_percent", "0"},
        {"undulation_mm", "0"},
        {"relief_rms_mm", "1"}},
       "block_x_m: 50\nstoreys: 2.5\n",
       {{"outlook_m", "25"}, {"block_x_m", "44"}, {"block_y_m", "44"}}},
      {"highway",
       {{"length_m", "2000"},
        {"radius_m", "1200"},
        {"turn_deg", "0"},
        {"grade_percent", "0"},
        {"lanes", "3"},
        {"lane_m", "3.5"},
        {"median_m", "6"},
        {"crossfall_percent", "2"},
        {"undulation_mm", "0"},
        {"relief_rms_mm", "0"},
        {"guard_rails", "false"},
        {"post_pitch_m", "2"},
        {"noise_barrier", "both"},
        {"gantry_pitch_m", "0"},
        {"sign_pitch_m", "0"},
        {"delineator_pitch_m", "0"},
        {"trees", "0"},
        {"parked_vehicles", "0"}},
       "length_m: 400\nturn_deg: 0\nnoise_barrier: right\n",
       {{"length_m", "700"}, {"turn_deg", "8"}, {"gantry_pitch_m", "200"}, {"sign_pitch_m", "150"}, {"trees", "12"}}},
      {"rough-hills",
       {{"relief_m", "2"},
        {"longest_m", "120"},
        {"shortest_m", "25"},
        {"roughness", "1.2"},
        {"texture_rms_mm", "0"},
        {"rocks", "10"},
        {"trees", "10"},
        {"lane_m", "8"},
        {"half_size_m", "140"}},
       "relief_m: 3\ntrees: 5\nhalf_size_m: 120\n",
       {{"half_size_m", "120"}, {"trees", "4"}, {"rocks", "30"}}}};
  return all;
}

/// With its defaults and seed 1, built once.
const Scene& scene_of_kind(const std::string& kind) {
  static std::map<std::string, Scene> scenes;
  if (!scenes.contains(kind)) scenes.emplace(kind, make_scene(laws::node_of(kind), 1));
  return scenes.at(kind);
}

class ControlScene : public testing::TestWithParam<Kind> {
 protected:
  const Scene& scene() const { return scene_of_kind(GetParam().name); }
};

TEST_P(ControlScene, HasFewerThanFourHundredThousandTriangles) {
  std::cout << GetParam().name << ": " << scene().triangle_count() << " triangles, " << scene().instances.size()
            << " instances\n";
  EXPECT_LT(scene().triangle_count(), 400000u);
  EXPECT_GT(scene().triangle_count(), 1000u);
}

TEST_P(ControlScene, EveryTriangleIsFiniteNotDegenerateAndOfAKnownMaterial) {
  laws::every_triangle_is_sound(scene());
}

TEST_P(ControlScene, InstancesReferToMeshesAndHaveALabel) {
  laws::instances_are_sound(scene());
}

TEST_P(ControlScene, SolidsAreClosedAndFaceOutward) {
  laws::solids_are_closed_and_face_outward(scene());
}

TEST_P(ControlScene, GroundFacesUp) {
  laws::ground_faces_up(scene());
}

TEST_P(ControlScene, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  laws::seed_decides_the_bytes(GetParam().name);
}

TEST_P(ControlScene, EveryOptionChangesTheScene) {
  laws::every_option_changes_the_scene(GetParam().name, GetParam().other, GetParam().small);
}

TEST_P(ControlScene, ResolvedOptionsReadBackAsTheSameScene) {
  laws::resolved_options_make_the_same_scene(GetParam().name, GetParam().some);
}

TEST_P(ControlScene, EntryGivesTheSameGroundAsTheScene) {
  laws::ground_alone_is_the_scenes_ground(GetParam().name, scene());
}

std::string name_of_case(const testing::TestParamInfo<Kind>& kind) {
  std::string name = kind.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ControlScene, testing::ValuesIn(kinds()), name_of_case);

}  // namespace
}  // namespace tarmac::scenes
