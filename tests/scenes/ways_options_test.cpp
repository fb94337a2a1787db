// Options of taxiway, runway crossing, road tunnel, baggage tunnel: each matters, and what does not fit is an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/error.h"
#include "tests/scenes/fingerprint.h"

namespace tarmac::scenes {
namespace {

using testing::HasSubstr;
using tests::fingerprint;
using tests::node;

/// `other` holds a value for every option; what `base` sets is replaced.
void expect_every_option_to_matter(const std::string& kind, const std::map<std::string, std::string>& base,
                                   const std::map<std::string, std::string>& other) {
  const auto made = [&](std::map<std::string, std::string> options) {
    std::string yaml = "kind: " + kind + "\n";
    for (const auto& [name, value] : options) yaml += name + ": " + value + "\n";
    return fingerprint(make_scene(node(yaml), 1));
  };
  const std::string plain = made(base);
  for (const core::OptionDescription& option : scene_of(node("kind: " + kind + "\n")).describe()) {
    ASSERT_TRUE(other.contains(option.name)) << option.name << " is not tested";
    std::map<std::string, std::string> changed = base;
    changed[option.name] = other.at(option.name);
    EXPECT_NE(plain, made(changed)) << option.name;
  }
}

TEST(Taxiway, EveryOptionChangesTheScene) {
  expect_every_option_to_matter(
      "taxiway",
      {{"shape", "curve"}, {"length_m", "300"}, {"grass_m", "30"}, {"turn_radius_m", "60"}, {"code_letter", "C"}},
      {{"shape", "straight"},
       {"code_letter", "B"},
       {"length_m", "320"},
       {"turn_deg", "60"},
       {"turn_radius_m", "70"},
       {"longitudinal_slope_percent", "1"},
       {"transverse_slope_percent", "1"},
       {"undulation_mm", "2"},
       {"relief_rms_mm", "1"},
       {"swale_depth_m", "0.2"},
       {"grass_m", "40"},
       {"with_parallel", "false"},
       {"with_lights", "false"},
       {"light_spacing_m", "30"},
       {"curve_light_spacing_m", "15"},
       {"with_signs", "false"},
       {"sign_spacing_m", "100"},
       {"with_drains", "false"},
       {"drain_spacing_m", "80"},
       {"huts", "0"}});
}

TEST(RunwayCrossing, EveryOptionChangesTheScene) {
  expect_every_option_to_matter(
      "runway-crossing",
      {{"threshold_west_m", "160"}, {"runway_east_m", "100"}, {"taxiway_south_m", "180"}, {"taxiway_north_m", "150"}},
      {{"runway_width_m", "40"},       {"runway_shoulder_m", "5"},
       {"crown_percent", "1"},         {"longitudinal_slope_percent", "0"},
       {"undulation_mm", "2"},         {"relief_rms_mm", "1"},
       {"threshold_west_m", "170"},    {"runway_east_m", "120"},
       {"code_letter", "C"},           {"fillet_radius_m", "30"},
       {"holding_distance_m", "95"},   {"taxiway_south_m", "190"},
       {"taxiway_north_m", "160"},     {"with_road", "false"},
       {"road_behind_hold_m", "45"},   {"with_lights", "false"},
       {"edge_light_spacing_m", "30"}, {"with_stop_bars", "false"},
       {"with_signs", "false"},        {"with_papi", "false"},
       {"with_windsock", "false"},     {"grass_m", "30"}});
}

TEST(RoadTunnel, EveryOptionChangesTheScene) {
  expect_every_option_to_matter("road-tunnel", {{"length_m", "120"}, {"niches", "true"}},
                                {{"length_m", "130"},
                                 {"width_m", "10"},
                                 {"height_m", "5"},
                                 {"ramp_percent", "5"},
                                 {"vertical_curve_m", "250"},
                                 {"cover_m", "1.5"},
                                 {"walkway_m", "0.6"},
                                 {"niches", "false"},
                                 {"niche_spacing_m", "80"},
                                 {"with_wall_lights", "false"},
                                 {"light_spacing_m", "12"},
                                 {"undulation_mm", "2"},
                                 {"relief_rms_mm", "1"},
                                 {"with_taxiway", "false"}});
}

TEST(BaggageTunnel, EveryOptionChangesTheScene) {
  expect_every_option_to_matter("baggage-tunnel", {},
                                {{"width_m", "5"},
                                 {"height_m", "3"},
                                 {"turn_radius_m", "9"},
                                 {"ramp_percent", "5"},
                                 {"drop_m", "1"},
                                 {"rise_m", "0"},
                                 {"north_leg_m", "40"},
                                 {"last_leg_m", "50"},
                                 {"with_junction", "false"},
                                 {"with_trays", "false"},
                                 {"with_lamps", "false"},
                                 {"with_hall", "false"},
                                 {"hall_clear_m", "5"},
                                 {"column_pitch_m", "9"},
                                 {"column_m", "0.8"},
                                 {"carousels", "2"},
                                 {"carts", "3"},
                                 {"undulation_mm", "4"},
                                 {"relief_rms_mm", "1"}});
}

std::string message_of(const std::string& yaml) {
  try {
    make_scene(node(yaml), 1);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Ways, OptionsThatDoNotFitTogetherAreErrorsWithTheirLine) {
  const std::string steep = message_of("kind: taxiway\ncode_letter: E\nlongitudinal_slope_percent: 2\n");
  EXPECT_THAT(steep, HasSubstr("scenario.yaml:3"));
  EXPECT_THAT(steep, HasSubstr("code letter E"));
  EXPECT_EQ(message_of("kind: taxiway\ncode_letter: A\nlength_m: 200\nlongitudinal_slope_percent: 2\n"), "no error");
  EXPECT_THAT(message_of("kind: taxiway\ntransverse_slope_percent: 1.8\n"), HasSubstr("scenario.yaml:2"));
  EXPECT_THAT(message_of("kind: taxiway\nshape: curve\ncode_letter: F\nturn_radius_m: 40\n"),
              HasSubstr("turn_radius_m"));
  EXPECT_THAT(message_of("kind: taxiway\nshape: curve\nlength_m: 200\n"), HasSubstr("length_m"));
  EXPECT_THAT(message_of("kind: runway-crossing\nholding_distance_m: 85\nfillet_radius_m: 45\nrunway_shoulder_m: 15\n"),
              HasSubstr("holding_distance_m"));
  EXPECT_THAT(message_of("kind: runway-crossing\nroad_behind_hold_m: 120\ntaxiway_south_m: 200\n"),
              HasSubstr("road_behind_hold_m"));
  EXPECT_THAT(message_of("kind: baggage-tunnel\nrise_m: 2\nramp_percent: 3\nlast_leg_m: 60\n"),
              HasSubstr("last_leg_m"));
  EXPECT_THAT(message_of("kind: road-tunnel\nnichse: true\n"), HasSubstr("did you mean 'niches'"));
}

}  // namespace
}  // namespace tarmac::scenes
