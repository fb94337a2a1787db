/// What the program says while it works: a bar on a terminal, plain lines elsewhere, nothing when quiet.
#pragma once

#include <string>

#include "core/progress.h"

namespace tarmac::tools {

class Console {
 public:
  explicit Console(bool quiet);
  bool quiet() const { return quiet_; }
  /// A line of news on standard error; standard output is for results.
  void say(const std::string& line) const;
  /// A warning is said even when quiet.
  void warn(const std::string& line) const;
  /// Reports for one piece of work; throws Interrupted after Ctrl-C. Call done() of the label through fraction 1.
  core::Progress progress(const std::string& label) const;

 private:
  bool quiet_;
  bool terminal_;
};

}  // namespace tarmac::tools
