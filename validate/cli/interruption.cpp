#include "interruption.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>

#include "detp/sim/scene/part_files.hpp"

namespace detp::cli {
namespace {

/// What ends the wait for signals when the program ends; by default it does nothing, so that no one else misses it.
constexpr int wake_up = SIGURG;

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, wake_up);
  return set;
}

}  // namespace

Interruption::Interruption() {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = std::jthread([stop = stop_, set](const std::stop_token& end) mutable {
    const std::stop_callback wake(end, [self = pthread_self()] { pthread_kill(self, wake_up); });
    while (!end.stop_requested()) {
      const int signal = sigwaitinfo(&set, nullptr);
      if (signal < 0 || signal == wake_up) continue;
      if (stop.stop_requested()) {
        sim::remove_all_part_files_for_good();
        std::_Exit(130);
      }
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
