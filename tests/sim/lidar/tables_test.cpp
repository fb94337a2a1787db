// The bundled tables against the fact sheets they were taken from, and the firing times against their formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "core/config.h"
#include "sim/lidar/firing.h"
#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

struct Sheet {
  const char* profile;
  const char* facts;
};
constexpr Sheet sheets[] = {{"hdl-64e-s2", "velodyne_hdl64e_s2"},
                            {"hdl-32e", "velodyne_hdl32e"},
                            {"vlp-16", "velodyne_vlp16"},
                            {"vls-128", "velodyne_vls128"},
                            {"ouster-os0-128-rev7", "ouster_os0_128_rev7"},
                            {"ouster-os1-128-rev7", "ouster_os1_128_rev7"},
                            {"ouster-os1-64-gen2", "ouster_os1_64_gen2"},
                            {"xt-32", "hesai_pandar_xt32"}};

struct Row {
  double elev_deg = 0, az_offset_cw_deg = 0, t_us = 0, vert_off_m = 0, horiz_off_m = 0;
  int ring = -1;
  void visit(core::OptionVisitor& v) {
    v("elev_deg", elev_deg, "");
    v("az_offset_cw_deg", az_offset_cw_deg, "");
    v("t_us", t_us, "");
    v("ring", ring, "");
    v("vert_off_m", vert_off_m, "");
    v("horiz_off_m", horiz_off_m, "");
  }
};

double or_0(const std::vector<double>& values, std::size_t c) {
  return values.empty() ? 0 : values[c];
}

TEST(Tables, HoldEveryNumberOfTheFactSheets) {
  const char* data = std::getenv("TARMAC_DATA");
  const fs::path folder = data ? fs::path(data) / ".." / "facts" / "sensors" : fs::path();
  if (!data || !fs::exists(folder)) {
    std::cerr << "\n*** NOT TESTED: sensor tables against their sheets. Set TARMAC_DATA to the data folder beside "
                 "facts/sensors. ***\n\n";
    GTEST_SKIP() << "TARMAC_DATA names no folder beside facts/sensors";
  }
  for (const Sheet& sheet : sheets) {
    const Profile& p = profile(sheet.profile);
    const ConfigNode facts = ConfigNode::load((folder / (std::string(sheet.facts) + ".json")).string());
    const std::vector<ConfigNode> rows = facts.child("channel_table").items();
    ASSERT_EQ(rows.size(), p.channels()) << sheet.profile;
    std::vector<bool> found(p.channels(), false);
    for (const ConfigNode& node : rows) {
      Row row;
      node.read(row, node.keys());
      const auto at = std::find(p.ring.begin(), p.ring.end(), row.ring);
      ASSERT_NE(at, p.ring.end()) << sheet.profile << " ring " << row.ring;
      const auto c = static_cast<std::size_t>(at - p.ring.begin());
      EXPECT_FALSE(found[c]);
      found[c] = true;
      EXPECT_EQ(p.elevation_deg[c], row.elev_deg) << sheet.profile << " channel " << c;
      EXPECT_EQ(p.azimuth_offset_cw_deg[c], row.az_offset_cw_deg) << sheet.profile << " channel " << c;
      EXPECT_EQ(p.firing_us[c], row.t_us) << sheet.profile << " channel " << c;
      EXPECT_EQ(or_0(p.origin_up_m, c), row.vert_off_m) << sheet.profile << " channel " << c;
      if (std::string(sheet.profile) != "xt-32") {  // its optical centre is a fact about the whole head
        EXPECT_EQ(or_0(p.origin_left_m, c), row.horiz_off_m) << sheet.profile << " channel " << c;
      }
    }
  }
}

/// A Pandar128's row: an empty text where the channel is silent.
struct PandarRow {
  double elev_deg = 0, az_offset_cw_deg = 0;
  int ring = -1;
  std::vector<double> state_us;  // NaN where silent
};

std::vector<PandarRow> pandar_rows(const fs::path& csv, const std::vector<std::string>& states) {
  std::ifstream file(csv);
  std::vector<PandarRow> rows;
  std::vector<std::string> names;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> fields;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    if (names.empty()) {
      names = fields;
      continue;
    }
    const auto value = [&](const std::string& name) {
      const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      return fields.at(at).empty() ? std::nan("") : std::stod(fields[at]);
    };
    PandarRow row{value("elev_deg"), value("az_offset_cw_deg"), static_cast<int>(value("ring")), {}};
    for (const std::string& state : states) row.state_us.push_back(value(state));
    rows.push_back(row);
  }
  return rows;
}

TEST(Tables, PandarStatesHoldEveryTimeOfTheSheet) {
  const char* data = std::getenv("TARMAC_DATA");
  const fs::path csv = data ? fs::path(data) / ".." / "facts" / "sensors" / "hesai_pandar128.csv" : fs::path();
  if (!data || !fs::exists(csv)) {
    std::cerr << "\n*** NOT TESTED: the Pandar128's states against their sheet. Set TARMAC_DATA. ***\n\n";
    GTEST_SKIP() << "TARMAC_DATA names no folder beside facts/sensors";
  }
  const std::pair<const char*, std::vector<std::string>> sheets_of_modes[] = {
      {"pandar128", {"std_s0_far_us", "std_s1_far_us"}},
      {"pandar128-high-res", {"hr_s0_us", "hr_s1_us", "hr_s2_us", "hr_s3_us"}}};
  for (const auto& [name, states] : sheets_of_modes) {
    const Profile& p = profile(name);
    const std::vector<PandarRow> rows = pandar_rows(csv, states);
    ASSERT_EQ(rows.size(), 128u);
    ASSERT_EQ(p.channels(), 128u);
    ASSERT_EQ(p.states.size(), states.size());
    for (std::size_t c = 0; c < rows.size(); ++c) {
      EXPECT_EQ(p.elevation_deg[c], rows[c].elev_deg);
      EXPECT_EQ(p.azimuth_offset_cw_deg[c], rows[c].az_offset_cw_deg);
      EXPECT_EQ(p.ring[c], rows[c].ring);
      for (std::size_t s = 0; s < states.size(); ++s)
        EXPECT_EQ(p.states[s].firing_us[c],
                  std::isnan(rows[c].state_us[s]) ? AzimuthState::silent : rows[c].state_us[s])
            << name << " channel " << c << " state " << s;
    }
  }
}

// Time of firing f of a sweep, in nanoseconds of the recording: f runs over cycles, then over channels.
std::int64_t firing_ns(const FiringTable& firing, const SweepSpan& sweep, std::int64_t cycle, std::size_t channel) {
  return core::to_ns(firing.cycle(sweep, cycle).t) + firing.offset_ns(channel);
}

TEST(FiringTimes, Hdl32LasersFireEvery1152Nanoseconds) {
  const FiringTable firing(profile("hdl-32e"), {0, 10});
  const SweepSpan sweep = firing.sweep(3);
  for (const std::int64_t s : {0, 1, 1000, 2169})
    for (std::size_t c = 0; c < 32; ++c)
      EXPECT_EQ(firing_ns(firing, sweep, s, c),
                (sweep.first_cycle + s) * 46'080 + static_cast<std::int64_t>(c) * 1'152);
  EXPECT_NEAR(1e9 / 46'080 * 32, 694'444, 1);  // returns a second
}

TEST(FiringTimes, Hdl64FiresPairsInGroupsOfFour) {
  const FiringTable firing(profile("hdl-64e-s2"), {0, 10});
  const SweepSpan sweep = firing.sweep(2);
  constexpr std::int64_t in_group_ns[] = {0, 1'260, 2'460, 3'660};
  for (const std::int64_t s : {0, 7, 2082})
    for (std::size_t c = 0; c < 64; ++c) {
      const std::size_t laser = c / 2;  // channels stand as 0, 32, 1, 33, ...
      EXPECT_EQ(
          firing_ns(firing, sweep, s, c),
          (sweep.first_cycle + s) * 48'000 + static_cast<std::int64_t>(laser / 4) * 6'000 + in_group_ns[laser % 4]);
    }
}

TEST(FiringTimes, Hdl64UpperAndLowerBankLookTheWayTheManualSays) {
  // x = r cos(el) sin(az) - h cos(az), y = r cos(el) cos(az) + h sin(az), z = r sin(el) + v in the maker's frame
  // (x right, y forward), az the encoder's azimuth with the channel's offset and the spin up to its firing.
  const Profile& p = profile("hdl-64e-s2");
  const FiringTable firing(p, {0, 15});
  const double rad = M_PI / 180, r = 23.4;
  for (const std::int64_t k : {0, 4})
    for (const std::int64_t s : {0, 333, 1200}) {
      const SweepSpan sweep = firing.sweep(k);
      const Cycle cycle = firing.cycle(sweep, s);
      for (std::size_t c = 0; c < p.channels(); ++c) {
        const double t_s = 48e-6 * static_cast<double>(sweep.first_cycle + s) + 1e-6 * p.firing_us[c];
        const double az = M_PI + 2 * M_PI * 15 * t_s + p.azimuth_offset_cw_deg[c] * rad, el = p.elevation_deg[c] * rad;
        const double h = p.origin_left_m[c], v = p.origin_up_m[c];
        const double x = r * std::cos(el) * std::sin(az) - h * std::cos(az),
                     y = r * std::cos(el) * std::cos(az) + h * std::sin(az), z = r * std::sin(el) + v;
        const Eigen::Vector3d point = firing.origin(cycle) + firing.origin_offset(cycle, c) +
                                      (r - firing.range_offset_m()) * firing.direction(cycle, c);
        EXPECT_LT((point - Eigen::Vector3d(y, -x, z)).norm(), 1e-9);
      }
    }
}

TEST(FiringTimes, Xt32ChannelsFollow6MicrosecondsAfterTheBlockEvery1512Nanoseconds) {
  const FiringTable firing(profile("xt-32"), {0, 10});
  const SweepSpan sweep = firing.sweep(5);
  EXPECT_EQ(sweep.cycles, 2000);  // 0.18 degrees
  // The maker's formula for block b of 8 in a packet whose stamp is that of its last block, n = 1 return:
  // t = t_packet + 5.632 us - 50 us (8 - b) + 0.368 us + 1.512 us (k - 1)
  for (const std::int64_t packet : {0, 100, 249})
    for (std::int64_t b = 1; b <= 8; ++b)
      for (std::int64_t k = 1; k <= 32; ++k) {
        const std::int64_t t_packet_ns = (sweep.first_cycle + packet * 8 + 7) * 50'000;
        const std::int64_t expected = t_packet_ns + 5'632 - 50'000 * (8 - b) + 368 + 1'512 * (k - 1);
        EXPECT_EQ(firing_ns(firing, sweep, packet * 8 + b - 1, static_cast<std::size_t>(k - 1)), expected);
      }
  // The last channel fires after the next block's stamp, and before its first channel.
  EXPECT_GT(firing.offset_ns(31), 50'000);
  EXPECT_LT(firing.offset_ns(31), 50'000 + firing.offset_ns(0));
}

TEST(FiringTimes, Xt32BeamsLeaveTheOpticalCentreAheadAndLeftOfTheAxis) {
  const FiringTable firing(profile("xt-32"), {0, 10});
  const SweepSpan sweep = firing.sweep(0);
  const Cycle cycle = firing.cycle(sweep, 0);  // the head looks forward, but for 6 microseconds of spin
  const Eigen::Vector3d o = firing.origin(cycle) + firing.origin_offset(cycle, 0);
  const double spin = 2 * M_PI * 10 * 6e-6;
  EXPECT_NEAR(o.x(), 0.0315 * std::cos(spin) + 0.013 * std::sin(spin), 1e-12);
  EXPECT_NEAR(o.y(), 0.013 * std::cos(spin) - 0.0315 * std::sin(spin), 1e-12);
  EXPECT_NEAR(o.z(), 0, 1e-12);
}

TEST(FiringTimes, Vls128GroupsOfEightFollowTheFormula) {
  const Profile& p = profile("vls-128");
  const FiringTable firing(p, {0, 10});
  const SweepSpan sweep = firing.sweep(4);
  for (const std::int64_t s : {0, 1, 900, 1875})
    for (std::int64_t i = 0; i < 128; ++i) {
      // t = 53.3 us sequence + 2.665 us (floor(i / 8) + floor(i / 64)); azimuth by the spin up to then.
      const std::int64_t in_cycle_ns = 2'665 * (i / 8 + i / 64), t_ns = (sweep.first_cycle + s) * 53'300 + in_cycle_ns;
      const auto c = static_cast<std::size_t>(i);
      ASSERT_EQ(firing_ns(firing, sweep, s, c), t_ns);
      const double rad = M_PI / 180, el = p.elevation_deg[c] * rad;
      const double az = M_PI + 2 * M_PI * 10 * 1e-9 * static_cast<double>(t_ns) + p.azimuth_offset_cw_deg[c] * rad;
      const Eigen::Vector3d expected(std::cos(el) * std::cos(az), -std::cos(el) * std::sin(az), std::sin(el));
      ASSERT_LT((firing.direction(firing.cycle(sweep, s), c) - expected).norm(), 1e-9);
    }
  EXPECT_NEAR(1e9 / 53'300 * 128, 2'401'501, 1);  // returns a second
}

TEST(FiringTimes, PandarBlocksFireInTheOrderOfTheirStates) {
  for (const char* name : {"pandar128", "pandar128-high-res"}) {
    const Profile& p = profile(name);
    const FiringTable firing(p, {0, 10});
    const auto states = static_cast<std::int64_t>(p.states.size());
    const auto block_ns = std::llround(p.cycle_us * 1e3);
    ASSERT_EQ(firing.blocks(), p.states.size());
    const SweepSpan sweep = firing.sweep(3);
    const double rad = M_PI / 180;
    std::multiset<std::pair<std::size_t, std::size_t>> fired;  // block, channel
    for (std::size_t i = 0; i < firing.channels(); ++i) {
      const std::size_t c = firing.channel_of(i), s = firing.block_of(i);
      fired.insert({s, c});
      EXPECT_EQ(firing.ring(i), p.ring[c]);
      for (const std::int64_t k : {0, 100, 898}) {
        const std::int64_t block = (sweep.first_cycle + k) * states + static_cast<std::int64_t>(s);
        const std::int64_t t_ns = block * block_ns + std::llround(p.states[s].firing_us[c] * 1e3);
        ASSERT_EQ(firing_ns(firing, sweep, k, i), t_ns) << name;
        // Block azimuth plus the spin up to the firing.
        const double az = 2 * M_PI * 10 * 1e-9 * static_cast<double>(t_ns) + p.azimuth_offset_cw_deg[c] * rad,
                     el = p.elevation_deg[c] * rad;
        const Eigen::Vector3d expected(std::cos(el) * std::cos(az), -std::cos(el) * std::sin(az), std::sin(el));
        ASSERT_LT((firing.direction(firing.cycle(sweep, k), i) - expected).norm(), 1e-8) << name;
      }
    }
    for (std::size_t s = 0; s < p.states.size(); ++s)
      for (std::size_t c = 0; c < 128; ++c)
        EXPECT_EQ(fired.count({s, c}), p.states[s].firing_us[c] == AzimuthState::silent ? 0u : 1u);
  }
  const auto points_a_second = [](const char* name) {
    const FiringTable firing(profile(name), {0, 10});
    return static_cast<double>(firing.sweep(99).first_cycle + firing.sweep(99).cycles) / 10 *
           static_cast<double>(firing.channels());
  };
  EXPECT_NEAR(points_a_second("pandar128"), 2'304'000, 0.0005 * 2'304'000);
  EXPECT_NEAR(points_a_second("pandar128-high-res"), 3'456'000, 0.0005 * 3'456'000);
}

TEST(FiringTimes, FiringsOfEverySensorAscendAcrossCyclesAndSweeps) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const FiringTable firing(p, mode_of(p, 0, 0));
    std::int64_t last_ns = -1, cycle_start_ns = -1;
    for (std::int64_t k = 0; k < 3; ++k) {
      const SweepSpan sweep = firing.sweep(k);
      EXPECT_EQ(core::to_ns(sweep.begin), firing_ns(firing, sweep, 0, 0)) << name;
      for (std::int64_t s = 0; s < sweep.cycles; ++s) {
        ASSERT_GT(firing_ns(firing, sweep, s, 0), cycle_start_ns) << name;
        cycle_start_ns = firing_ns(firing, sweep, s, 0);
        for (std::size_t c = 0; c < firing.channels(); ++c) {
          ASSERT_GE(firing_ns(firing, sweep, s, c), last_ns + (c == 0 ? 1 : 0)) << name;
          last_ns = firing_ns(firing, sweep, s, c);
        }
      }
      EXPECT_EQ(core::to_ns(sweep.end), last_ns) << name;
    }
  }
}

TEST(FiringTimes, RevolutionsHoldTheStepsOfTheDataSheets) {
  const auto step_deg = [](const char* name) {
    const FiringTable firing(profile(name), mode_of(profile(name), 0, 0));
    return 360.0 * 200 / static_cast<double>(firing.sweep(200).first_cycle - firing.sweep(0).first_cycle);
  };
  EXPECT_NEAR(step_deg("hdl-64e-s2"), 0.1728, 5e-5);
  EXPECT_NEAR(step_deg("hdl-32e"), 0.1659, 5e-5);
  EXPECT_NEAR(step_deg("vlp-16"), 0.1991, 5e-5);
  EXPECT_NEAR(step_deg("xt-32"), 0.18, 5e-5);
  EXPECT_NEAR(step_deg("ouster-os1-128-rev7"), 0.3515625, 1e-9);
  EXPECT_NEAR(step_deg("ouster-os0-128-rev7"), 0.3515625, 1e-9);
  EXPECT_NEAR(step_deg("vls-128"), 0.1919, 5e-5);
  EXPECT_NEAR(step_deg("pandar128") / 2, 0.2, 5e-5);           // two blocks a cycle
  EXPECT_NEAR(step_deg("pandar128-high-res") / 4, 0.1, 5e-5);  // four
}

}  // namespace
}  // namespace tarmac::sim::lidar
