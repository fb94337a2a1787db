#include "core/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::core {

/// What came from `--set` has no line; its place is said by the argument itself.
struct ConfigNode::State {
  YAML::Node node{YAML::NodeType::Undefined};
  std::string file;
  std::string path;                             ///< dotted, from the file's root
  YAML::Mark key = YAML::Mark::null_mark();     ///< of the key that names this node; none for roots and list items
  std::shared_ptr<std::set<std::string>> sets;  ///< paths that `--set` gave, with "=value"

  /// Where to point at: at the key, since a block's own mark is that of its first line inside, and that of a key
  /// without a value is what follows.
  YAML::Mark mark() const {
    if (!key.is_null()) return key;
    return node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
  }
};

namespace {

std::string joined(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

[[noreturn]] void fail_where(const std::string& file, const YAML::Mark& mark, const std::string& path,
                             const std::string& message) {
  std::string where = file;
  if (!mark.is_null()) where += fmt::format(":{}", mark.line + 1);
  throw InputError(fmt::format("{}: {}{}{}", where, path, path.empty() ? "" : ": ", message));
}

/// An alias may stand inside its own anchor: what is nested deeper than this refers to itself.
constexpr int kDeepest = 64;

void refuse_repeated_keys(const YAML::Node& node, const std::string& file, const std::string& path, int depth = 0) {
  if (depth > kDeepest) fail_where(file, node.Mark(), "", "is nested too deep; does it refer to itself?");
  if (node.IsMap()) {
    std::set<std::string> seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) fail_where(file, entry.first.Mark(), path, "a key must be plain text");
      const std::string key = entry.first.Scalar();
      if (!seen.insert(key).second) fail_where(file, entry.first.Mark(), joined(path, key), "stands twice; remove one");
      refuse_repeated_keys(entry.second, file, joined(path, key), depth + 1);
    }
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      refuse_repeated_keys(node[i], file, joined(path, std::to_string(i)), depth + 1);
    }
  }
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

/// Reads options from one block; nested blocks by a stack of nodes.
class Reader final : public OptionVisitor {
 public:
  Reader(const ConfigNode& root, const std::vector<std::string>& also_known) { stack_.push_back({root, also_known}); }
  void finish() { stack_.back().node.allow_only(stack_.back().known); }

  void operator()(const char* name, bool& value, const char*) override {
    if (const ConfigNode node = take(name); node.present()) {
      const std::string text = node.scalar(name);
      if (text != "true" && text != "false") node.fail(fmt::format("'{}' must be true or false", text));
      value = text == "true";
    }
  }
  void operator()(const char* name, int& value, const char*, Range range) override {
    std::int64_t wide = value;
    integer(name, wide, range, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    value = static_cast<int>(wide);
  }
  void operator()(const char* name, std::int64_t& value, const char*, Range range) override {
    integer(name, value, range, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
  }
  void operator()(const char* name, double& value, const char*, Range range) override {
    if (const ConfigNode node = take(name); node.present()) value = number(node, name, range);
  }
  void operator()(const char* name, std::string& value, const char*) override {
    if (const ConfigNode node = take(name); node.present()) value = node.scalar(name);
  }
  void operator()(const char* name, Eigen::Vector2d& value, const char*) override { fixed(name, value.data(), 2); }
  void operator()(const char* name, Eigen::Vector3d& value, const char*) override { fixed(name, value.data(), 3); }
  void operator()(const char* name, std::vector<double>& value, const char*, Range range) override {
    if (const ConfigNode node = take(name); node.present()) {
      value.clear();
      for (const ConfigNode& item : node.items()) value.push_back(number(item, name, range));
    }
  }
  void operator()(const char* name, std::vector<std::string>& value, const char*) override {
    if (const ConfigNode node = take(name); node.present()) {
      value.clear();
      for (const ConfigNode& item : node.items()) value.push_back(item.scalar(name));
    }
  }
  void operator()(const char* name, SE3& value, const char*) override {
    if (const ConfigNode node = take(name); node.present()) value = pose(node);
  }
  void choice(const char* name, std::string& value, const std::vector<std::string>& allowed, const char*) override {
    const ConfigNode node = take(name);
    if (!node.present()) return;
    const std::string text = node.scalar(name);
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      const std::string guess = did_you_mean(text, allowed);
      node.fail(fmt::format("'{}' is not one of {}{}", text, fmt::join(allowed, ", "),
                            guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess)));
    }
    value = text;
  }

 private:
  struct Level {
    ConfigNode node;
    std::vector<std::string> known;
    std::vector<ConfigNode> items = {};
  };

  ConfigNode take(const char* name) {
    stack_.back().known.emplace_back(name);
    return stack_.back().node.child(name);
  }
  static double number(const ConfigNode& node, const char* name, const Range& range) {
    const std::string text = node.scalar(name);
    double value = 0;
    const char *first = text.data() + (text.starts_with('+') ? 1 : 0), *last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc() || end != last || !std::isfinite(value)) {
      node.fail(fmt::format("'{}' must be a finite number", text));
    }
    if (!range.holds(value)) node.fail(fmt::format("{} must be {}", text, range.text()));
    return value;
  }
  void integer(const char* name, std::int64_t& value, const Range& range, std::int64_t low, std::int64_t high) {
    const ConfigNode node = take(name);
    if (!node.present()) return;
    const std::string text = node.scalar(name);
    std::int64_t read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || end != text.data() + text.size() || read < low || read > high) {
      node.fail(fmt::format("'{}' must be a whole number", text));
    }
    if (!range.holds(static_cast<double>(read))) node.fail(fmt::format("{} must be {}", text, range.text()));
    value = read;
  }
  void fixed(const char* name, double* values, std::size_t n) {
    if (const ConfigNode node = take(name); node.present()) fixed_of(node, name, values, n);
  }
  static void fixed_of(const ConfigNode& node, const char* name, double* values, std::size_t n) {
    const std::vector<ConfigNode> items = node.items();
    if (items.size() != n) node.fail(fmt::format("has {} numbers, {} were expected", items.size(), n));
    for (std::size_t i = 0; i < n; ++i) values[i] = number(items[i], name, {});
  }
  static SE3 pose(const ConfigNode& node) {
    node.allow_only({"xyz_m", "rpy_deg", "quat_xyzw"});
    Eigen::Vector3d xyz_m = Eigen::Vector3d::Zero();
    if (const ConfigNode xyz = node.child("xyz_m"); xyz.present()) fixed_of(xyz, "xyz_m", xyz_m.data(), 3);
    const ConfigNode rpy = node.child("rpy_deg"), quat = node.child("quat_xyzw");
    if (rpy.present() && quat.present()) node.fail("give rpy_deg or quat_xyzw, not both");
    SE3 T = SE3::Identity();
    if (quat.present()) {
      Eigen::Vector4d q;
      fixed_of(quat, "quat_xyzw", q.data(), 4);
      try {
        T = se3::from_xyz_quat(xyz_m, q);
      } catch (const InputError& error) {
        quat.fail(error.what());
      }
      return T;
    }
    if (rpy.present()) {
      Eigen::Vector3d rpy_deg;
      fixed_of(rpy, "rpy_deg", rpy_deg.data(), 3);
      const Eigen::Vector3d a = rpy_deg * std::numbers::pi / 180;
      T.linear() =
          (Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
    }
    T.translation() = xyz_m;
    return T;
  }

  bool enter_group(const char* name, const char*) override {
    const ConfigNode node = take(name);
    if (node.present() && !node.is_block()) node.fail("must be a block of `key: value` lines");
    stack_.push_back({node, {}});
    return node.present();
  }
  void leave_group() override {
    if (stack_.back().node.present()) finish();
    stack_.pop_back();
  }
  std::size_t enter_list(const char* name, const char*, std::size_t current) override {
    const ConfigNode node = take(name);
    stack_.push_back({node, {}});
    if (!node.present()) {
      stack_.back().items.resize(current);  // absent nodes: the defaults stay
      return current;
    }
    stack_.back().items = node.items();
    return stack_.back().items.size();
  }
  void leave_list() override { stack_.pop_back(); }
  void enter_item(std::size_t index) override {
    const ConfigNode node = stack_.back().items.at(index);
    if (node.present() && !node.is_block()) node.fail("must be a block of `key: value` lines");
    stack_.push_back({node, {}});
  }
  void leave_item() override {
    if (stack_.back().node.present()) finish();
    stack_.pop_back();
  }

  std::vector<Level> stack_;
};

}  // namespace

ConfigNode::ConfigNode() : state_(std::make_shared<State>()) {}
ConfigNode::~ConfigNode() = default;
ConfigNode::ConfigNode(const ConfigNode&) = default;
ConfigNode& ConfigNode::operator=(const ConfigNode&) = default;

ConfigNode ConfigNode::parse(const std::string& text, const std::string& file_name) {
  ConfigNode config;
  config.state_->file = file_name;
  config.state_->sets = std::make_shared<std::set<std::string>>();
  try {
    config.state_->node = YAML::Load(text);
  } catch (const YAML::ParserException& error) {
    throw InputError(fmt::format("{}:{}: column {}: this is no YAML: {}", file_name, error.mark.line + 1,
                                 error.mark.column + 1, error.msg));
  }
  refuse_repeated_keys(config.state_->node, file_name, "");
  return config;
}

ConfigNode ConfigNode::load(const std::string& path) {
  return parse(read_file(path), path);
}

bool ConfigNode::present() const {
  return state_->node.IsDefined() && !state_->node.IsNull();
}
bool ConfigNode::is_block() const {
  return present() && state_->node.IsMap();
}
bool ConfigNode::is_list() const {
  return present() && state_->node.IsSequence();
}

ConfigNode ConfigNode::child(const std::string& name) const {
  ConfigNode out;
  out.state_->file = state_->file;
  out.state_->sets = state_->sets;
  out.state_->path = joined(state_->path, name);
  if (present() && !is_block()) fail("must be a block of `key: value` lines");
  if (present()) {
    const YAML::Node& self = state_->node;
    for (const auto& entry : self) {
      if (entry.first.Scalar() != name) continue;
      out.state_->node.reset(entry.second);
      out.state_->key = entry.first.Mark();
    }
  }
  return out;
}

std::vector<ConfigNode> ConfigNode::items() const {
  std::vector<ConfigNode> out;
  if (!present()) return out;
  if (!is_list()) fail("must be a list");
  for (std::size_t i = 0; i < state_->node.size(); ++i) {
    ConfigNode item;
    item.state_->file = state_->file;
    item.state_->sets = state_->sets;
    item.state_->path = joined(state_->path, std::to_string(i));
    item.state_->node.reset(state_->node[i]);
    out.push_back(item);
  }
  return out;
}

std::vector<std::string> ConfigNode::keys() const {
  std::vector<std::string> out;
  if (!present()) return out;
  if (!is_block()) fail("must be a block of `key: value` lines");
  for (const auto& entry : state_->node) out.push_back(entry.first.Scalar());
  return out;
}

std::string ConfigNode::scalar(const char* name) const {
  if (!present()) fail(fmt::format("{} is missing", name));
  if (!state_->node.IsScalar()) fail("must be a single value");
  return state_->node.Scalar();
}

std::string ConfigNode::scalar_or(const std::string& otherwise) const {
  return present() ? scalar("value") : otherwise;
}

void ConfigNode::read_into(const std::function<void(OptionVisitor&)>& visit,
                           const std::vector<std::string>& also_known) const {
  if (present() && !is_block()) fail("must be a block of `key: value` lines");
  Reader reader(*this, also_known);
  visit(reader);
  reader.finish();
}

void ConfigNode::allow_only(const std::vector<std::string>& known) const {
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string guess = did_you_mean(key, known);
    child(key).fail(guess.empty() ? fmt::format("there is no such option here; known are {}", fmt::join(known, ", "))
                                  : fmt::format("there is no such option here; did you mean '{}'?", guess));
  }
}

void ConfigNode::set(const std::string& dotted_path, const std::string& yaml_value) {
  const std::string where = fmt::format("--set {}={}", dotted_path, yaml_value);
  YAML::Node value;
  try {
    value = YAML::Load(yaml_value);
  } catch (const YAML::ParserException& error) {
    throw InputError(fmt::format("{}: the value is no YAML: {}", where, error.msg));
  }
  refuse_repeated_keys(value, where, dotted_path);
  if (dotted_path.empty() || dotted_path.front() == '.' || dotted_path.back() == '.' ||
      dotted_path.find("..") != std::string::npos) {
    throw InputError(fmt::format("{}: expected a dotted path such as motion.cruise_m_s=5", where));
  }
  if (!present()) state_->node = YAML::Node(YAML::NodeType::Map);
  YAML::Node at;
  at.reset(state_->node);
  std::string rest = dotted_path;
  while (true) {
    const std::size_t dot = rest.find('.');
    const std::string name = rest.substr(0, dot);
    YAML::Node next;
    if (at.IsSequence()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
      if (error != std::errc() || end != name.data() + name.size() || index >= at.size()) {
        throw InputError(fmt::format("{}: '{}' is no index into a list of {}", where, name, at.size()));
      }
      next.reset(at[index]);
    } else if (at.IsMap() || at.IsNull() || !at.IsDefined()) {
      next.reset(at[name]);
    } else {
      throw InputError(fmt::format("{}: '{}' lies inside a single value, not a block", where, name));
    }
    if (dot == std::string::npos) {
      next = value;
      break;
    }
    rest = rest.substr(dot + 1);
    at.reset(next);
  }
  if (!state_->sets) state_->sets = std::make_shared<std::set<std::string>>();
  state_->sets->insert(dotted_path);
}

bool ConfigNode::given_by_set() const {
  if (!state_->sets) return false;
  for (const std::string& path : *state_->sets)
    if (state_->path == path || state_->path.starts_with(path + ".")) return true;
  return false;
}

void ConfigNode::fail(const std::string& message) const {
  if (state_->sets) {
    for (const std::string& path : *state_->sets) {
      if (state_->path == path || state_->path.starts_with(path + ".")) {
        throw InputError(fmt::format("--set {}: {}: {}", path, state_->path, message));
      }
    }
  }
  fail_where(state_->file, state_->mark(), state_->path, message);
}

void ConfigNode::fail_at(const std::string& child_name, const std::string& message) const {
  const ConfigNode node = child(child_name);
  if (node.present()) node.fail(message);
  // An absent field is reported at the line of the block that lacks it.
  fail_where(state_->file, state_->mark(), joined(state_->path, child_name), message);
}

std::string ConfigNode::text() const {
  if (!present()) return "";
  return YAML::Dump(state_->node) + "\n";
}

const std::string& ConfigNode::file() const {
  return state_->file;
}
int ConfigNode::line() const {
  const YAML::Mark mark = present() ? state_->mark() : YAML::Mark::null_mark();
  return mark.is_null() ? 0 : mark.line + 1;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tarmac::core
