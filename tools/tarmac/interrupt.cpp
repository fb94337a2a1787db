#include "tools/tarmac/interrupt.h"

#include <csignal>

namespace tarmac::tools {
namespace {
volatile std::sig_atomic_t g_interrupted = 0;
void on_signal(int) {
  g_interrupted = 1;
}
}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A child that ends early must not end us when we write to it.
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return g_interrupted != 0;
}
void throw_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace tarmac::tools
