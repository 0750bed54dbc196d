#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "detp.h"
#include "detp/sim/base/phase.hpp"

namespace detp::c {

/// The caller's progress function: its answer "stop" becomes a stop request. It is called when there is progress, and also ten
/// times a second, so that it can stop the work at any time; one call at a time.
class Watch {
 public:
  /// `what` is done until show() says something else.
  Watch(detp_progress progress, void* user, std::string what)
      : progress_(progress), user_(user), what_(std::move(what)) {
    if (progress_ != nullptr) clock_ = std::jthread([this](const std::stop_token& end) { tick(end); });
  }

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

  void show(const std::string& what, double share) {
    if (progress_ == nullptr) return;
    const std::lock_guard lock(mutex_);
    what_ = what;
    share_ = share;
    call();
  }

  /// Empty without a function.
  [[nodiscard]] sim::ReportPhase report() {
    if (progress_ == nullptr) return {};
    return [this](const sim::Phase& phase) { show(phase.what, phase.from); };
  }

 private:
  void call() {
    if (progress_(user_, what_.c_str(), share_) != 0) stop_.request_stop();
  }

  void tick(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    while (!end_.wait_for(lock, end, std::chrono::milliseconds(100), [] { return false; }) && !end.stop_requested())
      call();
  }

  detp_progress progress_;
  void* user_;
  std::string what_;
  double share_ = 0;
  std::mutex mutex_;
  std::condition_variable_any end_;
  std::stop_source stop_;
  std::jthread clock_;
};

}  // namespace detp::c
