/// Starting a child process: what happens between fork and exec.
#pragma once

#include <sys/types.h>

#include <string>

#include "tools/tarmac/child.h"

namespace tarmac::tools {

struct StartedChild {
  pid_t pid = -1;  ///< -1: not started
  int pidfd = -1;  ///< readable once the child has ended; -1 where the kernel has none
  int error = 0;   ///< errno when not started
};

/// The child leads a process group of its own, has default signals, /dev/null as input, the log as output, the pipe's
/// end as descriptor 3, its limits, and gets SIGKILL when the calling thread ends.
StartedChild start_child(const ChildRequest& request, int progress_end);

}  // namespace tarmac::tools
