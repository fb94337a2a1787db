/// What VTK would print, caught: its readers report through a window for messages and go on.
#pragma once

#include <string>
#include <vector>

namespace tarmac::io::world {

/// While it lives, errors and warnings of VTK's objects are kept here and printed nowhere. One at a time.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  /// The first message without VTK's preamble (source file, line, address of the object); "" = nothing was said.
  std::string first() const;

 private:
  struct State;
  State* state_;
};

}  // namespace tarmac::io::world
