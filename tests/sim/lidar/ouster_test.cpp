// Sensors built from the metadata that Ouster sensors tell of themselves, and recorded column times fired at again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/recording.h"
#include "sim/lidar/ouster_metadata.h"
#include "sim/lidar/profile_file.h"
#include "sim/rig_options.h"
#include "sim/simulate.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"
#include "tests/support/constants.h"

namespace tarmac::sim {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;
using Eigen::Vector3d;
using tests::rad;

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}

class TemporaryFolder : public testing::Test {
 protected:
  fs::path folder = fs::path(testing::TempDir()) /
                    ("tarmac_ouster_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  fs::path write(const std::string& name, const std::string& text) const {
    core::write_file(folder / name, text);
    return folder / name;
  }
};

/// What stands in the capture's metadata, read without the code under test.
struct Angles {
  std::vector<double> beam_altitude_angles, beam_azimuth_angles;
  void visit(core::OptionVisitor& v) {
    v("beam_altitude_angles", beam_altitude_angles, "");
    v("beam_azimuth_angles", beam_azimuth_angles, "");
  }
};

/// A closed room about the origin: every beam returns.
scenes::Scene room() {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::sphere(20, 40, 80), tests::pose({0, 0, 0}));
  return scene;
}

core::Recording simulated(const fs::path& folder, const std::string& rig) {
  SimulationInput input;
  input.scenario_name = "room";
  input.duration = core::duration_from_s(0.301);
  input.scene = std::make_shared<scenes::Scene>(room());
  input.motion = std::make_shared<tests::SteadyMotion>();
  input.rig = ConfigNode::parse(rig, "test.yaml");
  input.resolved_scenario = "name: room\nseed: 1\nduration_s: 1\nscene: {kind: stand}\nmotion: {kind: still}\n";
  input.resolved_motion = "  kind: still\n";
  simulate(input, {.threads = 1, .fast = false}, folder / "recording", folder / "truth",
           [](double, const std::string&) {});
  return core::Recording::open(folder / "recording");
}

class OusterCapture : public TemporaryFolder {
 protected:
  fs::path data, metadata;
  Angles angles;
  void SetUp() override {
    const char* named = std::getenv("TARMAC_DATA");
    data = named ? fs::path(named) / "ouster" : fs::path();
    metadata = data / "OS-1-128_v2.3.0_1024x10.json";
    if (!named || !fs::exists(metadata)) {
      std::cerr
          << "\n*** NOT TESTED: the real sensor's metadata. Set TARMAC_DATA to the folder that holds ouster. ***\n\n";
      GTEST_SKIP() << "TARMAC_DATA names no folder with ouster/";
    }
    TemporaryFolder::SetUp();
    const ConfigNode node = ConfigNode::load(metadata.string());
    node.read(angles, node.keys());
    ASSERT_EQ(angles.beam_altitude_angles.size(), 128u);
  }
  std::string rig(const std::string& more = "") const {
    return "lidar: {model: '" + metadata.string() +
           "', noise: {range_scale: 0, channel_bias_scale: 0, quantisation: false, dropout: false, intensity: false}" +
           more + "}\n";
  }
  struct Point {
    float x, y, z, intensity, t;
  };
  std::vector<Point> captured(int sweep) const {
    const std::string bytes = core::read_file(data / "plain" / "lidar" / fmt_name(sweep));
    std::vector<Point> points(bytes.size() / sizeof(Point));
    std::memcpy(points.data(), bytes.data(), points.size() * sizeof(Point));
    return points;
  }
  static std::string fmt_name(int sweep) { return "00000" + std::to_string(sweep) + ".bin"; }
  std::vector<float> captured_column_times(int sweep) const {
    std::set<float> times;
    for (const Point& point : captured(sweep)) times.insert(point.t);
    return {times.begin(), times.end()};
  }
};

TEST_F(OusterCapture, EveryPixelOfASimulatedSweepHasTheAnglesOfTheMetadata) {
  const core::Recording recording = simulated(folder, rig());
  ASSERT_EQ(recording.sweep_count(), 3u);
  double worst_elevation_deg = 0, worst_azimuth_deg = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const core::LidarSweep sweep = recording.sweep(k);
    ASSERT_EQ(sweep.size(), 1024u * 128);  // every pixel returns
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const std::size_t row = 127u - sweep.ring[i], column = i / 128;
      ASSERT_NEAR(sweep.t_ns[i], static_cast<double>(column) * 97656.25, 0.51);  // nominal, to the rounding
      // Back to the LiDAR frame, less the circle that the beams leave from.
      const double encoder = 2 * M_PI * (1 - static_cast<double>(column) / 1024);
      const Vector3d p_lidar(-sweep.x_m[i], -sweep.y_m[i], sweep.z_m[i] - 0.03618);
      const Vector3d d = p_lidar - 0.015806 * Vector3d(std::cos(encoder), std::sin(encoder), 0);
      const double elevation_deg = std::atan2(d.z(), d.head<2>().norm()) / rad;
      const double azimuth_deg = wrapped(encoder - std::atan2(d.y(), d.x())) / rad;
      worst_elevation_deg = std::max(worst_elevation_deg, std::abs(elevation_deg - angles.beam_altitude_angles[row]));
      worst_azimuth_deg = std::max(worst_azimuth_deg, std::abs(azimuth_deg - angles.beam_azimuth_angles[row]));
    }
  }
  // The metadata has two decimals; points are float32, which at 20 m is 6e-6 degrees.
  EXPECT_LT(worst_elevation_deg, 2e-5);
  EXPECT_LT(worst_azimuth_deg, 2e-5);
  std::cout << "largest deviation from the metadata's angles: elevation " << worst_elevation_deg << " deg, azimuth "
            << worst_azimuth_deg << " deg\n";
}

TEST_F(OusterCapture, ModesOfTheMetadataKeepTheAngles) {
  const lidar::Profile p = lidar::load_profile(metadata);
  EXPECT_EQ(p.default_mode, "1024x10");
  EXPECT_EQ(p.range_step_m, 0.008);  // the low-rate packet format
  EXPECT_EQ(p.elevation_deg, angles.beam_altitude_angles);
  EXPECT_EQ(p.azimuth_offset_cw_deg, angles.beam_azimuth_angles);
  EXPECT_EQ(lidar::FiringTable(p, lidar::mode_of(p, 2048, 10)).sweep(0).cycles, 2048);
}

TEST_F(OusterCapture, EveryPointOfTheRealCaptureLiesOnABeamOfTheSimulatedSensor) {
  // 322,536 points that the sensor itself measured: had a sign, a frame or the order of columns been wrong, none would.
  const lidar::Profile p = lidar::load_profile(metadata);
  const lidar::FiringTable firing(p, {1024, 10});
  const lidar::SweepSpan span = firing.sweep(0);
  std::size_t points = 0;
  double worst_rad = 0, worst_step_m = 0;
  for (int k = 0; k < 3; ++k) {
    const std::vector<float> times = captured_column_times(k);
    ASSERT_EQ(times.size(), 1024u);
    std::vector<std::array<Vector3d, 129>> columns;  // origin, then the beams
    for (std::int64_t m = 0; m < 1024; ++m) {
      const lidar::Cycle cycle = firing.cycle(span, m);
      std::array<Vector3d, 129> column;
      column[0] = firing.origin(cycle);
      for (std::size_t c = 0; c < 128; ++c) column[c + 1] = firing.direction(cycle, c);
      columns.push_back(column);
    }
    for (const Point& point : captured(k)) {
      const auto column = std::lower_bound(times.begin(), times.end(), point.t) - times.begin();
      const auto& beams = columns[static_cast<std::size_t>(column)];
      const Vector3d from_origin = Vector3d(point.x, point.y, point.z) - beams[0];
      double nearest = 1;
      for (std::size_t c = 1; c < beams.size(); ++c)
        if (beams[c].dot(from_origin) > 0.999 * from_origin.norm())
          nearest = std::min(nearest, beams[c].cross(from_origin).norm() / from_origin.norm());
      worst_rad = std::max(worst_rad, nearest);
      const double raw_m = from_origin.norm() + firing.range_offset_m();
      worst_step_m = std::max(worst_step_m, std::abs(std::remainder(raw_m, 0.008)) - 2e-7 * raw_m);
      ++points;
    }
  }
  EXPECT_GT(points, 300'000u);
  EXPECT_LT(worst_rad, 3e-7);     // float32 coordinates: 1.2e-7, and more close by
  EXPECT_LT(worst_step_m, 1e-6);  // raw ranges are whole steps of 8 mm, counted from the spin axis
  std::cout << points << " captured points, largest angle off a simulated beam " << worst_rad << " rad\n";
}

TEST_F(OusterCapture, ReplayedColumnTimesEqualThePlainFilesBitForBit) {
  const core::Recording recording = simulated(folder, rig(", column_times: '" + (data / "plain").string() + "'"));
  ASSERT_EQ(recording.sweep_count(), 3u);
  std::istringstream stamps(core::read_file(data / "plain" / "lidar" / "stamps.txt"));
  std::int64_t start_ns = 0;
  for (int k = 0; k < 3; ++k) {
    const core::LidarSweep sweep = recording.sweep(static_cast<std::size_t>(k));
    const std::vector<float> times = captured_column_times(k);
    ASSERT_EQ(sweep.size(), 1024u * 128);
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const float t_s = static_cast<float>(static_cast<double>(sweep.t_ns[i]) * 1e-9);  // as a plain folder stores it
      ASSERT_EQ(std::memcmp(&t_s, &times[i / 128], sizeof t_s), 0) << "sweep " << k << ", column " << i / 128;
    }
    std::int64_t begin_ns = 0, end_ns = 0;
    stamps >> begin_ns >> end_ns;
    if (k == 0) start_ns = begin_ns;
    EXPECT_EQ(core::to_ns(sweep.begin), begin_ns - start_ns);
    EXPECT_EQ(core::to_ns(sweep.end), end_ns - start_ns);
  }
}

TEST_F(OusterCapture, ColumnTimesWithoutReplayLieWithinATenthOfAMillisecondOfTheCaptures) {
  const lidar::Profile p = lidar::load_profile(metadata);
  const lidar::FiringTable firing(p, {1024, 10});
  double worst_s = 0;
  for (int k = 0; k < 3; ++k) {
    const std::vector<float> times = captured_column_times(k);
    const lidar::SweepSpan span = firing.sweep(k);
    for (std::int64_t m = 0; m < 1024; ++m) {
      const double nominal_s = 1e-9 * static_cast<double>((firing.cycle(span, m).t - span.begin).count());
      EXPECT_NEAR(nominal_s, static_cast<double>(m) * 97.65625e-6, 1e-9);
      worst_s = std::max(worst_s, std::abs(nominal_s - static_cast<double>(times[static_cast<std::size_t>(m)])));
    }
  }
  EXPECT_LT(worst_s, 0.1e-3);
  std::cout << "largest distance of nominal from captured column times: " << worst_s * 1e3 << " ms\n";
}

TEST_F(OusterCapture, ResolvedScenarioHoldsSensorAndTimesAndGivesTheSameRecording) {
  const std::string with_files = rig(", column_times: '" + (data / "plain").string() + "'");
  const std::string resolved = resolve_rig(ConfigNode::parse(with_files, "test.yaml"));
  EXPECT_EQ(resolved.find(data.string()), std::string::npos);
  EXPECT_EQ(resolve_rig(ConfigNode::parse(resolved, "resolved.yaml")), resolved);
  EXPECT_EQ(simulated(folder / "a", with_files).hash(), simulated(folder / "b", resolved).hash());
}

// A small sensor of our own in both layouts.
constexpr const char* flat = R"({
  "beam_altitude_angles": [10.5, 3.25, -3.0, -11.0],
  "beam_azimuth_angles": [3.1, 1.0, -1.0, -3.1],
  "data_format": {"columns_per_frame": 512, "columns_per_packet": 16, "column_window": [0, 511],
                  "pixel_shift_by_row": [6, 2, -2, -6], "pixels_per_column": 4,
                  "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"},
  "lidar_mode": "512x20",
  "lidar_origin_to_beam_origin_mm": 15.806,
  "lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1],
  "prod_line": "OS-1-4", "prod_sn": "1"
})";
constexpr const char* nested = R"({
	"beam_intrinsics": {"beam_altitude_angles": [10.5, 3.25, -3.0, -11.0],
		"beam_azimuth_angles": [3.1, 1.0, -1.0, -3.1], "lidar_origin_to_beam_origin_mm": 15.806,
		"beam_to_lidar_transform": [1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
	"calibration_status": {"reflectivity": {"valid": true}},
	"config_params": {"lidar_mode": "512x20", "udp_dest": "fe80::1", "azimuth_window": [0, 360000]},
	"imu_intrinsics": {"imu_to_sensor_transform": [1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1]},
	"lidar_data_format": {"columns_per_frame": 512, "columns_per_packet": 16, "column_window": [0, 511],
		"pixel_shift_by_row": [6, 2, -2, -6], "pixels_per_column": 4, "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"},
	"lidar_intrinsics": {"lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1]},
	"sensor_info": {"prod_line": "OS-1-4", "prod_sn": "1"}
})";

class OusterMetadata : public TemporaryFolder {
 protected:
  static std::string with(std::string text, const std::string& what, const std::string& instead) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  }
  lidar::Profile loaded(const std::string& json) const { return lidar::load_profile(write("sensor.json", json)); }
  void expect_refused(const std::string& json, const std::vector<std::string>& words) const {
    std::string message;
    try {
      loaded(json);
    } catch (const core::InputError& error) {
      message = error.what();
    }
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
};

TEST_F(OusterMetadata, BothLayoutsSayTheSame) {
  lidar::Profile old_layout = loaded(flat), new_layout = loaded(nested);
  EXPECT_EQ(core::write_options(old_layout), core::write_options(new_layout));
  EXPECT_EQ(old_layout.default_mode, "512x20");
  EXPECT_EQ(old_layout.ring, (std::vector<double>{3, 2, 1, 0}));
  EXPECT_EQ(old_layout.azimuth_start_deg, 180);
  EXPECT_DOUBLE_EQ(old_layout.beam_origin_radius_m, 0.015806);
  EXPECT_DOUBLE_EQ(old_layout.beam_origin_height_m, 0.03618);
  EXPECT_EQ(old_layout.range_80_percent_m, lidar::profile("ouster-os1-64-gen2").range_80_percent_m);
}

TEST_F(OusterMetadata, BundledSensorComesOutOfMetadataWithItsNumbers) {
  const lidar::Profile& bundled = lidar::profile("ouster-os1-64-gen2");
  std::string altitude, azimuth;
  for (std::size_t c = 0; c < bundled.channels(); ++c) {
    altitude += (c ? ", " : "") + std::to_string(bundled.elevation_deg[c]);
    azimuth += (c ? ", " : "") + std::to_string(bundled.azimuth_offset_cw_deg[c]);
  }
  const lidar::Profile p =
      loaded("{\"beam_altitude_angles\": [" + altitude + "], \"beam_azimuth_angles\": [" + azimuth +
             "], \"lidar_mode\": \"1024x10\", \"lidar_origin_to_beam_origin_mm\": 15.806, \"prod_line\": \"OS-1-64\"}");
  for (const lidar::ChannelColumn& column : lidar::channel_columns())
    EXPECT_EQ(p.*column.values, bundled.*column.values) << column.name;
  EXPECT_EQ(p.modes, bundled.modes);
  EXPECT_DOUBLE_EQ(p.beam_origin_radius_m, bundled.beam_origin_radius_m);
  EXPECT_DOUBLE_EQ(p.beam_origin_height_m, bundled.beam_origin_height_m);
  EXPECT_DOUBLE_EQ(p.range_offset_m, bundled.range_offset_m);
  EXPECT_EQ(p.sigma_m, bundled.sigma_m);
  EXPECT_NE(p.source.find("sensor frame not told"), std::string::npos);  // what was not in the file is said
}

TEST_F(OusterMetadata, RaisedBeamOriginFollowsTheMakersFormula) {
  const lidar::Profile p = loaded(
      with(nested, "[1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 0,", "[1, 0, 0, 13.762, 0, 1, 0, 0, 0, 0, 1, 27.397,"));
  const lidar::FiringTable firing(p, {512, 20});
  const double nx = 0.013762, nz = 0.027397, r = 31.5;
  for (const std::int64_t m : {0, 100, 511})
    for (std::size_t c = 0; c < 4; ++c) {
      const double e = 2 * M_PI * (1 - static_cast<double>(m) / 512), a = e - p.azimuth_offset_cw_deg[c] * rad,
                   phi = p.elevation_deg[c] * rad, rest = r - std::sqrt(nx * nx + nz * nz);
      const Vector3d p_lidar(nx * std::cos(e) + rest * std::cos(a) * std::cos(phi),
                             nx * std::sin(e) + rest * std::sin(a) * std::cos(phi), nz + rest * std::sin(phi));
      const lidar::Cycle cycle = firing.cycle(firing.sweep(0), m);
      const Vector3d point = firing.origin(cycle) + (r - firing.range_offset_m()) * firing.direction(cycle, c);
      EXPECT_LT((point - Vector3d(-p_lidar.x(), -p_lidar.y(), p_lidar.z() + 0.03618)).norm(), 1e-12);
    }
}

TEST_F(OusterMetadata, ColumnWindowFiresItsColumnsOnly) {
  for (const auto& [window, columns] :
       {std::pair<std::string, std::vector<int>>{"[100, 104]", {100, 101, 102, 103, 104}},
        {"[509, 1]", {0, 1, 509, 510, 511}}}) {
    const lidar::Profile p = loaded(with(flat, "[0, 511]", window));
    EXPECT_EQ(p.modes, std::vector<std::string>{"512x20"});
    const lidar::FiringTable firing(p, {512, 20});
    const lidar::SweepSpan span = firing.sweep(2);
    ASSERT_EQ(span.cycles, std::ssize(columns));
    for (std::int64_t k = 0; k < span.cycles; ++k) {
      const double column = columns[static_cast<std::size_t>(k)];
      const lidar::Cycle cycle = firing.cycle(span, k);
      EXPECT_EQ(core::to_ns(cycle.t), std::llround(2 * 50e6 + column * 1e9 / (512 * 20)));
      EXPECT_NEAR(wrapped(std::atan2(cycle.sin_azimuth, cycle.cos_azimuth) - M_PI - 2 * M_PI * column / 512), 0, 1e-9);
    }
    EXPECT_EQ(span.begin, firing.cycle(span, 0).t);
    EXPECT_EQ(span.end, firing.cycle(span, 4).t);
  }
}

TEST_F(OusterMetadata, BeamsThatASensorLacksAreLeftOut) {
  const lidar::Profile p = loaded(with(with(flat, "3.25, -3.0", "0, 0"), "1.0, -1.0", "0, 0"));
  EXPECT_EQ(p.elevation_deg, (std::vector<double>{10.5, -11}));
  EXPECT_EQ(p.ring, (std::vector<double>{3, 0}));
}

TEST_F(OusterMetadata, SensorOfUnknownOpticsNeedsAProfileThatSaysThem) {
  const std::string domes = with(flat, "OS-1-4", "OS-DOME-4");
  expect_refused(domes, {"sensor.json", "OS-DOME-4", "channels: sensor.json"});
  write("sensor.json", domes);
  const lidar::Profile p = lidar::load_profile(
      write("dome.yaml",
            "channels: sensor.json\nmax_range_m: 300\nrange_10_percent_m: 80\nrange_80_percent_m: 210\n"
            "threshold_snr: 5.5\nsigma_from_m: [0]\nsigma_m: [0.03]\ndefault_mode: 1024x10\n"));
  EXPECT_EQ(p.elevation_deg, (std::vector<double>{10.5, 3.25, -3, -11}));
  EXPECT_EQ(p.default_mode, "1024x10");
  EXPECT_EQ(p.max_range_m, 300);
}

TEST_F(OusterMetadata, ContradictionsAndGapsAreRefusedWithFileLineAndField) {
  expect_refused(with(flat, "3.25, -3.0, -11.0", "3.25"),
                 {"sensor.json:3", "beam_azimuth_angles", "4 values", "has 2"});
  expect_refused(with(flat, "\"beam_altitude_angles\"", "\"angles\""),
                 {"sensor.json", "beam_altitude_angles", "missing"});
  expect_refused(with(flat, "10.5", "\"up\""), {"sensor.json:2", "beam_altitude_angles", "'up'", "finite number"});
  expect_refused(with(flat, "10.5", "95"), {"sensor.json:2", "at most 90"});
  expect_refused(with(flat, "[10.5, 3.25, -3.0, -11.0]", "[[1, 2], [3, 4]]"), {"beam_altitude_angles", "single value"});
  expect_refused(with(flat, "\"pixels_per_column\": 4", "\"pixels_per_column\": 64"),
                 {"pixels_per_column", "64", "4 beam"});
  expect_refused(with(flat, "[6, 2, -2, -6]", "[6, 2]"), {"sensor.json:5", "pixel_shift_by_row", "2 values"});
  expect_refused(with(flat, "512x20", "1024x10"), {"columns_per_frame", "512", "1024x10"});
  expect_refused(with(flat, "512x20", "fast"), {"sensor.json:7", "lidar_mode", "'fast' is no mode"});
  expect_refused(with(flat, "\"lidar_mode\"", "\"mode\""), {"lidar_mode", "missing"});
  expect_refused(with(flat, "[0, 511]", "[0, 512]"), {"column_window", "0 to 511"});
  expect_refused(with(flat, "36.18, 0, 0, 0, 1", "36.18"),
                 {"sensor.json:9", "lidar_to_sensor_transform", "16 were expected"});
  expect_refused(with(flat, "[-1, 0, 0, 0, 0, -1", "[0, 0, 1, 0, 0, -1"),
                 {"lidar_to_sensor_transform", "turn about z"});
  expect_refused(with(flat, "15.806", "-3"), {"sensor.json:8", "lidar_origin_to_beam_origin_mm", "at least 0"});
  expect_refused(with(with(flat, "10.5, 3.25, -3.0, -11.0", "0, 0, 0, 0"), "3.1, 1.0, -1.0, -3.1", "0, 0, 0, 0"),
                 {"beam_altitude_angles", "all angles are 0"});
  expect_refused(std::string(flat).substr(0, 300), {"sensor.json"});
  expect_refused("[1, 2]", {"sensor.json", "no Ouster metadata"});
}

class ColumnTimes : public TemporaryFolder {
 protected:
  static constexpr const char* rig =
      "lidar: {model: small, column_times: times.csv, profile: {timing: encoder, modes: [16x10], max_range_m: 50, "
      "range_step_m: 0.001, range_10_percent_m: 20, range_80_percent_m: 50, threshold_snr: 5, sigma_from_m: [0], "
      "sigma_m: [0.01], elevation_deg: [-1, 1], azimuth_offset_cw_deg: [0, 0]}}\n";
  std::string csv = "sweep,column,t_ns\n";
  void SetUp() override {
    TemporaryFolder::SetUp();
    for (int k = 0; k < 2; ++k)
      for (int c = 0; c < 16; ++c)
        csv += std::to_string(k) + "," + std::to_string(c) + "," +
               std::to_string(7'000'000 + k * 105'000'000 + c * 6'250'123) + "\n";
  }
  RigOptions read(const std::string& times, const std::string& block = rig) const {
    write("times.csv", times);
    const fs::path file = write("scenario.yaml", block);
    return read_rig(ConfigNode::load(file.string()));
  }
  void expect_refused(const std::string& times, const std::vector<std::string>& words,
                      const std::string& block = rig) const {
    std::string message;
    try {
      read(times, block);
    } catch (const core::InputError& error) {
      message = error.what();
    }
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
  std::string changed(const std::string& what, const std::string& instead) const {
    std::string text = csv;
    return text.replace(text.find(what), what.size(), instead);
  }
};

TEST_F(ColumnTimes, OfATableAreFiredAtFromTheFirstSweepsBegin) {
  const lidar::FiringTable firing = firing_table(read(csv), 1);
  EXPECT_EQ(firing.sweeps_until(core::time_from_s(100)), 2);  // no more than there are times for
  EXPECT_EQ(firing.sweeps_until(core::time_from_s(0.15)), 1);
  for (std::int64_t k = 0; k < 2; ++k)
    for (std::int64_t c = 0; c < 16; ++c)
      EXPECT_EQ(core::to_ns(firing.cycle(firing.sweep(k), c).t), k * 105'000'000 + c * 6'250'123);
}

TEST_F(ColumnTimes, ThatCannotBeAreRefusedWithFileAndLine) {
  expect_refused("", {"times.csv", "no column times"});
  expect_refused("t_ns\n", {"times.csv:1", "sweep,column,t_ns"});
  expect_refused(changed("0,3,", "0,4,"), {"times.csv:5", "out of order"});
  expect_refused(changed("0,3,2", "0,3,x2"), {"times.csv:5", "was read where"});
  expect_refused(csv + "1,16,300000000\n", {"scenario.yaml:1", "column_times", "sweep 1 has 17", "16 columns"});
  expect_refused(changed("0,3,25750369", "0,3,1"), {"sweep 0, column 3"});
  expect_refused(changed("0,15,100751845", "0,15,112000000"), {"sweep 1 begins before sweep 0 has ended"});
  const std::string velodyne = "lidar: {model: vlp-16, column_times: times.csv}\n";
  expect_refused(csv, {"scenario.yaml:1", "fires by the clock"}, velodyne);
  std::string jitter = rig;
  expect_refused(csv, {"spin.rate_jitter", "not both"},
                 jitter.replace(jitter.find("column_times"), 0, "spin: {rate_jitter: 0.001}, "));
}

}  // namespace
}  // namespace tarmac::sim
