#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/technique/searcher.hpp"

namespace detp::validate {

/// A searcher whose index is built when it is first needed. Thread-safe: one thread builds, the others wait.
class LateSearcher {
 public:
  /// Builds the index. The searcher may refer to what the function owns.
  using Build = std::function<sim::Searcher(const std::stop_token& stop)>;

  explicit LateSearcher(sim::Searcher ready) : searcher_(std::move(ready)), is_built_(true) {}
  explicit LateSearcher(Build build) : build_(std::move(build)) {}

  [[nodiscard]] bool is_built() const { return is_built_.load(std::memory_order_acquire); }

  /// If building throws, the next call tries again.
  const sim::Searcher& get(const std::stop_token& stop = {}) {
    const sim::DefaultFloatingPoint mode;
    if (!is_built()) {
      const std::lock_guard lock(mutex_);
      if (!searcher_) {
        searcher_.emplace(build_(stop));
        is_built_.store(true, std::memory_order_release);
      }
    }
    return *searcher_;
  }

 private:
  Build build_;  ///< kept, because the searcher may refer to what it owns
  std::mutex mutex_;
  std::optional<sim::Searcher> searcher_;
  std::atomic<bool> is_built_ = false;
};

}  // namespace detp::validate
