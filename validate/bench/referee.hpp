#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/job/job.hpp"

namespace detp::validate {

/// The right hits of each disc, and the technique that determined them.
struct RightHits {
  Technique judge = Technique::brute_force;
  std::vector<std::uint64_t> hits;

  /// Sum of |others - right hits| over the discs.
  [[nodiscard]] std::uint64_t wrong_hits(std::span<const std::uint64_t> others) const;
};

/// The hits of brute force, or of the candidate `exact` if rays × discs exceeds `checkable`. Returns nothing if a stop
/// was requested.
[[nodiscard]] std::optional<RightHits> right_hits(const Job& job, const Candidate& exact, double checkable,
                                                  const std::stop_token& stop = {});

}  // namespace detp::validate
