#pragma once

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

}  // namespace detp::support
