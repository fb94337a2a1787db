/// How long work reports that it is alive.
#pragma once

#include <functional>
#include <string>

namespace tarmac::core {

/// fraction in [0, 1]; note is short ("12.3 Mrays/s, 14x real time"). Throwing from it aborts the work cleanly.
using Progress = std::function<void(double fraction, const std::string& note)>;

}  // namespace tarmac::core
