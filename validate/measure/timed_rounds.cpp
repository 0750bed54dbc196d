#include "timed_rounds.hpp"

#include <algorithm>
#include <limits>

#include "detp/sim/base/stopwatch.hpp"
#include "in_turns.hpp"

namespace detp::validate {

std::vector<std::vector<double>> timed_rounds(std::size_t contenders, const RoundLimits& limits,
                                              const std::function<std::optional<double>(std::size_t)>& time) {
  constexpr int rounds_of_all = 4;
  const sim::Stopwatch watch;
  std::vector<std::vector<double>> times(contenders);
  std::vector<double> least(contenders, std::numeric_limits<double>::infinity());
  double fastest = std::numeric_limits<double>::infinity();
  const auto begin = [&](int round) {
    fastest = *std::min_element(least.begin(), least.end());
    return round == 0 || watch.seconds() <= limits.most_seconds;
  };
  in_turns(contenders, limits.rounds, begin, [&](std::size_t i, int round) {
    if (round >= rounds_of_all && least[i] > limits.behind * fastest) return true;
    const std::optional<double> seconds = time(i);
    if (!seconds) return false;
    times[i].push_back(*seconds);
    least[i] = std::min(least[i], *seconds);
    return true;
  });
  return times;
}

}  // namespace detp::validate
