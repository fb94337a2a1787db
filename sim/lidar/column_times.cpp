#include "sim/lidar/column_times.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::sim::lidar {
namespace {

using core::InputError;
namespace fs = std::filesystem;

constexpr std::size_t point_bytes = 20, time_at = 16;  // float32 x, y, z, intensity, t
constexpr std::int64_t longest_sweep_ns = 2'000'000'000;

/// Reads "a<separator>b..." as whole numbers; throws InputError naming the line.
template <std::size_t N>
std::array<std::int64_t, N> numbers(std::string_view line, char separator, const fs::path& file, std::size_t number,
                                    const char* expected) {
  std::array<std::int64_t, N> values{};
  const char *at = line.data(), *const end = line.data() + line.size();
  for (std::size_t i = 0; i < N; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [stop, error] = std::from_chars(at, end, values[i]);
    at = stop;
    while (at != end && *at == ' ' && separator != ' ') ++at;
    const bool last = i + 1 == N;
    if (error != std::errc() || (last ? at != end : (at == end || *at != separator)))
      throw InputError(
          fmt::format("{}:{}: '{}' was read where {} was expected", file.string(), number, line, expected));
    if (!last) ++at;
  }
  return values;
}

/// Calls take(line, number) for each line that is not empty.
template <class Take>
void for_each_line(const fs::path& file, const Take& take) {
  const std::string text = core::read_file(file);
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find('\n', at), text.size());
    std::string_view line(text.data() + at, stop - at);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    ++number;
    if (!line.empty()) take(line, number);
    at = stop + 1;
  }
}

/// Distinct point times of a sweep, as they stand in the file.
std::vector<float> point_times(const fs::path& file) {
  const std::string bytes = core::read_file(file);
  if (bytes.size() % point_bytes != 0)
    throw InputError(fmt::format("{}: {} bytes are no multiple of {}: this is no sweep of the plain format",
                                 file.string(), bytes.size(), point_bytes));
  std::vector<float> times;
  for (std::size_t at = 0; at < bytes.size(); at += point_bytes) {
    float t_s = 0;
    std::memcpy(&t_s, bytes.data() + at + time_at, sizeof t_s);
    if (times.empty() || t_s > times.back())
      times.push_back(t_s);
    else if (t_s != times.back())
      throw InputError(
          fmt::format("{}: point {}: t = {} s follows {} s; column times can be read only from points in "
                      "firing order",
                      file.string(), at / point_bytes, t_s, times.back()));
  }
  return times;
}

// What float32 seconds came from: the nearest nanosecond, and for the last column the sweep's end where that is what
// rounds to it.
ReplayedSweep plain_sweep(const fs::path& file, std::int64_t begin_ns, std::int64_t end_ns) {
  ReplayedSweep sweep{begin_ns, {}};
  for (const float t_s : point_times(file)) sweep.column_ns.push_back(std::rint(static_cast<double>(t_s) * 1e9));
  const auto span_ns = static_cast<double>(end_ns - begin_ns);
  const auto seconds = [](double ns) { return static_cast<float>(ns * 1e-9); };
  if (!sweep.column_ns.empty() && seconds(span_ns) == seconds(sweep.column_ns.back())) sweep.column_ns.back() = span_ns;
  return sweep;
}

std::vector<ReplayedSweep> from_plain(const fs::path& folder) {
  std::vector<ReplayedSweep> sweeps;
  const fs::path stamps = folder / "lidar" / "stamps.txt";
  for_each_line(stamps, [&](std::string_view line, std::size_t number) {
    const auto [begin_ns, end_ns] = numbers<2>(line, ' ', stamps, number, "`begin end` in ns");
    const fs::path file = folder / "lidar" / fmt::format("{:06}.bin", sweeps.size());
    sweeps.push_back(plain_sweep(file, begin_ns, end_ns));
  });
  return sweeps;
}

std::vector<ReplayedSweep> from_csv(const fs::path& file) {
  std::vector<ReplayedSweep> sweeps;
  bool header = true;
  for_each_line(file, [&](std::string_view line, std::size_t number) {
    if (header) {
      if (line != "sweep,column,t_ns")
        throw InputError(fmt::format("{}:{}: the header sweep,column,t_ns was expected", file.string(), number));
      header = false;
      return;
    }
    const auto [sweep, column, t_ns] = numbers<3>(line, ',', file, number, "`sweep,column,t_ns`");
    const auto count = static_cast<std::int64_t>(sweeps.size());
    if (column == 0 && sweep == count) sweeps.push_back({t_ns, {}});
    if (sweeps.empty() || sweep + 1 != static_cast<std::int64_t>(sweeps.size()) ||
        column != static_cast<std::int64_t>(sweeps.back().column_ns.size()))
      throw InputError(fmt::format("{}:{}: sweep {}, column {} is out of order: sweeps and columns are counted from 0",
                                   file.string(), number, sweep, column));
    sweeps.back().column_ns.push_back(static_cast<double>(t_ns - sweeps.back().begin_ns));
  });
  return sweeps;
}

}  // namespace

void ReplayedSweep::visit(core::OptionVisitor& v) {
  v("begin_ns", begin_ns, "when the sweep's first column fires, from the simulation's begin", {.at_least = 0});
  v("column_ns", column_ns, "when each column fires, from begin_ns", {.at_least = 0});
}

void check_column_times(const std::vector<ReplayedSweep>& sweeps, std::size_t columns) {
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const std::vector<double>& times = sweeps[k].column_ns;
    if (times.size() != columns)
      throw InputError(
          fmt::format("sweep {} has {} column times and the sensor fires {} columns (a column without any "
                      "return leaves none in a plain folder; a CSV file sweep,column,t_ns can hold all)",
                      k, times.size(), columns));
    if (times.front() != 0) throw InputError(fmt::format("sweep {}: its first column must fire at its begin", k));
    for (std::size_t c = 0; c < columns; ++c) {
      if (times[c] != std::floor(times[c]) || times[c] > static_cast<double>(longest_sweep_ns))
        throw InputError(fmt::format("sweep {}, column {}: {} ns is no whole number up to 2e9", k, c, times[c]));
      if (c > 0 && times[c] <= times[c - 1])
        throw InputError(
            fmt::format("sweep {}, column {}: {} ns does not come after {} ns", k, c, times[c], times[c - 1]));
    }
    if (k > 0 && static_cast<double>(sweeps[k].begin_ns - sweeps[k - 1].begin_ns) <= sweeps[k - 1].column_ns.back())
      throw InputError(fmt::format("sweep {} begins before sweep {} has ended", k, k - 1));
  }
}

std::vector<ReplayedSweep> load_column_times(const fs::path& path, std::size_t columns) {
  std::vector<ReplayedSweep> sweeps = fs::is_directory(path) ? from_plain(path) : from_csv(path);
  if (sweeps.empty()) throw InputError(fmt::format("{}: holds no column times", path.string()));
  try {
    check_column_times(sweeps, columns);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
  const std::int64_t start_ns = sweeps.front().begin_ns;
  for (ReplayedSweep& sweep : sweeps) sweep.begin_ns -= start_ns;
  return sweeps;
}

}  // namespace tarmac::sim::lidar
