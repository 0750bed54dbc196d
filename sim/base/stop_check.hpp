#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>

#include "stopped.hpp"

/// Checks for a stop request inside a loop, often enough to bound the work between two checks.
namespace detp::sim {

/// A log of the checks, for tests and displays of progress.
struct WorkLog {
  std::atomic<std::uint64_t> total = 0;                ///< units of work reported
  std::atomic<std::uint64_t> largest = 0;              ///< largest amount of work between two checks
  std::function<void(std::uint64_t total)> seen = {};  ///< called at each check, before it looks for a stop request

  void add(std::uint64_t work) {
    total += work;
    if (seen) seen(total);
    std::uint64_t known = largest;
    while (known < work && !largest.compare_exchange_weak(known, work)) {
    }
  }
};

/// The log of all checks. Null, except in tests that count work and while progress is shown.
inline std::atomic<WorkLog*> work_log = nullptr;

/// Adds up the work that a loop reports, and checks for a stop request whenever `most_work` units have accumulated. A
/// unit of work takes 1 ns to 1 µs: testing a ray against a disc, inserting a disc into a cell, a photon's bounce,
/// testing a vector of rays against a box. Loops report at most `most_work` units at once, so there are fewer than 2
/// `most_work` units between two checks.
///
/// Not thread-safe: a loop on several threads has one StopCheck per thread.
class StopCheck {
 public:
  static constexpr std::uint64_t most_work = std::uint64_t{1} << 16;

  /// `doing` appears in the message of Stopped, for instance "building the octree".
  explicit StopCheck(std::stop_token stop = {}, const char* doing = "working")
      : stop_(std::move(stop)), doing_(doing) {}
  StopCheck(const StopCheck&) = default;
  StopCheck& operator=(const StopCheck&) = default;
  ~StopCheck() {
    if (WorkLog* const log = work_log.load(std::memory_order_relaxed); log != nullptr && !stopped_) log->add(work_);
  }

  /// Reports work without checking.
  void add(std::uint64_t work) { work_ += work; }

  /// Reports work. Returns whether a stop request has been seen; once true, always true.
  [[nodiscard]] bool requested_after(std::uint64_t work) {
    work_ += work;
    return work_ >= most_work && requested();
  }

  /// Reports work; throws Stopped if a stop was requested.
  void after(std::uint64_t work) {
    if (requested_after(work)) stop_now();
  }

  /// Checks now.
  [[nodiscard]] bool requested() {
    if (stopped_) return true;
    if (WorkLog* const log = work_log.load(std::memory_order_relaxed)) log->add(work_);
    stopped_ = stop_.stop_requested();
    work_ = stopped_ ? most_work : 0;  // makes the next report check again
    return stopped_;
  }

  /// Checks now; throws Stopped if a stop was requested.
  void now() {
    if (requested()) stop_now();
  }

 private:
  [[noreturn]] void stop_now() const { throw Stopped(std::string("stopped while ") + doing_); }

  std::stop_token stop_;
  const char* doing_;
  std::uint64_t work_ = 0;
  bool stopped_ = false;
};

/// Calls visit(i) for i = first … last - 1; each call is a unit of work. Throws Stopped between calls if a stop was
/// requested.
template <class Visit>
void for_each_checked(std::size_t first, std::size_t last, StopCheck& check, const Visit& visit) {
  while (first < last) {
    const std::size_t end = std::min<std::size_t>(last, first + StopCheck::most_work);
    check.after(end - first);
    for (; first < end; ++first) visit(first);
  }
}

/// Calls visit(item) for each item; each call is a unit of work. Throws Stopped between calls if a stop was requested.
template <class T, class Visit>
void for_each_checked(std::span<T> items, StopCheck& check, const Visit& visit) {
  for_each_checked(0, items.size(), check, [&](std::size_t i) { visit(items[i]); });
}

}  // namespace detp::sim
