#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "plan.hpp"

/// What the files of a plan share.
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

/// What a plan and its replans share.
struct Plan::Basis {
  PlanOptions options;                                      ///< without stop and progress
  sim::Problem problem;                                     ///< without rays
  double radius;                                            ///< of the discs, root mean square
  double rays;                                              ///< number of rays for which the plan was made
  std::vector<Prediction> candidates = {};                  ///< not empty, the plan's first
  std::optional<Workload> workload = {};                    ///< for closed forms; set if the plan was made by these
  std::optional<sim::DiscOrder> order = {};                 ///< if it is known
  std::shared_ptr<const std::vector<sim::Disc>> own_discs;  ///< of the problem; null if the discs are borrowed
};

/// Builds the index of the candidate; along the known order, if there is one and the candidate is a box tree.
[[nodiscard]] std::unique_ptr<sim::Index> build_index(const sim::Problem& problem, const Candidate& candidate,
                                                      const std::optional<sim::DiscOrder>& order,
                                                      const sim::RunOptions& options);

/// The least ratio of times of any search and its preparation, with radii and numbers of rays of these ratios. Tests are
/// proportional to areas, and discs in cells to volumes, of bodies that are grown by the radius: these are polynomials of
/// the radius, of the second and third degree, without negative coefficients (Steiner's formula).
[[nodiscard]] double least_time_ratio(double radius_ratio, double rays_ratio);

}  // namespace detp::validate
