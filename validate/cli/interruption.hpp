#pragma once

#include <atomic>
#include <chrono>
#include <stop_token>
#include <thread>

namespace detp::cli {

/// Turns Ctrl-C (SIGINT), SIGTERM, SIGHUP or the end of a time limit into a stop request, so that a command can print
/// its results so far. A second signal ends the program at once. SIGHUP stays ignored if it was ignored when the
/// program started (nohup).
///
/// Must be created before any other thread, because threads inherit the signal mask.
class Interruption {
 public:
  Interruption();

  /// As a first signal; from any thread.
  void stop() { request(false); }

  /// Sets the time limit, in seconds since construction. 0 or less means no limit.
  void limit(double seconds);

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
  /// A stop that a signal requested, not the time limit.
  [[nodiscard]] std::stop_token signal_token() const { return signalled_.get_token(); }

  /// The stop request came from the time limit.
  [[nodiscard]] bool by_limit() const { return by_limit_; }

  /// Seconds since the stop request; 0 if there was none.
  [[nodiscard]] double seconds_since_request() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// The first request counts.
  void request(bool by_limit);

  Clock::time_point start_ = Clock::now();
  std::atomic<Clock::time_point> requested_ = Clock::time_point{};
  std::atomic<bool> by_limit_ = false;
  std::stop_source stop_;
  std::stop_source signalled_;
  std::jthread signals_;
  std::jthread clock_;
};

}  // namespace detp::cli
