// `tarmac simulate --point-truth`, then `tarmac export --format exr`: the images hold recording and truth bit by bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/chunk_file.h"
#include "core/files.h"
#include "core/recording.h"
#include "io/exr/range_image.h"
#include "sim/truth/ground_truth.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kScenario = R"(name: short-drive
why: images
surprise: any failure
duration_s: 0.45
scene: {kind: stand}
motion:
  kind: drive
  rest_s: 0.1
  start: {x_m: -60, y_m: -30}
  path: [{straight_m: 60}]
  speed: [{to_m_s: 4, peak_m_s2: 2.5}]
rig:
  lidars:
    - {model: vlp-16, T_body_lidar: {xyz_m: [1.2, 0, 1.9]}}
    - {model: ouster-os1-64-gen2, columns: 512, T_body_lidar: {xyz_m: [1.2, 0, 2.1]}}
faults:
  lidar: {clock_offset_ms: 7, point_time_reversed: true}
)";

class ExportImages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new PrivateFolder;
    core::write_file(path("short.yaml"), kScenario);
    ASSERT_EQ(tarmac({"simulate", "short.yaml", "-o", "run", "--point-truth", "--jobs", "2"}).first, 0) << text();
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path path(const std::string& name) { return folder_->path() / name; }
  static std::string text() { return core::read_file(path("log.txt")); }
  static std::pair<int, std::string> tarmac(std::vector<std::string> words) {
    ChildRequest request;
    words.insert(words.begin(), (program_folder() / "tarmac").string());
    request.command = std::move(words);
    request.working_folder = folder_->path();
    request.log_file = path("log.txt");
    request.limits.wall_s = 120;
    return {run_child(request).code, text()};
  }
  static PrivateFolder* folder_;
};
PrivateFolder* ExportImages::folder_ = nullptr;

TEST_F(ExportImages, HoldEveryPointOfRecordingAndTruthBitByBit) {
  const core::Recording recording = core::Recording::open(path("run") / "recording");
  for (const std::size_t lidar : {0, 1}) {
    const std::string out = "images" + std::to_string(lidar);
    ASSERT_EQ(tarmac({"export", "--format", "exr", "run", "-o", out, "--lidar", std::to_string(lidar)}).first, 0)
        << text();
    const core::ChunkReader labels(path("run") / "truth" / ("lidar" + std::to_string(lidar) + "_labels.chunks"));
    ASSERT_EQ(recording.sweep_count(lidar), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      const core::LidarSweep sweep = recording.sweep(k, lidar);
      const sim::truth::PointLabels truth = sim::truth::labels_from_chunk(labels.read(k));
      ASSERT_TRUE(truth.has_point_truth());
      const io::RangeImage image = io::read_range_image(path(out) / ("00000" + std::to_string(k) + ".exr"));
      EXPECT_EQ(image.sensor, lidar == 0 ? "vlp-16 (lidar0)" : "ouster-os1-64-gen2 (lidar1)");
      EXPECT_EQ(image.columns, "firing cycle");
      EXPECT_EQ(image.height, lidar == 0 ? 16u : 64u);
      if (lidar == 1) {
        EXPECT_EQ(image.width, 512u);
      } else {
        EXPECT_NEAR(static_cast<double>(image.width), 1e5 / 55.296, 1);
      }
      EXPECT_EQ(image.begin_ns, core::to_ns(sweep.begin));
      ASSERT_EQ(image.returns.size(), 1u);
      // Points go column by column through the image's rows, so they can be taken from it in their order: by the
      // firing time that the truth has, or, where no clock is wrong, by the recorded one.
      const io::RangeLayer& layer = image.returns[0];
      std::size_t filled = 0;
      for (const float range_m : layer.range_m) filled += range_m > 0;
      ASSERT_EQ(filled, sweep.size());
      for (std::size_t i = 0; i < sweep.size(); ++i) {
        const std::size_t row = image.height - 1 - sweep.ring[i];
        const double cycle_ns = lidar == 0 ? 55296 : 1e8 / 512;
        const auto column = static_cast<std::size_t>(lidar == 0 ? std::floor((truth.t_ns[i] + 0.5) / cycle_ns)
                                                                : std::round(truth.t_ns[i] / cycle_ns));
        const std::size_t at = row * image.width + column;
        ASSERT_EQ(layer.range_m[at], static_cast<float>(sweep.point(i).norm()));
        ASSERT_EQ(layer.intensity[at], sweep.intensity[i]);
        ASSERT_EQ(layer.time_ns[at] + image.time_origin_ns, core::to_ns(sweep.time(i)));
        ASSERT_EQ(layer.normal_x[at], truth.normal_x[i]);
        ASSERT_EQ(layer.normal_y[at], truth.normal_y[i]);
        ASSERT_EQ(layer.normal_z[at], truth.normal_z[i]);
        ASSERT_EQ(layer.cos_incidence[at], truth.cos_incidence[i]);
        ASSERT_EQ(layer.label[at], static_cast<std::uint32_t>(truth.label[i]));
        ASSERT_EQ(layer.instance[at], truth.instance[i]);
        ASSERT_EQ(layer.kind[at], static_cast<std::uint32_t>(truth.kind_of(i)));
      }
    }
  }
}

TEST_F(ExportImages, OneSweepIsOneFile) {
  ASSERT_EQ(tarmac({"export", "--format", "exr", "run", "-o", "one.exr", "--sweep", "2"}).first, 0) << text();
  EXPECT_EQ(io::read_range_image(path("one.exr")).sweep, 2);
  EXPECT_THAT(tarmac({"export", "--format", "exr", "run", "-o", "none.exr", "--sweep", "9"}),
              testing::Pair(2, HasSubstr("no sweep of that index")));
  EXPECT_THAT(tarmac({"export", "--format", "exr", "run", "-o", "all.exr"}), testing::Pair(2, HasSubstr("--sweep")));
  EXPECT_THAT(tarmac({"export", "--format", "exr", "run", "-o", "x", "--lidar", "2"}),
              testing::Pair(2, HasSubstr("2 LiDARs")));
}

TEST_F(ExportImages, WithoutPointTruthTheProgramSaysHowToAskForIt) {
  ASSERT_EQ(tarmac({"simulate", "short.yaml", "-o", "plain", "--jobs", "2"}).first, 0) << text();
  EXPECT_THAT(tarmac({"export", "--format", "exr", "plain", "-o", "p"}),
              testing::Pair(2, AllOf(HasSubstr("--point-truth"), HasSubstr("--no-truth"))));
  ASSERT_EQ(tarmac({"export", "--format", "exr", "plain", "-o", "p", "--no-truth", "--sweep", "1"}).first, 0) << text();
  const io::RangeImage image = io::read_range_image(path("p") / "000001.exr");
  EXPECT_FALSE(image.with_truth);
  EXPECT_TRUE(image.returns[0].label.empty());
  EXPECT_EQ(image.height, 16u);
  // A recording alone: columns are the instants of returns.
  fs::rename(path("plain") / "truth", path("plain") / "elsewhere");
  EXPECT_THAT(tarmac({"export", "--format", "exr", "plain", "-o", "q"}),
              testing::Pair(2, AllOf(HasSubstr("no truth beside it"), HasSubstr("--no-truth"))));
  ASSERT_EQ(tarmac({"export", "--format", "exr", "plain", "-o", "q", "--no-truth", "--sweep", "1"}).first, 0) << text();
  EXPECT_EQ(io::read_range_image(path("q") / "000001.exr").columns, "firing time");
}

TEST_F(ExportImages, SimulateSaysWhatItTakesOnTheDisk) {
  EXPECT_THAT(tarmac({"simulate", "short.yaml", "-o", "disk", "--jobs", "2"}),
              testing::Pair(0, AllOf(HasSubstr("disk: about"), HasSubstr("are free"))));
  EXPECT_THAT(tarmac({"simulate", "short.yaml", "-o", "big", "--seed", "1..1000", "--set", "duration_s=36000"}),
              testing::Pair(2, AllOf(HasSubstr("are needed"), HasSubstr("--force"))));
  EXPECT_FALSE(fs::exists(path("big")));
}

}  // namespace
}  // namespace tarmac::tools
