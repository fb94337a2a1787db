/// Processor time of the calling thread.
#pragma once

#include <time.h>

namespace tarmac::sim::lidar {

inline double thread_cpu_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace tarmac::sim::lidar
