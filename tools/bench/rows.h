/// What a bench measured, and how benches are found.
#pragma once

#include <string>
#include <vector>

#include "tools/tarmac/console.h"

namespace tarmac::tools {

/// One figure. `metric` carries its unit in its name, `unit` says it again for readers.
struct BenchRow {
  std::string bench;    ///< "sim"
  std::string variant;  ///< `case` in the output: "default", "fast"
  std::string metric;   ///< "raw_mrays_per_s"
  double value = 0;
  std::string unit;  ///< "Mrays/s"
};
using BenchRows = std::vector<BenchRow>;

/// Each runs for some seconds to a minute and throws Interrupted after Ctrl-C.
BenchRows bench_sim(const Console& console);
BenchRows bench_beams(const Console& console);  ///< rows of `sim`
BenchRows bench_movers(const Console& console);  ///< part of "sim"
BenchRows bench_estimators(const Console& console);
BenchRows bench_metrics(const Console& console);
BenchRows bench_store(const Console& console);
BenchRows bench_trajectories(const Console& console);
BenchRows bench_window(const Console& console);

}  // namespace tarmac::tools
