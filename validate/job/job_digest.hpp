#pragma once

#include <span>
#include <string>

#include "detp/validate/base/digest.hpp"
#include "job.hpp"

namespace detp::validate {

void add(std::span<const sim::Disc> discs, Digest& digest);
void add(std::span<const sim::Ray> rays, Digest& digest);

/// Of discs, of the rays in memory with the numbers of their photons, and of the seed: jobs with the same digest find the same.
[[nodiscard]] std::string digest_of(const Job& job);

}  // namespace detp::validate
