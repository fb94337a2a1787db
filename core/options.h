/// Options declared once: name with unit, default, range, meaning. The YAML reader, `tarmac describe` and the report
/// share the declaration; an unknown key is an error with its line and a suggestion.
///
///   struct KissIcpOptions {
///     double voxel_size_m = 1.0;
///     void visit(core::OptionVisitor& v) {
///       v("voxel_size_m", voxel_size_m, "edge of a map voxel", {.above = 0});
///     }
///   };
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/lie.h"

namespace tarmac::core {

/// Allowed values of a number; the defaults allow all finite ones.
struct Range {
  double above = -std::numeric_limits<double>::infinity();
  double at_least = -std::numeric_limits<double>::infinity();
  double below = std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  bool holds(double value) const { return value > above && value >= at_least && value < below && value <= at_most; }
  /// "above 0 and at most 1"; empty when everything is allowed.
  std::string text() const;
};

/// Visits every option of a struct in its order of declaration.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;
  virtual void operator()(const char* name, bool& value, const char* meaning) = 0;
  virtual void operator()(const char* name, int& value, const char* meaning, Range range = {}) = 0;
  virtual void operator()(const char* name, std::int64_t& value, const char* meaning, Range range = {}) = 0;
  virtual void operator()(const char* name, double& value, const char* meaning, Range range = {}) = 0;
  virtual void operator()(const char* name, std::string& value, const char* meaning) = 0;
  virtual void operator()(const char* name, Eigen::Vector2d& value, const char* meaning) = 0;
  virtual void operator()(const char* name, Eigen::Vector3d& value, const char* meaning) = 0;
  /// One of `allowed`; anything else is an error that lists them.
  virtual void choice(const char* name, std::string& value, const std::vector<std::string>& allowed,
                      const char* meaning) = 0;
  virtual void operator()(const char* name, std::vector<double>& value, const char* meaning, Range range = {}) = 0;
  virtual void operator()(const char* name, std::vector<std::string>& value, const char* meaning) = 0;
  /// {xyz_m: [..], rpy_deg: [..]} (yaw about z, then pitch about y, then roll about x) or {xyz_m, quat_xyzw}.
  virtual void operator()(const char* name, SE3& value, const char* meaning) = 0;

  /// A nested block of options.
  template <class Options>
  void group(const char* name, Options& options, const char* meaning) {
    if (enter_group(name, meaning)) options.visit(*this);
    leave_group();
  }
  /// A list of blocks, each read by Options::visit.
  template <class Options>
  void list(const char* name, std::vector<Options>& items, const char* meaning) {
    items.resize(enter_list(name, meaning, items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) {
      enter_item(i);
      items[i].visit(*this);
      leave_item();
    }
    leave_list();
  }

 protected:
  /// False: nothing to visit inside (the block is absent and its defaults stay).
  virtual bool enter_group(const char* name, const char* meaning) = 0;
  virtual void leave_group() = 0;
  /// Returns the number of items that the list shall have.
  virtual std::size_t enter_list(const char* name, const char* meaning, std::size_t current) = 0;
  virtual void leave_list() = 0;
  virtual void enter_item(std::size_t index) = 0;
  virtual void leave_item() = 0;
};

/// One line of `tarmac describe`.
struct OptionDescription {
  std::string name;  ///< dotted path
  std::string type;
  std::string default_value;
  std::string allowed;
  std::string meaning;
};

/// Collects the declarations of an options struct with its current values.
std::vector<OptionDescription> describe_options_of(const std::function<void(OptionVisitor&)>& visit);
template <class Options>
std::vector<OptionDescription> describe_options(Options options = {}) {
  return describe_options_of([&](OptionVisitor& v) { options.visit(v); });
}

/// The options as YAML text, every value written out, `indent` spaces before each line (0: a document of its own).
std::string write_options_of(const std::function<void(OptionVisitor&)>& visit, int indent = 0);
template <class Options>
std::string write_options(Options options, int indent = 0) {
  return write_options_of([&](OptionVisitor& v) { options.visit(v); }, indent);
}

}  // namespace tarmac::core
