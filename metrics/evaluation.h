/// The result of comparing one estimate with the truth: rows for tables, series for figures.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tarmac::metrics {

struct Row {
  std::string estimate = "causal";  ///< causal or final
  std::string metric;               ///< carries its unit: ate_se3_rmse_m
  std::optional<double> value;      ///< empty = n/a
  std::string unit;
  std::optional<double> ci_low, ci_high;
  std::string status = "ok";  ///< ok | ok: what to know of the value | n/a: reason | failed: reason
};

/// y over x, NaN where a value is missing.
struct Series {
  std::string name;              ///< "reference_error_by_phase"; evaluate.h lists all
  std::string x_label, y_label;  ///< with units: "distance [m]"
  std::vector<double> x, y;
  std::vector<double> low, high;  ///< a band, or empty
};

/// What was looked for, whether it was found, and by what evidence.
struct Finding {
  enum class Verdict : std::uint8_t {
    found = 0,
    nothing_found = 1,   ///< looked for; what there is lies within chance
    cannot_be_told = 2,  ///< this method, recording or plot cannot show it; the words say why
  };
  struct Number {
    std::string name;  ///< in words: "offset"
    std::optional<double> value;
    std::string unit;
    std::optional<double> low, high;
  };
  std::string topic;  ///< kebab-case: "stamp-scale"; the registry of diagnosis.h and degeneracy's own
  Verdict verdict = Verdict::cannot_be_told;
  std::string words;  ///< a sentence or two for a reader
  std::vector<Number> evidence;
};
const char* name_of(Finding::Verdict verdict);  ///< "found", "nothing found", "cannot be told"

/// A sample of the map that the method built, aligned to the truth (first pose), with each point's error.
struct MapSample {
  std::vector<Eigen::Vector3f> p_world_m;  ///< where the aligned estimate puts the point
  std::vector<float> error_m;
  std::vector<std::uint8_t> moving;
};

struct Evaluation {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string estimator;
  std::string status = "ok";  ///< ok | not_initialised | failed | crashed | timed out | no output ...
  std::string message;
  double coverage = 0;  ///< share of sweeps that are scored
  std::vector<Row> rows;
  std::vector<Series> series;
  std::vector<Finding> findings;
  MapSample map;               ///< stored apart, as map_sample.bin
  std::string degeneracy_csv;  ///< every eigenvalue a sweep; stored apart, as degeneracy.csv, and not read back

  /// nullptr when there is none of that name.
  const Row* row(const std::string& metric, const std::string& estimate = "causal") const;
  const Series* find(const std::string& name) const;
};

/// evaluation.json; cost.json beside it with what differs from run to run (times, memory), so that equal runs give
/// equal bytes in evaluation.json; map_sample.bin when there is a map, degeneracy.csv when
/// there is one. Numbers come back exactly; NaN is null.
void save_evaluation(const std::filesystem::path& folder, const Evaluation& evaluation);
/// Throws InputError when there is no evaluation.json, DamagedFile when a file is not whole.
Evaluation load_evaluation(const std::filesystem::path& folder);

}  // namespace tarmac::metrics
