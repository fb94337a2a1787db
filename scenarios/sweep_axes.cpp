#include "scenarios/sweep_axes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/random.h"

namespace tarmac::scenarios {
namespace {

using core::ConfigNode;

constexpr int kMaxSteps = 100000, kMaxDraws = 100000;

/// What YAML would read as something else than this very text has to be quoted.
bool is_plain(const std::string& text) {
  constexpr const char* kSafe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-";
  if (text.empty() || text.find_first_not_of(kSafe) != std::string::npos) return false;
  return text != "null" && text != "Null" && text != "NULL" && !text.starts_with("-") && !text.starts_with("..");
}

std::string quoted(const std::string& text) {
  if (is_plain(text) || number_of(text)) return text;
  const bool printable =
      std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
  std::string out;
  if (printable) {
    for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
    return "'" + out + "'";
  }
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += fmt::format("\\{}", c);
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return "\"" + out + "\"";
}

struct RangeOptions {
  double from = 0, to = 0;
  int steps = 0;
  std::string scale = "linear";
  bool integer = false;
  bool in_steps = true;
  void visit(core::OptionVisitor& v) {
    v("from", from, "first value");
    v("to", to, "last value, above the first");
    if (in_steps) v("steps", steps, "number of values, both ends included", {.at_least = 2, .at_most = kMaxSteps});
    v.choice("scale", scale, {"linear", "log"}, "even steps of the value or of its logarithm");
    v("integer", integer, "whole numbers only: values are rounded");
  }
};

RangeOptions read_range(const ConfigNode& node, bool in_steps) {
  RangeOptions o;
  o.in_steps = in_steps;
  const std::string expected =
      in_steps ? "a range is {from: 1, to: 8, steps: 4}, or with scale: log" : "a range is {from: 1, to: 8}";
  node.read(o);
  for (const char* key : {"from", "to", "steps"}) {
    if (key == std::string("steps") && !in_steps) continue;
    if (!node.child(key).present()) node.fail_at(key, fmt::format("is missing; {}", expected));
  }
  if (o.from >= o.to) node.fail_at("to", fmt::format("{} must be above from, {}", o.to, o.from));
  if (o.scale == "log" && o.from <= 0) node.fail_at("from", fmt::format("{} must be above 0 for scale: log", o.from));
  if (o.integer && (o.from != std::floor(o.from) || o.to != std::floor(o.to))) {
    node.fail_at("integer", fmt::format("{} to {}: both ends must be whole numbers", o.from, o.to));
  }
  return o;
}

/// Twelve digits: what rounding in the steps adds (0.30000000000000004) goes, what anybody writes stays.
double without_rounding_dust(double value, double scale) {
  if (std::abs(value) < 1e-12 * scale) return 0;
  double clean = value;
  const std::string text = fmt::format("{:.12g}", value);
  std::from_chars(text.data(), text.data() + text.size(), clean);
  return clean;
}

std::vector<std::string> values_in_steps(const ConfigNode& node) {
  const RangeOptions o = read_range(node, true);
  std::vector<std::string> values;
  const double last = o.steps - 1;
  for (int i = 0; i < o.steps; ++i) {
    double value = o.scale == "log" ? std::exp((std::log(o.from) * (last - i) + std::log(o.to) * i) / last)
                                    : (o.from * (last - i) + o.to * i) / last;
    value = without_rounding_dust(value, std::max(std::abs(o.from), std::abs(o.to)));
    if (o.integer) value = std::round(value);
    if (i == 0) value = o.from;
    if (i == o.steps - 1) value = o.to;
    values.push_back(number_text(value));
    if (i > 0 && values[values.size() - 2] == values.back()) {
      node.fail_at("steps", fmt::format("{} are too many: {} comes out twice", o.steps, values.back()));
    }
  }
  return values;
}

std::vector<std::string> listed_values(const ConfigNode& node) {
  std::vector<std::string> values;
  for (const ConfigNode& item : node.items()) {
    values.push_back(one_line_yaml(item));
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      if (same_value(values[i], values.back())) item.fail(fmt::format("{} stands in the list twice", values.back()));
    }
  }
  if (values.empty()) node.fail("the list is empty; give at least one value");
  return values;
}

void refuse_nested_paths(const std::vector<Axis>& axes, const ConfigNode& node) {
  for (const Axis& outer : axes) {
    for (const Axis& inner : axes) {
      if (!inner.path.starts_with(outer.path + ".")) continue;
      node.child(inner.path).fail(fmt::format("lies inside of {}, which has values here as well", outer.path));
    }
  }
}

/// Where u in [0, 1) falls in the range.
double at_share(const AxisRange& range, double u) {
  // A whole number stands for all that rounds to it, so the outermost ones get their full share.
  const double low = range.from - (range.integer ? 0.5 : 0), high = range.to + (range.integer ? 0.5 : 0);
  const double value = range.log ? std::exp(std::log(low) * (1 - u) + std::log(high) * u) : low * (1 - u) + high * u;
  return std::clamp(range.integer ? std::round(value) : value, range.from, range.to);
}

/// The number of fewest digits within `tolerance` of the value, and in [low, high).
double short_number(double value, double tolerance, double low, double high) {
  for (int digits = 1; digits < std::numeric_limits<double>::max_digits10; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    double rounded = value;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    if (std::abs(rounded - value) <= tolerance && rounded >= low && rounded < high) return rounded;
  }
  return value;
}

/// A permutation of 0 ... n-1 (Fisher-Yates); entry i of the stream's second draws.
std::vector<int> permutation(int n, const core::RandomStream& stream) {
  std::vector<int> order(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
  for (int i = n - 1; i > 0; --i) {
    const auto j = static_cast<std::size_t>(stream.uniform(static_cast<std::uint64_t>(i), 1) * (i + 1));
    std::swap(order[static_cast<std::size_t>(i)], order[j]);
  }
  return order;
}

std::string drawn(const Axis& axis, double u, double part_low, double part_high, double accuracy) {
  if (!axis.range) {
    const auto n = static_cast<double>(axis.values.size());
    return axis.values[std::min(static_cast<std::size_t>(u * n), axis.values.size() - 1)];
  }
  const double value = at_share(*axis.range, u);
  if (axis.range->integer) return number_text(value);
  const double low = at_share(*axis.range, part_low), high = at_share(*axis.range, part_high);
  return number_text(short_number(value, accuracy * (high - low), low, high));
}

std::vector<std::string> range_or_list(const ConfigNode& node, Axis& axis, bool drawn_from) {
  if (node.is_list()) return listed_values(node);
  if (!node.is_block()) {
    node.fail(drawn_from ? "must be a list of values or a range such as {from: 1, to: 8}"
                         : "must be a list of values or a range such as {from: 1, to: 8, steps: 4}");
  }
  if (!drawn_from) return values_in_steps(node);
  const RangeOptions o = read_range(node, false);
  axis.range = AxisRange{o.from, o.to, o.scale == "log", o.integer};
  return {};
}

std::vector<Axis> read_axes(const ConfigNode& node, bool drawn_from) {
  std::vector<Axis> axes;
  for (const std::string& path : node.keys()) {
    const ConfigNode value = node.child(path);
    check_path(path, value);
    Axis axis{path, {}, std::nullopt};
    axis.values = range_or_list(value, axis, drawn_from);
    axes.push_back(std::move(axis));
  }
  refuse_nested_paths(axes, node);
  return axes;
}

}  // namespace

void DrawOptions::visit(core::OptionVisitor& v) {
  v("count", count, "number of draws", {.at_least = 1, .at_most = kMaxDraws});
  v.choice("method", method, {"random", "latin-hypercube"}, "each draw by itself, or one in each part of every range");
  v("seed", seed, "of the draws; another seed, other draws", {.at_least = 0});
}

void check_path(const std::string& path, const ConfigNode& node) {
  if (path.empty() || path.front() == '.' || path.back() == '.' || path.find("..") != std::string::npos) {
    node.fail("a part of the path is empty; expected a dotted path such as motion.cruise_m_s");
  }
  static const std::vector<std::string> first_parts = {"duration_s", "scene", "motion", "rig", "faults", "estimators"};
  const std::string first = path.substr(0, path.find('.'));
  if (first == "seed" || first == "seeds") node.fail("seeds are given by `seeds:` of the block or of the file");
  if (std::find(first_parts.begin(), first_parts.end(), first) == first_parts.end()) {
    const std::string guess = core::did_you_mean(first, first_parts);
    node.fail(fmt::format("'{}' is no block of a scenario{}; there are {}", first,
                          guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                          fmt::join(first_parts, ", ")));
  }
  if (first == "duration_s" && path != first) node.fail("duration_s is a single value and has nothing inside");
  if (path == "estimators") node.fail("name the estimator, as in estimators.kiss-icp.voxel_size_m");
}

std::string estimator_of(const std::string& path) {
  constexpr std::string_view kBlock = "estimators.";
  if (!path.starts_with(kBlock)) return "";
  const std::size_t end = path.find('.', kBlock.size());
  return path.substr(kBlock.size(), end == std::string::npos ? end : end - kBlock.size());
}

std::string one_line_yaml(const ConfigNode& node) {
  if (!node.present()) node.fail("has no value; write {} for an empty block and '' for an empty text");
  std::vector<std::string> parts;
  if (node.is_list()) {
    for (const ConfigNode& item : node.items()) parts.push_back(one_line_yaml(item));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (node.is_block()) {
    for (const std::string& key : node.keys()) {
      parts.push_back(fmt::format("{}: {}", quoted(key), one_line_yaml(node.child(key))));
    }
    return fmt::format("{{{}}}", fmt::join(parts, ", "));
  }
  return quoted(node.scalar("value"));
}

std::string number_text(double value) {
  constexpr double kExactIntegers = 9007199254740992.0;  // 2^53
  if (value == std::floor(value) && std::abs(value) < kExactIntegers) {
    return fmt::format("{}", static_cast<std::int64_t>(value));
  }
  return fmt::format("{}", value);
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const char *first = text.data() + (text.starts_with('+') ? 1 : 0), *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::optional<double> x = number_of(a), y = number_of(b);
  return x && y && *x == *y;
}

std::vector<Axis> read_grid(const ConfigNode& vary) {
  return read_axes(vary, false);
}
std::vector<Axis> read_draw_axes(const ConfigNode& over) {
  return read_axes(over, true);
}

std::vector<std::string> draw_values(const Axis& axis, const DrawOptions& options, const std::string& block) {
  const core::RandomStream stream(static_cast<std::uint64_t>(options.seed),
                                  fmt::format("sweep/{}/{}", block, axis.path));
  const bool stratified = options.method == "latin-hypercube";
  const double count = options.count;
  const std::vector<int> part = stratified ? permutation(options.count, stream) : std::vector<int>();
  std::vector<std::string> values;
  for (int i = 0; i < options.count; ++i) {
    const double u = stream.uniform(static_cast<std::uint64_t>(i));
    if (!stratified) {
      values.push_back(drawn(axis, u, 0, 1, 1e-6));
      continue;
    }
    const int k = part[static_cast<std::size_t>(i)];
    // Categories take the part's middle: a part that two of them share then falls to the same one whatever u is.
    const double share = axis.range ? (k + u) / count : (k + 0.5) / count;
    values.push_back(drawn(axis, share, k / count, (k + 1) / count, 1e-4));
  }
  return values;
}

}  // namespace tarmac::scenarios
