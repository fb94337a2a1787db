#include "io/sensor/text_lines.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::io {
namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  const bool runs = separator == ' ';
  const std::string_view ends = runs ? blanks : std::string_view(&separator, 1);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t stop = std::min(text.find_first_of(ends, at), text.size());
    if (!runs || stop > at) fields.push_back(trimmed(text.substr(at, stop - at)));
    at = stop + 1;
  }
  return fields;
}

/// from_chars takes no leading plus, which some programs write.
std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

template <class T>
std::optional<T> parsed(std::string_view text) {
  text = without_plus(text);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Decimal text times 1e9, rounded half up in magnitude; digits are never put through a floating-point number.
std::optional<std::int64_t> nanoseconds(std::string_view text) {
  text = without_plus(text);
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) text.remove_prefix(1);
  const std::size_t exponent_at = text.find_first_of("eE");
  int exponent = 9;
  if (exponent_at != std::string_view::npos) {
    const std::optional<int> written = parsed<int>(text.substr(exponent_at + 1));
    if (!written || std::abs(*written) > 30) return std::nullopt;
    exponent += *written;
    text = text.substr(0, exponent_at);
  }
  std::string digits(1, '0');  // so that something stays when all digits are cut off
  bool point_seen = false;
  for (const char c : text) {
    if (c == '.' && !point_seen) {
      point_seen = true;
    } else if (c >= '0' && c <= '9') {
      digits.push_back(c);
      if (point_seen) --exponent;
    } else {
      return std::nullopt;
    }
  }
  if (digits.size() == 1) return std::nullopt;
  // digits * 10^exponent: append zeros, or cut digits off and round by the first one cut.
  bool round_up = false;
  if (exponent >= 0) {
    digits.append(static_cast<std::size_t>(exponent), '0');
  } else {
    const std::size_t cut = static_cast<std::size_t>(-exponent);
    if (cut >= digits.size()) digits = std::string(cut + 1 - digits.size(), '0') + digits;
    round_up = digits[digits.size() - cut] >= '5';
    digits.erase(digits.size() - cut);
  }
  const std::optional<std::int64_t> value = parsed<std::int64_t>(digits);
  if (!value || *value == std::numeric_limits<std::int64_t>::max()) return std::nullopt;
  const std::int64_t magnitude = *value + (round_up ? 1 : 0);
  return negative ? -magnitude : magnitude;
}

}  // namespace

void TextLine::fail(const std::string& message) const {
  throw core::InputError(fmt::format("{}:{}: {}", file->string(), number, message));
}

double TextLine::number_at(std::size_t k, const char* meaning) const {
  const std::optional<double> value = parsed<double>(fields.at(k));
  if (!value || !std::isfinite(*value)) {
    fail(fmt::format("field {} ({}) is '{}': expected a finite number", k + 1, meaning, fields.at(k)));
  }
  return *value;
}

std::int64_t TextLine::integer_at(std::size_t k, const char* meaning) const {
  const std::optional<std::int64_t> value = parsed<std::int64_t>(fields.at(k));
  if (!value) fail(fmt::format("field {} ({}) is '{}': expected integer nanoseconds", k + 1, meaning, fields.at(k)));
  return *value;
}

core::Time TextLine::seconds_at(std::size_t k, const char* meaning) const {
  const std::optional<std::int64_t> value = nanoseconds(fields.at(k));
  if (!value) {
    fail(fmt::format("field {} ({}) is '{}': expected seconds as a decimal number, below 9.2e9", k + 1, meaning,
                     fields.at(k)));
  }
  return core::time_from_ns(*value);
}

TextLines::TextLines(const std::filesystem::path& file, char separator)
    : file_(file), content_(core::read_file(file)), separator_(separator) {}

bool TextLines::next(TextLine& line) {
  while (at_ < content_.size()) {
    const std::size_t stop = std::min(content_.find('\n', at_), content_.size());
    std::string_view text = std::string_view(content_).substr(at_, stop - at_);
    at_ = stop + 1;
    ++number_;
    text = text.substr(0, text.find('#'));
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    text = trimmed(text);
    if (text.empty()) continue;
    line = {&file_, number_, text, split(text, separator_)};
    return true;
  }
  return false;
}

std::string seconds_text(core::Time t) {
  const std::int64_t t_ns = core::to_ns(t);
  const std::uint64_t magnitude = t_ns < 0 ? 0 - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  return fmt::format("{}{}.{:09}", t_ns < 0 ? "-" : "", magnitude / 1000000000u, magnitude % 1000000000u);
}

}  // namespace tarmac::io
