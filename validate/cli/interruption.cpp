#include "interruption.hpp"

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "detp/sim/files/part_files.hpp"

namespace detp::cli {
namespace {

/// The destructor sends this signal to the thread that waits for signals, so that its wait ends. The default
/// action of this signal is to do nothing, so blocking it changes nothing for other code.
constexpr int wake_up = SIGURG;

constexpr double longest = 1e9;  // seconds: no overflow when added to a clock's time

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && (action.sa_flags & SA_SIGINFO) == 0 &&
         action.sa_handler == SIG_IGN;
}

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, wake_up}) sigaddset(&set, signal);
  if (!is_ignored(SIGHUP)) sigaddset(&set, SIGHUP);
  return set;
}

}  // namespace

Interruption::Interruption() {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = std::jthread([this, set](const std::stop_token& end) {
    const std::stop_callback wake(end, [self = pthread_self()] { pthread_kill(self, wake_up); });
    bool second = false;
    while (!end.stop_requested()) {
      const int signal = sigwaitinfo(&set, nullptr);
      if (signal < 0 || signal == wake_up) continue;
      if (std::exchange(second, true)) {
        sim::remove_all_part_files_for_good();
        std::_Exit(130);
      }
      request(false);
    }
  });
}

void Interruption::limit(double seconds) {
  if (!(seconds > 0)) return;
  const auto end_of_time =
      start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, longest)));
  if (end_of_time <= Clock::now()) return request(true);
  clock_ = std::jthread([this, end_of_time](const std::stop_token& end) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, end, end_of_time, [] { return false; });
    if (!end.stop_requested()) request(true);
  });
}

double Interruption::seconds_since_request() const {
  const Clock::time_point requested = requested_;
  return requested == Clock::time_point{} ? 0 : std::chrono::duration<double>(Clock::now() - requested).count();
}

void Interruption::request(bool by_limit) {
  Clock::time_point none{};
  if (requested_.compare_exchange_strong(none, Clock::now())) by_limit_ = by_limit;
  stop_.request_stop();
  if (!by_limit) signalled_.request_stop();
}

}  // namespace detp::cli
