/// The values that a sweep gives to one parameter: lists, ranges in steps, and draws. Values are YAML text on one line,
/// as `--set` takes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace tarmac::scenarios {

/// A range, both ends included.
struct AxisRange {
  double from = 0, to = 0;
  bool log = false;      ///< even steps of the logarithm
  bool integer = false;  ///< whole numbers only
};

/// One parameter: listed values, or a range that is drawn from.
struct Axis {
  std::string path;  ///< dotted, of a scenario: motion.cruise_m_s
  std::vector<std::string> values;
  std::optional<AxisRange> range;  ///< only in `draw.over`; then there are no values
};

/// `draw:` of a block.
struct DrawOptions {
  int count = 0;
  std::string method = "random";
  std::int64_t seed = 1;
  void visit(core::OptionVisitor& v);
};

/// A dotted path of a scenario: parts that are not empty, of which the first is one of its blocks or duration_s. Throws
/// InputError at `node`, the value that belongs to the path.
void check_path(const std::string& path, const core::ConfigNode& node);
/// "kiss-icp" of "estimators.kiss-icp.voxel_size_m"; empty for other paths.
std::string estimator_of(const std::string& path);

/// The value as YAML on one line: `0.5`, `[prog, '{input}']`, `{kind: stand}`. Throws InputError when there is none.
std::string one_line_yaml(const core::ConfigNode& node);
/// A number as short as it reads back exactly: `0.1`, `1024`.
std::string number_text(double value);
/// The finite number that all of the text is, if it is one.
std::optional<double> number_of(const std::string& text);
/// True for equal texts and for equal numbers (0.5 and 0.50).
bool same_value(const std::string& a, const std::string& b);

/// `vary:` -- each key with a list, or with {from, to, steps, scale, integer}. Throws InputError.
std::vector<Axis> read_grid(const core::ConfigNode& vary);
/// `draw.over:` -- each key with a list (categories), or with {from, to, scale, integer}. Throws InputError.
std::vector<Axis> read_draw_axes(const core::ConfigNode& over);

/// The axis's value in each of draws 0 ... count-1. `block` names the random stream beside the axis's path: the draws
/// of one axis do not depend on the others. A Latin hypercube has one draw in each of `count` equal parts of the range
/// (of its logarithm), and each category equally often, give or take one. Values of ranges are rounded to few digits,
/// within 1e-4 of such a part and never out of it (random: 1e-6 of the range).
std::vector<std::string> draw_values(const Axis& axis, const DrawOptions& options, const std::string& block);

}  // namespace tarmac::scenarios
