/// Ctrl-C and SIGTERM: noticed at the next progress report, so that files are left whole or plainly unfinished.
#pragma once

#include <exception>

namespace tarmac::tools {

/// Thrown at a safe point after Ctrl-C; the program then ends with exit code 130.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

void install_interrupt_handler();
bool interrupted();
void throw_if_interrupted();

}  // namespace tarmac::tools
