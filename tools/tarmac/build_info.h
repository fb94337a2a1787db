/// Which program this is: filled in at build time.
#pragma once

#include <string>

namespace tarmac::tools {

struct BuildInfo {
  std::string version;   ///< "0.1.0"
  std::string commit;    ///< git's name of it, with "-modified" where the tree differed; "unknown" outside git
  std::string compiler;  ///< "GNU 12.2.0"
  std::string build_type;
};
BuildInfo build_info();

}  // namespace tarmac::tools
