#include "interruption.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>

namespace detp::cli {
namespace {

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

Interruption::Interruption() {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = std::jthread([stop = stop_, set](const std::stop_token& end) mutable {
    const timespec wait{0, 50'000'000};
    while (!end.stop_requested()) {
      if (sigtimedwait(&set, nullptr, &wait) < 0) continue;
      if (stop.stop_requested()) std::_Exit(130);
      stop.request_stop();
    }
  });
}

void Interruption::limit(double seconds) {
  if (!(seconds > 0)) return;
  clock_ = std::jthread([stop = stop_, seconds](const std::stop_token& end) mutable {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, end, std::chrono::duration<double>(seconds), [] { return false; });
    if (!end.stop_requested()) stop.request_stop();
  });
}

}  // namespace detp::cli
