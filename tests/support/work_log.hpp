#pragma once

#include <doctest/doctest.h>

#include <stop_token>

#include "detp/sim/base/stop_check.hpp"

namespace detp::support {

/// Logs the checks for a stop request while the object exists.
class LoggedWork {
 public:
  explicit LoggedWork(std::function<void(std::uint64_t total)> seen = {}) {
    log_.seen = std::move(seen);
    sim::work_log = &log_;
  }
  ~LoggedWork() { sim::work_log = nullptr; }
  LoggedWork(const LoggedWork&) = delete;
  LoggedWork& operator=(const LoggedWork&) = delete;

  [[nodiscard]] std::uint64_t total() const { return log_.total; }
  [[nodiscard]] std::uint64_t largest() const { return log_.largest; }

  /// True if the work between two checks was always less than 2 sim::StopCheck::most_work.
  [[nodiscard]] bool bounded() const { return log_.largest < 2 * sim::StopCheck::most_work; }

 private:
  sim::WorkLog log_;
};

/// Requests a stop as soon as so much work is logged.
class StopAfterWork {
 public:
  explicit StopAfterWork(double work)
      : log_([this, work](std::uint64_t done) {
          if (static_cast<double>(done) >= work) source_.request_stop();
        }) {}

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  [[nodiscard]] double total() const { return static_cast<double>(log_.total()); }
  [[nodiscard]] bool bounded() const { return log_.bounded(); }

 private:
  std::stop_source source_;
  LoggedWork log_;
};

/// The work of a call, which must be bounded between two checks.
template <class Call>
double bounded_work_of(const Call& call) {
  const LoggedWork logged;
  call();
  CHECK(logged.bounded());
  return static_cast<double>(logged.total());
}

}  // namespace detp::support
