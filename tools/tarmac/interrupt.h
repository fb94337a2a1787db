/// Ctrl-C and SIGTERM: noticed at the next progress report, so that files are left whole or plainly unfinished.
#pragma once

#include <exception>

namespace tarmac::tools {

inline constexpr int kInterruptedExit = 130;  ///< the program's exit code after Ctrl-C

/// Thrown at a safe point after Ctrl-C.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

void install_interrupt_handler();
bool interrupted();
void throw_if_interrupted();

}  // namespace tarmac::tools
