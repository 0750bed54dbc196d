#pragma once

#include <string>

#include "job.hpp"

namespace detp::validate {

/// Of discs, of the rays in memory with the numbers of their photons, and of the seed: jobs with the same digest find the same.
[[nodiscard]] std::string digest_of(const Job& job);

}  // namespace detp::validate
