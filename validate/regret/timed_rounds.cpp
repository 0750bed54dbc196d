#include "timed_rounds.hpp"

#include <algorithm>
#include <limits>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/in_turns.hpp"
#include "detp/validate/statistics/statistics.hpp"

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

double time_ratio(std::span<const double> times, std::span<const double> reference) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(times.size(), reference.size()); ++i) ratios.push_back(times[i] / reference[i]);
  return ratios.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(ratios));
}

}  // namespace detp::validate
