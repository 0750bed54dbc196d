#include "rounds.hpp"

#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {

TimesOfAll timed_rounds(std::size_t contenders, const RoundLimits& limits,
                        const std::function<std::vector<bool>(const TimesOfAll&)>& goes_on,
                        const std::function<std::optional<double>(std::size_t, std::span<const double>)>& time) {
  const sim::Stopwatch watch;
  TimesOfAll times(contenders);
  std::vector<bool> takes_part(contenders, true);
  int begun = 0;
  in_turns(contenders, limits.rounds, [&](std::size_t i, int round) {
    if (round > begun) {
      begun = round;
      if (round >= limits.least_rounds && watch.seconds() > limits.most_seconds) return false;
      if (round >= limits.rounds_of_all) takes_part = goes_on(times);
    }
    if (!takes_part[i]) return true;
    const std::optional<double> seconds = time(i, times[i]);
    if (seconds) times[i].push_back(*seconds);
    return seconds.has_value();
  });
  return times;
}

std::vector<bool> not_behind(const TimesOfAll& times, double factor) {
  double fastest = std::numeric_limits<double>::infinity();
  for (const auto& of_one : times) fastest = std::min(fastest, std::ranges::min(of_one));
  std::vector<bool> near;
  for (const auto& of_one : times) near.push_back(std::ranges::min(of_one) <= factor * fastest);
  return near;
}

bool RoundTimes::agree() const {
  constexpr double tolerance = 0.05;
  double least = unknown;
  double next = unknown;
  for (const double one : seconds_) {
    next = std::min(next, std::max(one, least));
    least = std::min(least, one);
  }
  return next < unknown && next <= (1 + tolerance) * least;
}

double RoundTimes::usual_search() const {
  std::vector<double> search;
  for (std::size_t i = 0; i < seconds_.size(); ++i) search.push_back(seconds_[i] - preparing_[i]);
  return lower_median(std::move(search));
}

double RoundTimes::lower_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace detp::validate
