// `tarmac bench`: what things cost on this machine.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/config.h"
#include "core/error.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/commands.h"

namespace tarmac::tools {
namespace {

struct Bench {
  const char* name;
  BenchRows (*run)(const Console& console);
};
BenchRows sim_and_movers(const Console& console) {
  BenchRows rows = bench_sim(console);
  const BenchRows movers = bench_movers(console);
  rows.insert(rows.end(), movers.begin(), movers.end());
  return rows;
}

constexpr Bench kBenches[] = {{"sim", sim_and_movers},
                              {"estimators", bench_estimators},
                              {"metrics", bench_metrics},
                              {"store", bench_store},
                              {"trajectories", bench_trajectories},
                              {"window", bench_window}};

const Bench& find(const std::string& name) {
  std::vector<std::string> names;
  for (const Bench& bench : kBenches) {
    if (name == bench.name) return bench;
    names.emplace_back(bench.name);
  }
  const std::string guess = core::did_you_mean(name, names);
  throw core::InputError(
      fmt::format("bench: there is no '{}'{}; there are sim, estimators, metrics, store, "
                  "trajectories and window",
                  name, guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess)));
}

void print_json(const BenchRows& rows) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    array.push_back({{"bench", row.bench},
                     {"case", row.variant},
                     {"metric", row.metric},
                     {"value", row.value},
                     {"unit", row.unit}});
  }
  fmt::print("{}\n", array.dump(1));
}

void print_table(const BenchRows& rows) {
  std::size_t bench = 0, variant = 0, metric = 0;
  for (const BenchRow& row : rows) {
    bench = std::max(bench, row.bench.size());
    variant = std::max(variant, row.variant.size());
    metric = std::max(metric, row.metric.size());
  }
  for (const BenchRow& row : rows)
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {:>12.3f} {}\n", row.bench, bench, row.variant, variant, row.metric, metric,
               row.value, row.unit);
}

}  // namespace

int bench_command(const BenchArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  std::vector<const Bench*> chosen;
  for (const std::string& name : arguments.benches) {
    const Bench* bench = &find(name);
    if (std::find(chosen.begin(), chosen.end(), bench) == chosen.end()) chosen.push_back(bench);
  }
  if (chosen.empty())
    for (const Bench& bench : kBenches) chosen.push_back(&bench);
  BenchRows rows;
  for (const Bench* bench : chosen) {
    const BenchRows more = bench->run(console);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  common.json ? print_json(rows) : print_table(rows);
  return 0;
}

}  // namespace tarmac::tools
