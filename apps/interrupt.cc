// SPDX-License-Identifier: Apache-2.0
#include "apps/interrupt.h"

#include <csignal>

namespace bodyloom {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void RaiseFlag(int) { interrupt_flag = 1; }

}  // namespace

void InstallSignalHandlers() {
  struct sigaction action = {};
  action.sa_handler = RaiseFlag;
  // SA_RESETHAND: a second signal has its default effect, for work that does not poll.
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool IsInterrupted() { return interrupt_flag != 0; }

}  // namespace bodyloom
