#include "cli/interrupt.hpp"

#include <atomic>
#include <utility>

namespace gridmerge::cli {
namespace {

// A signal handler is given nothing, so what it needs lies here.
std::atomic<const StopToken*> watched = nullptr;
std::atomic<bool> interrupted = false;

extern "C" void on_interrupt(int /*signal*/) {
  interrupted = true;
  if (const StopToken* token = watched) {
    token->cancel();
  }
}

}  // namespace

Interrupt::Interrupt(StopToken token) : token_(std::move(token)) {
  interrupted = false;
  watched = &token_;
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, &previous_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &previous_, nullptr);
  watched = nullptr;
}

bool Interrupt::happened() const { return interrupted; }

}  // namespace gridmerge::cli
