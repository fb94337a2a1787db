/// The record that every method fills alike: one entry a sweep, from which metrics rebuild the information blocks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::core {

enum class DiagnosticsLevel : std::uint8_t {
  none = 0,    ///< nothing is collected
  system = 1,  ///< counts, iterations and the 6-DOF normal equations
  full = 2,    ///< and every residual of the last iteration
};
DiagnosticsLevel diagnostics_level(const std::string& name);  ///< throws InputError

/// The index of a point that is not known. Points come in firing order: where stamps are wrong, the index still says
/// which point came before which.
inline constexpr std::uint32_t kNoPoint = 0xFFFFFFFF;

/// One scalar residual of the last iteration. The Jacobian is by the pose at the point's own time, body frame, right
/// perturbation, translation first: r(T Exp(xi)) = value + jacobian xi. A vector residual gives one row an axis.
/// A point-to-surface row has value = n^T (p_map - q_map), n the surface's normal turned towards the sensor: positive
/// where the point lies in front of the surface; jacobian[0..2] is then n along the body's axes.
struct ResidualRow {
  std::int32_t t_ns = 0;  ///< point time from the sweep's begin
  float value = 0;        ///< unit of the residual, unweighted [m]
  float weight = 0;       ///< multiplies value^2 in the cost, robust loss included
  float jacobian[6] = {};
  std::uint16_t sensor = 0;
  std::uint32_t point = kNoPoint;  ///< index into the sweep's points as the method was given them
};

struct SweepDiagnostics {
  std::int64_t index = 0;
  int iterations = 0;
  bool converged = false;
  std::int32_t points_in = 0;         ///< points given to the method
  std::int32_t points_used = 0;       ///< after sampling
  std::int32_t residuals = 0;         ///< rows of the last iteration
  double scale_m = 0;                 ///< the loss's scale (KISS-ICP: sigma)
  Matrix6 H_data = Matrix6::Zero();   ///< sum of w J^T J over data residuals, at the sweep's reference instant
  Matrix6 H_prior = Matrix6::Zero();  ///< the same of priors and regularisers
  /// Covariance that the method states of T_map_body at the reference instant (xi of T Exp(xi), translation first; m^2,
  /// m rad, rad^2). Zero: it states none.
  Matrix6 covariance = Matrix6::Zero();
  std::vector<ResidualRow> rows;  ///< level full
  bool rows_are_surface = false;  ///< `rows` are point-to-surface rows; `surface` stays empty then
  /// Level full: point-to-surface residuals of a method that solves with others, seen against its own map at the end
  /// of its iterations. No part of H_data: they are there for the residual-over-time instrument.
  std::vector<ResidualRow> surface;
};

/// Times of one sweep; kept apart from SweepDiagnostics, since no two runs have the same.
struct SweepTiming {
  std::int64_t index = 0;
  double wall_ms = 0;
  double cpu_ms = 0;  ///< of the whole process
  std::vector<std::pair<std::string, double>> stages_ms;
};

/// diagnostics.bin, a sweep at a time. Written under another name and renamed by finish(): a file of that name is
/// whole.
class DiagnosticsWriter {
 public:
  explicit DiagnosticsWriter(const std::filesystem::path& file);
  ~DiagnosticsWriter();
  void append(const SweepDiagnostics& sweep);
  void finish();

 private:
  std::filesystem::path file_;
  std::unique_ptr<class ChunkWriter> writer_;
};
class DiagnosticsReader {
 public:
  /// Throws DamagedFile when the file is not whole.
  explicit DiagnosticsReader(const std::filesystem::path& file);
  ~DiagnosticsReader();
  std::size_t size() const;
  /// May be called from several threads.
  SweepDiagnostics read(std::size_t i) const;

 private:
  std::filesystem::path file_;
  std::unique_ptr<class ChunkReader> reader_;
};
void save_diagnostics(const std::filesystem::path& file, const std::vector<SweepDiagnostics>& sweeps);
std::vector<SweepDiagnostics> load_diagnostics(const std::filesystem::path& file);

struct RunTiming {
  int threads = 1;
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mb = 0;
  std::vector<SweepTiming> sweeps;
};
void save_timing(const std::filesystem::path& file, const RunTiming& timing);  ///< timing.json
RunTiming load_timing(const std::filesystem::path& file);

}  // namespace tarmac::core
