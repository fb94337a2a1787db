// The whole way: evaluations and a scene in, one file out.
#include "reports/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/reports/example.h"

namespace tarmac::reports {
namespace {

using ::testing::HasSubstr;

class WriteReport : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("reports_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

metrics::MapSample ground_points() {
  metrics::MapSample sample;
  for (float x = -10; x < 10; x += 0.2f) {
    for (float y = -10; y < 10; y += 0.2f) {
      sample.p_world_m.emplace_back(x, y, 0.0f);
      sample.error_m.push_back(0.02f + 0.01f * (x + 10));
      sample.moving.push_back(0);
    }
  }
  return sample;
}

TEST_F(WriteReport, PutsScenesMapsAndFiguresIntoOneFile) {
  const scenes::Scene scene = example::scene();
  ReportInput input = example::input();
  input.scene = &scene;
  input.runs[0].evaluations[0].map = ground_points();
  double last = -1;
  write_report(folder_ / "report.html", input, [&](double fraction, const std::string&) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  EXPECT_EQ(last, 1);
  const std::string page = core::read_file(folder_ / "report.html");
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_LT(page.size(), 6e6);
  std::size_t pictures = 0;
  for (std::size_t at = page.find("data:image/jpeg;base64,"); at != std::string::npos;
       at = page.find("data:image/jpeg;base64,", at + 1)) {
    ++pictures;
  }
  EXPECT_EQ(pictures, 3u) << "overview, top view, one map";
}

TEST_F(WriteReport, StoppedOnTheWayLeavesTheOldPage) {
  ReportInput input = example::input();
  const auto file = folder_ / "report.html";
  write_report(file, input, {});
  const std::string before = core::read_file(file);
  input.title = "another";
  const auto stop = [](double, const std::string&) { throw std::runtime_error("stop"); };
  EXPECT_THROW(write_report(file, input, stop), std::runtime_error);
  EXPECT_EQ(core::read_file(file), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "and nothing half-written beside it";
}

TEST_F(WriteReport, WithoutASceneSaysSo) {
  write_report(folder_ / "report.html", example::input(), {});
  EXPECT_THAT(core::read_file(folder_ / "report.html"), HasSubstr("There are no pictures of the scene"));
}

TEST_F(WriteReport, RenderSceneWritesAPng) {
  render_scene(folder_ / "scene.png", example::scene(), core::Time{}, 320, 180);
  EXPECT_EQ(core::read_file(folder_ / "scene.png").substr(1, 3), "PNG");
}

}  // namespace
}  // namespace tarmac::reports
