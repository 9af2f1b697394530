#include "tassilo/app/signals.h"

#include <signal.h>

#include <atomic>

namespace tassilo {
namespace {

std::atomic<bool> interrupted = false;

void on_signal(int) { interrupted = true; }

}  // namespace

void end_cleanly_on_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool is_interrupted() { return interrupted; }

}  // namespace tassilo
