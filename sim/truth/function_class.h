/// What class of functions a kind of motion is made of: one sentence, written into truth/motion.yaml.
#pragma once

#include <string>

namespace tarmac::sim::truth {

/// Throws InputError for an unknown kind.
std::string motion_function_class(const std::string& kind);

}  // namespace tarmac::sim::truth
