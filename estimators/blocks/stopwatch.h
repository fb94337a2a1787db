/// Wall time of a method's stages.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace tarmac::estimators {

class Stopwatch {
 public:
  explicit Stopwatch(std::vector<std::pair<std::string, double>>& laps_ms) : laps_ms_(laps_ms) {}
  /// Notes the time since the last lap under that name.
  void lap(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    laps_ms_.emplace_back(name, std::chrono::duration<double, std::milli>(now - last_).count());
    last_ = now;
  }

 private:
  std::vector<std::pair<std::string, double>>& laps_ms_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace tarmac::estimators
