#include "sample_places.hpp"

#include "detp/sim/geometry/lebesgue.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {

std::vector<KeyedIndex> sample_places(std::span<const Disc> discs, std::span<const std::size_t> sample,
                                      const std::stop_token& stop) {
  Box box;
  for (const std::size_t disc : sample) box.include(discs[disc].centre);
  std::vector<KeyedIndex> places;
  places.reserve(sample.size());
  for (const std::size_t disc : sample)
    places.push_back({lebesgue_code(discs[disc].centre, box), static_cast<std::uint32_t>(disc)});
  radix_sort(places, 3 * levels_of_cells, stop);
  return places;
}

std::vector<KeyedIndex> sampled_places(std::span<const Disc> discs, const std::stop_token& stop) {
  constexpr std::size_t most_discs = std::size_t{1} << 13;
  return sample_places(discs, stratified_sample(discs.size(), most_discs, 1, Stream::evidence), stop);
}

}  // namespace detp::sim
