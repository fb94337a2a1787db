/// Processor time of the calling thread: what others run meanwhile does not count.
#pragma once

#include <time.h>

namespace tarmac::tools {

inline double thread_cpu_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What `work` takes [s].
template <class Work>
double cpu_s_of(Work&& work) {
  const double before = thread_cpu_s();
  work();
  return thread_cpu_s() - before;
}

}  // namespace tarmac::tools
