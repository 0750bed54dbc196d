#pragma once

#include <functional>
#include <optional>
#include <vector>

/// Times contenders in turns.
namespace detp::validate {

struct RoundLimits {
  int rounds = 5;
  double behind = 1.5;      ///< a contender that is slower by more than this factor is timed in four rounds only
  double most_seconds = 3;  ///< no further round begins after this time
};

/// The times of each contender, one for each round in which it took part. All contenders take part in the first four
/// rounds. Then those whose shortest time exceeds `behind` times the shortest of all, in these rounds, drop out. Times of
/// other runs decide nothing: the speed of the machine may have changed since.
///
/// Two contenders are compared by median_ratio() of their times. Runs of one round follow each other closely, so a change
/// of the machine's speed from round to round cancels. The shortest times need not be times of the same speed.
///
/// `time` returns the seconds of one run of a contender, or nullopt to end the rounds.
[[nodiscard]] std::vector<std::vector<double>> timed_rounds(
    std::size_t contenders, const RoundLimits& limits, const std::function<std::optional<double>(std::size_t)>& time);

}  // namespace detp::validate
