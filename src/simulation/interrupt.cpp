#include "simulation/interrupt.hpp"

#include <csignal>

namespace riven {

namespace {

volatile std::sig_atomic_t requested = 0;

void request(int /*signal*/) {
  requested = 1;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void watch_interrupts() {
  std::signal(SIGINT, request);
  std::signal(SIGTERM, request);
}

bool interrupt_requested() {
  return requested != 0;
}

}  // namespace riven
