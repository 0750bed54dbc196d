#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "choice.hpp"

/// Chooses by a sample of rays, through parts of the index.
namespace detp::validate {

/// The number of rays that a pilot samples: 64 to 2048, the more the longer the search will take.
[[nodiscard]] std::size_t pilot_size(double rays, double discs);

/// A stratified sample of the rays, of pilot_size.
[[nodiscard]] std::vector<sim::Ray> pilot_sample(std::span<const sim::Ray> rays, std::size_t discs);

/// `choose` with rigor pilot or structural; `question` has its rays and their number. `costs` as for `choose`.
///
/// The shapes of box trees are compared by sim::PilotedDiscs, brute force by its exact counts, other techniques by
/// compare_others. Brute force is chosen if it takes less time than sorting and placing the discs and the least search that
/// any box tree needs; then there is no pilot. After the pilot, the discs are sorted, and it is chosen only if it is faster
/// than the rest of the run.
[[nodiscard]] Choice choose_by_sample(const Question& question, Rigor rigor, const Valid<CostTable>& costs);

/// choose_again after choose_by_sample; `question` has the other radius and number of rays.
[[nodiscard]] Choice sample_again(const Choice& choice, const Question& question, double radius_ratio,
                                  const Valid<CostTable>& costs);

}  // namespace detp::validate
