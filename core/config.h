/// A YAML file, or a part of one, that remembers where each value stands. yaml-cpp stays behind this header.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"

namespace tarmac::core {

/// A node of a configuration. Copies share the node. An absent node reads as an empty block.
class ConfigNode {
 public:
  ConfigNode();  ///< absent
  ~ConfigNode();
  ConfigNode(const ConfigNode&);
  ConfigNode& operator=(const ConfigNode&);

  /// Throws InputError (file, line, column, what is wrong) when the text is no YAML or a key stands twice.
  static ConfigNode parse(const std::string& text, const std::string& file_name);
  /// Reads the file; throws InputError when it cannot be read.
  static ConfigNode load(const std::string& path);

  bool present() const;
  bool is_block() const;
  bool is_list() const;
  /// The child of that name; absent if there is none.
  ConfigNode child(const std::string& name) const;
  /// Items of a list, in order; throws InputError when this is present and no list.
  std::vector<ConfigNode> items() const;
  /// Keys of a block, in the file's order.
  std::vector<std::string> keys() const;
  /// A scalar's text; throws InputError when absent (naming `name`) or not a scalar.
  std::string scalar(const char* name) const;
  std::string scalar_or(const std::string& otherwise) const;

  /// Reads an options struct: absent keys keep their defaults, an unknown key, a wrong type or a value out of range
  /// throws InputError. Keys in `also_known` are allowed and left to the caller.
  void read_into(const std::function<void(OptionVisitor&)>& visit,
                 const std::vector<std::string>& also_known = {}) const;
  template <class Options>
  void read(Options& options, const std::vector<std::string>& also_known = {}) const {
    read_into([&](OptionVisitor& v) { options.visit(v); }, also_known);
  }
  /// Throws InputError with line and did-you-mean unless every key is one of `known`.
  void allow_only(const std::vector<std::string>& known) const;

  /// Sets a value at a dotted path ("motion.cruise_m_s", "rig.lidar.model", "estimators.kiss-icp.voxel_size_m",
  /// "list.0.x"); its errors are reported as coming from `--set path=value`.
  void set(const std::string& dotted_path, const std::string& yaml_value);

  /// True when this, or a block around it, came from set(): paths in it are then the command line's.
  bool given_by_set() const;

  /// "file.yaml:9: rig.lidar.rate_hz: message"
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_at(const std::string& child_name, const std::string& message) const;
  /// The subtree as YAML text.
  std::string text() const;
  const std::string& file() const;
  /// 1-based; 0 when it came from --set or nowhere.
  int line() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// The entry of `candidates` nearest to `word` by edit distance, or "" when none is near enough to be meant.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace tarmac::core
