#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace detp::validate {

/// Requests a stop after `seconds`, or as soon as a stop is requested through `other`.
class StopAfter {
 public:
  StopAfter(const std::stop_token& other, double seconds)
      : on_other_(other, Request{stop_}), clock_([stop = stop_, seconds](const std::stop_token& end) mutable {
          std::mutex mutex;
          std::condition_variable_any never;
          std::unique_lock lock(mutex);
          never.wait_for(lock, end, std::chrono::duration<double>(seconds), [] { return false; });
          if (!end.stop_requested()) stop.request_stop();
        }) {}

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  struct Request {
    std::stop_source stop;
    void operator()() { stop.request_stop(); }
  };

  std::stop_source stop_;
  std::stop_callback<Request> on_other_;
  std::jthread clock_;
};

}  // namespace detp::validate
