#pragma once

#include <stop_token>

#include "detp.h"
#include "detp/sim/base/phase.hpp"

namespace detp::c {

/// The caller's progress function: its answer "stop" becomes a stop request.
class Watch {
 public:
  Watch(detp_progress progress, void* user) : progress_(progress), user_(user) {}

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

  void show(const char* what, double share) const {
    std::stop_source stop = stop_;
    if (progress_ != nullptr && progress_(user_, what, share) != 0) stop.request_stop();
  }

  /// Empty without a function.
  [[nodiscard]] sim::ReportPhase report() const {
    if (progress_ == nullptr) return {};
    return [this](const sim::Phase& phase) { show(phase.what.c_str(), phase.from); };
  }

 private:
  detp_progress progress_;
  void* user_;
  std::stop_source stop_;
};

}  // namespace detp::c
