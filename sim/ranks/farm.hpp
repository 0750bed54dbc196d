#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ranks.hpp"

/// Independent tasks that ranks share.
namespace detp::sim {

/// Rank 0 hands out tasks; the others serve it. Tasks and results are bytes. A result must depend on its task alone.
class Farm {
 public:
  using Work = std::function<std::string(const std::string& task)>;

  /// `ranks` and `work`, which is the same on all ranks, must outlive the farm.
  Farm(Ranks& ranks, const Work& work) : ranks_(ranks), work_(work) {}
  /// On rank 0: the others need not serve any more.
  ~Farm();
  Farm(const Farm&) = delete;
  Farm& operator=(const Farm&) = delete;

  /// On rank 0. The results of the tasks, in their order. `costs`: expected, in any unit; empty if all are equal. Each rank does the tasks that
  /// are its own, so that the largest sum of costs is small. Throws what a task throws here, RankFailed for what it throws elsewhere, or
  /// if none failed Stopped if one was stopped; then no task is under way.
  [[nodiscard]] std::vector<std::string> all(const std::vector<std::string>& tasks,
                                             const std::vector<double>& costs = {});

  /// On the other ranks. Does tasks until the farm on rank 0 is destroyed.
  void serve();

 private:
  Ranks& ranks_;
  const Work& work_;
};

/// The rank that does each of the tasks: the most expensive first, each by the rank that has least to do.
[[nodiscard]] std::vector<int> ranks_for(const std::vector<double>& costs, int ranks);

}  // namespace detp::sim
