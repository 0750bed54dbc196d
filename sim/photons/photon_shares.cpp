#include "photon_shares.hpp"

#include <algorithm>
#include <numeric>

namespace detp::sim {

std::vector<double> photon_shares(std::span<const std::uint64_t> pieces, std::uint64_t wanted) {
  const std::size_t n = pieces.size();
  if (n < 2 || n >= many_photons) return {};
  const std::uint64_t excess = std::accumulate(pieces.begin(), pieces.end(), std::uint64_t{0}) - wanted;
  const auto may_be_last = [&](std::uint64_t own) { return own > excess; };
  const auto m = static_cast<double>(std::ranges::count_if(pieces, may_be_last));
  if (m == static_cast<double>(n)) return {};
  const double other = 1 / static_cast<double>(n - 1);
  std::vector<double> shares;
  for (const std::uint64_t own : pieces) shares.push_back(may_be_last(own) ? (1 - 1 / m) * other : other);
  return shares;
}

}  // namespace detp::sim
