#pragma once

#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/measure/measure_all.hpp"

/// Why a choice was not the best.
namespace detp::validate {

/// The reason why `choice` was chosen although `best` is faster, in a few words. The predicted times of the two are the
/// closed forms' for this workload, with these unit costs. Their errors are split by prediction_error() into counts and
/// unit costs. Only what differs between choice and best can change their order, so the reason is the part whose errors
/// differ most: counts, with the count that matters most, or unit costs. `noise` is Exhaustive::noise.
///
/// Empty if the two are the same. Other reasons: the difference is within the noise; the best has no closed form; the
/// best was predicted to be faster than the choice, so the ranking did not try it; the choice was abandoned; they differ
/// only in the number of threads.
[[nodiscard]] std::string reason_of_regret(const Workload& workload, const CostTable& costs, const Timed& choice,
                                           const Timed& best, double noise);

}  // namespace detp::validate
