/// Small sweeps for the tests of the store.
#pragma once

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "core/files.h"
#include "scenarios/store.h"

namespace tarmac::scenarios::tests {

inline const StoreIdentity kIdentity{"regression", "00000000000000aa", "0.1.0 abcdef"};

/// Cell number i of a grid of two estimators and three seeds to a case.
inline Cell cell(std::size_t i) {
  Cell c;
  const std::size_t world = i / 2;
  c.key = core::hex16(0x1000 + i);
  c.world = core::hex16(0x9000 + world);
  c.block = "brake";
  c.scenario = "quick-brake";
  c.seed = 1 + world % 3;
  c.case_name = fmt::format("brake motion.peak={}", world / 3);
  c.estimator = i % 2 == 0 ? "kiss-icp" : "ct-icp";
  c.parameters = {{"motion.peak", std::to_string(world / 3)}, {"rig.lidar.model", "vlp-16"}};
  return c;
}

inline std::vector<Cell> cells(std::size_t n) {
  std::vector<Cell> all;
  for (std::size_t i = 0; i < n; ++i) all.push_back(cell(i));
  return all;
}

inline CellOutcome outcome(std::size_t i, const std::string& status = "ok") {
  CellOutcome o;
  o.status = status;
  o.recording_hash = core::hex16(0x77 + i / 2);
  o.wall_s = 1.5 + 0.25 * static_cast<double>(i);
  o.cpu_s = 1.25;
  o.peak_memory_mb = 120;
  o.overhead_s = 0.03;
  o.folder = "cells/" + cell(i).key;
  o.command = "tarmac run brake --seed 1";
  return o;
}

inline MetricValue metric(const std::string& name, std::optional<double> value, const std::string& unit) {
  MetricValue m;
  m.metric = name;
  m.value = value;
  m.unit = unit;
  return m;
}

/// Of cell i: a value with its interval, one for the final estimate, one that there is not, and a cost.
inline std::vector<MetricValue> metrics(std::size_t i) {
  const double x = static_cast<double>(i);
  std::vector<MetricValue> all = {metric("ate_se3_rmse_m", 0.1 + x / 3, "m"),
                                  metric("ate_se3_rmse_m", 0.05 + x / 7, "m"), metric("kitti_trans_percent", {}, "%"),
                                  metric("sweep_time_p50_ms", 20 + x, "ms")};
  all[0].ci_low = 0.09 + x / 3;
  all[0].ci_high = 0.12 + x / 3;
  all[1].estimate = "final";
  all[2].status = "n/a: the drive is shorter than 100 m";
  all[3].deterministic = false;
  return all;
}

inline void run(Store& store, std::size_t i, const std::string& status = "ok") {
  if (!store.claim(cell(i).key)) throw std::runtime_error("the cell was not pending");
  store.finish(cell(i).key, outcome(i, status), status == "ok" ? metrics(i) : std::vector<MetricValue>{});
}

inline std::string dump(const Store& store) {
  std::ostringstream out;
  store.dump(out);
  return out.str();
}

}  // namespace tarmac::scenarios::tests
