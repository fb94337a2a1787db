/// An options struct with one of everything, for the tests of reading, describing and writing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/options.h"

namespace tarmac::core {

struct WheelOptions {
  double radius_m = 0.3;
  std::string side = "left";
  void visit(OptionVisitor& v) {
    v("radius_m", radius_m, "rolling radius", {.above = 0});
    v.choice("side", side, {"left", "right"}, "where it is");
  }
};

struct EngineOptions {
  int cylinders = 4;
  std::int64_t serial = 0;
  void visit(OptionVisitor& v) {
    v("cylinders", cylinders, "how many", {.at_least = 1, .at_most = 12});
    v("serial", serial, "number on the block");
  }
};

struct ExampleOptions {
  bool enabled = true;
  double speed_m_s = 1.5;
  std::string title = "plain";
  Eigen::Vector2d size_m{1, 2};
  Eigen::Vector3d offset_m{0, 0, 1};
  std::vector<double> gains{0.5, 1};
  std::vector<std::string> names{"a", "b"};
  SE3 T_body_lidar = SE3::Identity();
  EngineOptions engine;
  std::vector<WheelOptions> wheels{{}, {.radius_m = 0.4, .side = "right"}};

  void visit(OptionVisitor& v) {
    v("enabled", enabled, "whether it runs");
    v("speed_m_s", speed_m_s, "how fast", {.at_least = 0, .below = 100});
    v("title", title, "what it is called");
    v("size_m", size_m, "length and width");
    v("offset_m", offset_m, "from the axle");
    v("gains", gains, "per loop", {.above = 0});
    v("names", names, "of the parts");
    v("T_body_lidar", T_body_lidar, "where the LiDAR sits");
    v.group("engine", engine, "what drives it");
    v.list("wheels", wheels, "what carries it");
  }
};

}  // namespace tarmac::core
