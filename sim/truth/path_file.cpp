#include "sim/truth/path_file.h"

#include <fmt/core.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

constexpr double norm_tolerance = 1e-2;
constexpr double latest_s = 9e9;  ///< beyond it the nanoseconds do not fit, and the times are hardly seconds

class Line {
 public:
  Line(const std::string& file, int number) : file_(file), number_(number) {}
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file_, number_, message));
  }

  double number(std::string_view word, const char* column) const {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      fail(fmt::format("{}: '{}' is no finite number", column, word));
    }
    return value;
  }

  /// Whole seconds and their fraction apart: a double would round nanoseconds of today's time to a few hundred.
  Time time(std::string_view word) const {
    if (word.find_first_of("eE") != std::string_view::npos) {
      const double seconds = number(word, "t");
      if (std::abs(seconds) > latest_s) too_late(word);
      return time_from_s(seconds);
    }
    const bool minus = word.starts_with('-');
    const std::string_view digits = word.substr(minus ? 1 : 0);
    const std::size_t dot = digits.find('.');
    const double whole = number(digits.substr(0, dot).empty() ? "0" : digits.substr(0, dot), "t");
    if (whole > latest_s) too_late(word);
    const double fraction =
        dot == std::string_view::npos || dot + 1 == digits.size() ? 0 : number(digits.substr(dot), "t");
    const std::int64_t ns = std::llround(whole) * 1'000'000'000 + std::llround(fraction * 1e9);
    return time_from_ns(minus ? -ns : ns);
  }

 private:
  [[noreturn]] void too_late(std::string_view word) const {
    fail(fmt::format("t: {} is too large for seconds; times in nanoseconds or microseconds must be divided first",
                     word));
  }
  const std::string& file_;
  int number_;
};

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view separators = " \t\r,;";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(separators, at);
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return words;
}

/// A letter that begins no number: nan and inf are values, and bad ones.
bool is_header(std::string_view word) {
  return std::isalpha(static_cast<unsigned char>(word[0])) && word != "nan" && word != "inf" && word != "NaN";
}

RecordedPose pose_of(const Line& line, const std::vector<std::string_view>& words) {
  if (words.size() != 8) {
    line.fail(fmt::format("has {} columns; expected 8: t x y z qx qy qz qw", words.size()));
  }
  static constexpr std::array<const char*, 7> names{"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::array<double, 7> values;
  for (std::size_t k = 0; k < 7; ++k) values[k] = line.number(words[k + 1], names[k]);
  RecordedPose pose{
      line.time(words[0]), {values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}};
  const double norm = pose.quat_xyzw.norm();
  if (std::abs(norm - 1) > norm_tolerance) {
    line.fail(
        fmt::format("the quaternion's length is {:.6g} and not 1; the columns are t x y z qx qy qz qw, qw last", norm));
  }
  // Not again what has been normalised before: the resolved text of a path is the same path to the last bit.
  if (std::abs(norm - 1) > 1e-14) pose.quat_xyzw /= norm;
  return pose;
}

}  // namespace

std::vector<RecordedPose> parse_path(const std::string& text, const std::string& name) {
  std::vector<RecordedPose> poses;
  int number = 0;
  bool first = true;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = std::string_view(text).substr(at, end - at);
    at = end + 1;
    const Line line(name, ++number);
    const std::vector<std::string_view> words = words_of(content.substr(0, content.find('#')));
    if (words.empty()) continue;
    if (std::exchange(first, false) && is_header(words[0])) continue;
    RecordedPose pose = pose_of(line, words);
    pose.line = number;
    if (!poses.empty() && pose.t <= poses.back().t) {
      line.fail(fmt::format("the time {} s is not later than that of line {} ({} s); times must increase", words[0],
                            poses.back().line, to_s(poses.back().t)));
    }
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace tarmac::sim::truth
