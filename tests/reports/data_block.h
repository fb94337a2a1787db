/// What a page carries for its script.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tarmac::reports {

/// Throws std::runtime_error where there is none.
nlohmann::json data_of(const std::string& page);

}  // namespace tarmac::reports
