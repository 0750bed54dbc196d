#include "sparse_search.hpp"

#include <cmath>

#include "detp/sim/geometry/random.hpp"
#include "sparse_scenes.hpp"

namespace detp::study {
namespace {

/// With a uniform logarithm.
double between(double least, double most, double uniform) { return least * std::pow(most / least, uniform); }

}  // namespace

SparseSearch sparse_search(std::uint64_t seed) {
  constexpr double lines = 0.3;  // share of the searches
  const auto uniform = sim::uniform4(seed, sim::Stream::tests, 0, 1);
  SparseSearch search{.seed = seed,
                      .kind = {},
                      .mesh = {},
                      .field = uniform[0] < lines ? sim::Field::isotropic : sim::Field::photons,
                      .rays = std::round(between(20'000, 200'000, uniform[1])),
                      .radius = between(0.002, 0.035, uniform[2])};
  switch (seed % 3) {
    case 0:
      search.kind = "tiny object";
      search.mesh = tiny_object(seed);
      break;
    case 1:
      search.kind = "furnished room";
      search.mesh = furnished_room(seed);
      break;
    default:
      search.kind = "clusters";
      search.mesh = clusters(seed);
  }
  return search;
}

}  // namespace detp::study
