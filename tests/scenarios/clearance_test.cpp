// Shipped scenarios: no drive leads through anything that stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <unordered_map>
#include <vector>

#include "io/world/mesh_readers.h"
#include "scenarios/scenario.h"
#include "scenes/registry.h"
#include "sim/truth/motion.h"
#include "tests/scenes/support.h"

namespace tarmac::tests {
namespace {

using Eigen::Vector2d;

constexpr double kReachM = 4, kClearanceM = 1.2, kLowM = 0.15, kHighM = 2.6;

/// Points of a path, found by cell.
class Path {
 public:
  explicit Path(const core::SmoothTrajectory& motion) {
    for (core::Time t = motion.begin(); t <= motion.end(); t += core::Duration(20'000'000)) {
      const Vector2d p = motion.pose(t).translation().head<2>();
      if (!last_ || (p - *last_).norm() > 0.2) cells_[cell(p)].push_back(p);
      if (!last_ || (p - *last_).norm() > 0.2) last_ = p;
    }
  }
  /// Distance from the outline to the path, where it is below kReachM.
  double distance(const std::vector<Vector2d>& outline) const {
    double nearest = kReachM;
    Vector2d low = outline.front(), high = outline.front();
    for (const Vector2d& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (double x = low.x() - kReachM; x <= high.x() + 2 * kReachM; x += kReachM)
      for (double y = low.y() - kReachM; y <= high.y() + 2 * kReachM; y += kReachM)
        if (const auto found = cells_.find(cell({x, y})); found != cells_.end())
          for (const Vector2d& p : found->second) nearest = std::min(nearest, distance_to_outline(p, outline));
    return nearest;
  }

 private:
  static std::int64_t cell(const Vector2d& p) {
    return static_cast<std::int64_t>(std::floor(p.x() / kReachM)) * 1'000'000 +
           static_cast<std::int64_t>(std::floor(p.y() / kReachM));
  }
  std::optional<Vector2d> last_;
  std::unordered_map<std::int64_t, std::vector<Vector2d>> cells_;
};

struct Nearest {
  double distance_m = kReachM;
  std::string mesh;
};

Nearest nearest(const scenes::Scene& scene, const Path& path) {
  Nearest result;
  for_each_static_triangle(
      scene, [](const scenes::Instance& i) { return !on_the_ground(i.label); },
      [&](const scenes::Instance& instance, const Triangle& t) {
        for_each_outline_between(t, *scene.ground, kLowM, kHighM, [&](const std::vector<Vector2d>& outline) {
          const double distance = path.distance(outline);
          if (distance < result.distance_m) result = {distance, scene.meshes[instance.mesh].name};
        });
      });
  return result;
}

std::vector<std::filesystem::path> shipped() {
  return scenarios::list_scenarios({TARMAC_SCENARIOS});
}

class ShippedScenario : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScenario, DrivesClearOfEverythingThatStandsThere) {
  io::world::install_mesh_readers();
  const scenarios::Scenario scenario = scenarios::load_scenario(GetParam(), {});
  const scenes::Scene scene = scenes::make_scene(scenario.scene, 1);
  const auto motion = sim::truth::make_motion(scenario.motion, scenario.duration(), scene.ground, 1);
  const Nearest found = nearest(scene, Path(*motion));
  std::cout << scenario.name << ": " << found.distance_m << " m " << found.mesh << "\n";
  EXPECT_GE(found.distance_m, kClearanceM) << found.mesh;
}

TEST(Clearance, SearchFindsAMastThatStandsInTheWay) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(std::filesystem::path(TARMAC_SCENARIOS) / "survey-loop.yaml", {});
  scenes::Scene scene = scenes::make_scene(scenario.scene, 1);
  const auto motion = sim::truth::make_motion(scenario.motion, scenario.duration(), scene.ground, 1);
  scenes::Instance mast;
  for (const scenes::Instance& i : scene.instances)
    if (i.label == scenes::Label::mast) mast = i;
  mast.T_parent_mesh.translation() = motion->pose(core::time_from_s(77)).translation() + Eigen::Vector3d(0, 1.5, 0);
  scene.instances.push_back(mast);
  EXPECT_LT(nearest(scene, Path(*motion)).distance_m, 1.5);
}

TEST_P(ShippedScenario, SaysWhyItIsAskedAndWhatWouldBeASurprise) {
  const scenarios::Scenario scenario = scenarios::load_scenario(GetParam(), {});
  EXPECT_EQ(scenario.name, GetParam().stem().string());
  EXPECT_GT(scenario.why.size(), 40U);
  EXPECT_GT(scenario.surprise.size(), 20U);
}

std::string name_of_case(const testing::TestParamInfo<std::filesystem::path>& scenario) {
  std::string name = scenario.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, testing::ValuesIn(shipped()), name_of_case);

}  // namespace
}  // namespace tarmac::tests
