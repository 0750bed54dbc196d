#pragma once

#include "choice.hpp"
#include "tips.hpp"

/// The tips of a choice.
namespace detp::validate {

/// choose_again for other radii, numbers of rays and threads: after a pilot, for radii and rays up to four times larger or
/// smaller (the range for which extrapolated counts were compared with new pilots), by closed forms up to 16 times.
/// `question` must be that of the choice, and have a workload; the choice's index must not be built yet.
///
/// Cost       after a pilot 1.3 to 13 million instructions for 2000 to 86 000 discs and 300 to 3 000 000 rays, 3.0 in @tree
///            with 100 000 photon paths, a tenth to a half of those of the pilot; by closed forms 55 to 236 million in
///            four examples (valgrind --tool=callgrind)
[[nodiscard]] Tips tips_of(const Choice& choice, const Question& question, const Valid<CostTable>& costs);

}  // namespace detp::validate
