#include "sim/lidar/channel_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::sim::lidar {
namespace {

using core::InputError;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t stop = std::min(line.find(separator, at), line.size());
    fields.push_back(trimmed(line.substr(at, stop - at)));
    at = stop + 1;
  }
  return fields;
}

/// Where in the file an error is.
struct Place {
  std::string file;
  std::size_t line = 0;
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file, line, message));
  }
};

std::vector<const ChannelColumn*> header_columns(const std::vector<std::string_view>& fields, const Place& place) {
  std::vector<std::string> known;
  for (const ChannelColumn& column : channel_columns()) known.emplace_back(column.name);
  std::vector<const ChannelColumn*> columns;
  for (const std::string_view field : fields) {
    const auto same = [&](const ChannelColumn& column) { return field == column.name; };
    const auto column = std::find_if(channel_columns().begin(), channel_columns().end(), same);
    if (column == channel_columns().end()) {
      const std::string guess = core::did_you_mean(std::string(field), known);
      place.fail(fmt::format("column '{}': there is none of that name; {}", field,
                             guess.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                                           : fmt::format("did you mean '{}'?", guess)));
    }
    if (std::find(columns.begin(), columns.end(), &*column) != columns.end())
      place.fail(fmt::format("column {} stands twice", field));
    columns.push_back(&*column);
  }
  for (const char* needed : {"elevation_deg", "azimuth_offset_cw_deg"})
    if (std::find(fields.begin(), fields.end(), needed) == fields.end())
      place.fail(fmt::format("column {} is missing", needed));
  return columns;
}

double number(std::string_view field, const ChannelColumn& column, const Place& place) {
  double value = 0;
  const char *first = field.data() + (field.starts_with('+') ? 1 : 0), *last = field.data() + field.size();
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last || !std::isfinite(value))
    place.fail(fmt::format("{}: '{}' must be a finite number", column.name, field));
  // The same limits as in a profile.
  const std::string_view name = column.name;
  const double low = name == "elevation_deg"           ? -90
                     : name == "azimuth_offset_cw_deg" ? -180
                     : name.starts_with("origin_")     ? -1e9
                                                       : 0;
  const double high = name == "elevation_deg"           ? 90
                      : name == "azimuth_offset_cw_deg" ? 180
                      : name == "ring"                  ? 65535
                                                        : 1e9;
  if (value < low || value > high)
    place.fail(fmt::format("{}: {} must be at least {} and at most {}", column.name, value, low, high));
  return value;
}

}  // namespace

void read_channel_table(const std::filesystem::path& file, Profile& profile) {
  const std::string text = core::read_file(file);
  Place place{file.string(), 0};
  std::vector<const ChannelColumn*> columns;
  for (const std::string_view line : split(text, '\n')) {
    ++place.line;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = split(line, ',');
    if (columns.empty()) {
      columns = header_columns(fields, place);
      continue;
    }
    if (fields.size() != columns.size())
      place.fail(fmt::format("has {} values; the header names {}", fields.size(), columns.size()));
    for (std::size_t i = 0; i < fields.size(); ++i)
      (profile.*columns[i]->values).push_back(number(fields[i], *columns[i], place));
  }
  if (profile.channels() == 0) throw InputError(fmt::format("{}: holds no channels", file.string()));
}

}  // namespace tarmac::sim::lidar
