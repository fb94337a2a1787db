/// What went wrong, where, and what to try. InputError ends the program with exit code 2.
#pragma once

#include <stdexcept>
#include <string>

namespace tarmac::core {

/// Bad usage or bad input: the message says file, line, field, what was expected and what to do.
/// Anything else that is thrown is an internal error (exit code 4).
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that ends early, has no index footer, or whose bytes are not what its header says.
class DamagedFile : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace tarmac::core
