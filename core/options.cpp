#include "core/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace tarmac::core {
namespace {

/// Shortest text that reads back as the same double, and always as a number.
std::string number_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

std::string list_text(const double* values, std::size_t n) {
  std::string text = "[";
  for (std::size_t i = 0; i < n; ++i) text += (i ? ", " : "") + number_text(values[i]);
  return text + "]";
}

/// Double-quoted YAML; plain words stay plain.
std::string quoted(const std::string& text) {
  const bool plain = !text.empty() &&
                     text.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                         "0123456789_-./") == std::string::npos &&
                     std::isalpha(static_cast<unsigned char>(text[0])) && text != "true" && text != "false" &&
                     text != "null" && text != "Null" && text != "NULL" && text != "yes" && text != "no" &&
                     text != "on" && text != "off";
  if (plain) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string pose_text(const SE3& T) {
  const Eigen::Vector3d p = T.translation();
  const Eigen::Vector4d q = se3::quat_xyzw(T);
  return fmt::format("{{xyz_m: {}, quat_xyzw: {}}}", list_text(p.data(), 3), list_text(q.data(), 4));
}

/// A visitor that turns every value into text and hands it on.
class TextVisitor : public OptionVisitor {
 public:
  void operator()(const char* name, bool& v, const char* m) override {
    take(name, "true or false", v ? "true" : "false", "", m);
  }
  void operator()(const char* name, int& v, const char* m, Range r) override {
    take(name, "integer", fmt::format("{}", v), r.text(), m);
  }
  void operator()(const char* name, std::int64_t& v, const char* m, Range r) override {
    take(name, "integer", fmt::format("{}", v), r.text(), m);
  }
  void operator()(const char* name, double& v, const char* m, Range r) override {
    take(name, "number", number_text(v), r.text(), m);
  }
  void operator()(const char* name, std::string& v, const char* m) override { take(name, "text", quoted(v), "", m); }
  void operator()(const char* name, Eigen::Vector2d& v, const char* m) override {
    take(name, "2 numbers", list_text(v.data(), 2), "", m);
  }
  void operator()(const char* name, Eigen::Vector3d& v, const char* m) override {
    take(name, "3 numbers", list_text(v.data(), 3), "", m);
  }
  void operator()(const char* name, std::vector<double>& v, const char* m, Range r) override {
    take(name, "list of numbers", list_text(v.data(), v.size()), r.text(), m);
  }
  void operator()(const char* name, std::vector<std::string>& v, const char* m) override {
    std::string text = "[";
    for (std::size_t i = 0; i < v.size(); ++i) text += (i ? ", " : "") + quoted(v[i]);
    take(name, "list of texts", text + "]", "", m);
  }
  void operator()(const char* name, SE3& v, const char* m) override { take(name, "pose", pose_text(v), "", m); }
  void choice(const char* name, std::string& v, const std::vector<std::string>& allowed, const char* m) override {
    take(name, "choice", quoted(v), fmt::format("one of {}", fmt::join(allowed, ", ")), m);
  }

 protected:
  virtual void take(const std::string& name, const char* type, const std::string& value, const std::string& allowed,
                    const char* meaning) = 0;
};

class Describer final : public TextVisitor {
 public:
  std::vector<OptionDescription> lines;

 private:
  void take(const std::string& name, const char* type, const std::string& value, const std::string& allowed,
            const char* meaning) override {
    lines.push_back({prefix_ + name, type, value, allowed, meaning});
  }
  bool enter_group(const char* name, const char*) override {
    lengths_.push_back(prefix_.size());
    prefix_ += std::string(name) + ".";
    return true;
  }
  void leave_group() override { restore(); }
  std::size_t enter_list(const char* name, const char* meaning, std::size_t) override {
    lines.push_back({prefix_ + name, "list", "", "", meaning});
    lengths_.push_back(prefix_.size());
    prefix_ += std::string(name) + "[].";
    return 1;  // one item, to show what an item may hold
  }
  void leave_list() override { restore(); }
  void enter_item(std::size_t) override {}
  void leave_item() override {}
  void restore() {
    prefix_.resize(lengths_.back());
    lengths_.pop_back();
  }
  std::string prefix_;
  std::vector<std::size_t> lengths_;
};

class Writer final : public TextVisitor {
 public:
  explicit Writer(int indent) : indent_(indent) {}
  std::string text;

 private:
  void take(const std::string& name, const char*, const std::string& value, const std::string&, const char*) override {
    line(name + ": " + value);
  }
  bool enter_group(const char* name, const char*) override {
    line(std::string(name) + ":");
    indent_ += 2;
    return true;
  }
  void leave_group() override { indent_ -= 2; }
  std::size_t enter_list(const char* name, const char*, std::size_t current) override {
    line(std::string(name) + (current ? ":" : ": []"));
    return current;
  }
  void leave_list() override {}
  void enter_item(std::size_t) override {
    dash_ = true;
    indent_ += 4;
  }
  void leave_item() override { indent_ -= 4; }
  void line(const std::string& content) {
    text += dash_ ? std::string(static_cast<std::size_t>(indent_ - 2), ' ') + "- "
                  : std::string(static_cast<std::size_t>(indent_), ' ');
    text += content + "\n";
    dash_ = false;
  }
  int indent_;
  bool dash_ = false;
};

}  // namespace

std::string Range::text() const {
  std::vector<std::string> parts;
  if (std::isfinite(above)) parts.push_back("above " + number_text(above));
  if (std::isfinite(at_least)) parts.push_back("at least " + number_text(at_least));
  if (std::isfinite(below)) parts.push_back("below " + number_text(below));
  if (std::isfinite(at_most)) parts.push_back("at most " + number_text(at_most));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::vector<OptionDescription> describe_options_of(const std::function<void(OptionVisitor&)>& visit) {
  Describer describer;
  visit(describer);
  return std::move(describer.lines);
}

std::string write_options_of(const std::function<void(OptionVisitor&)>& visit, int indent) {
  Writer writer(indent);
  visit(writer);
  return std::move(writer.text);
}

}  // namespace tarmac::core
