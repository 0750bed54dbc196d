#include "farm.hpp"

#include <algorithm>
#include <exception>
#include <numeric>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "failures.hpp"

namespace detp::sim {
namespace {

/// How a task ended, before its result or message.
enum class TaskEnd { well, stopped, failed };

}  // namespace

std::vector<int> ranks_for(const std::vector<double>& costs, int ranks) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return costs[i]; });
  std::vector<double> busy(static_cast<std::size_t>(ranks));
  std::vector<int> chosen(costs.size());
  for (const std::size_t task : order) {
    const auto least = std::ranges::min_element(busy);
    *least += costs[task];
    chosen[task] = static_cast<int>(least - busy.begin());
  }
  return chosen;
}

Farm::~Farm() {
  if (ranks_.rank() != 0) return;
  try {
    for (int to = 1; to < ranks_.count(); ++to) ranks_.send_one(std::size_t{0}, to);
  } catch (...) {  // a rank is lost, and another call reports it
  }
}

std::vector<std::string> Farm::all(const std::vector<std::string>& tasks, const std::vector<double>& costs) {
  const std::vector<int> chosen =
      ranks_for(costs.empty() ? std::vector<double>(tasks.size(), 1) : costs, ranks_.count());
  for (int to = 1; to < ranks_.count(); ++to) {
    const auto count = static_cast<std::size_t>(std::ranges::count(chosen, to));
    if (count == 0) continue;  // 0 would end its service
    ranks_.send_one(count, to);
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (chosen[i] == to) send_text(ranks_, tasks[i], to);
  }
  std::vector<std::string> results(tasks.size());
  std::exception_ptr thrown;
  for (std::size_t i = 0; i < tasks.size() && !thrown; ++i) try {
      if (chosen[i] == 0) results[i] = work_(tasks[i]);
    } catch (...) {
      thrown = std::current_exception();
      if (!is_stop(thrown)) ranks_.alert();
    }
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (chosen[i] == 0) continue;
    const auto end = ranks_.receive_one<TaskEnd>(chosen[i]);
    results[i] = receive_text(ranks_, chosen[i]);
    if (end == TaskEnd::failed && (!thrown || is_stop(thrown)))
      thrown = std::make_exception_ptr(RankFailed(chosen[i], results[i]));
    if (end == TaskEnd::stopped && !thrown) thrown = std::make_exception_ptr(Stopped(results[i]));
  }
  if (thrown) std::rethrow_exception(thrown);
  return results;
}

void Farm::serve() {
  while (const auto count = ranks_.receive_one<std::size_t>(0)) {
    std::vector<std::string> tasks;
    for (std::size_t i = 0; i < count; ++i) tasks.push_back(receive_text(ranks_, 0));
    TaskEnd end = TaskEnd::well;
    std::string result;
    for (const std::string& task : tasks) {
      if (end == TaskEnd::well) try {
          result = work_(task);
        } catch (const Stopped& stopped) {
          end = TaskEnd::stopped;
          result = stopped.what();
        } catch (const std::exception& error) {
          end = TaskEnd::failed;
          result = error.what();
          ranks_.alert();
        }
      ranks_.send_one(end, 0);
      send_text(ranks_, result, 0);
    }
  }
}

}  // namespace detp::sim
