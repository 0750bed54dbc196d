#include "distinct_facets.hpp"

#include <array>
#include <bit>
#include <unordered_map>

namespace detp::sim {
namespace {

/// The numbers that make a facet; its normal follows from them.
using Bits = std::array<std::uint64_t, 9>;

Bits bits_of(const Facet& facet) {
  Bits bits{};
  for (int axis = 0; axis < 3; ++axis) {
    bits[static_cast<std::size_t>(axis)] = std::bit_cast<std::uint64_t>(facet.corner[axis]);
    bits[static_cast<std::size_t>(axis) + 3] = std::bit_cast<std::uint64_t>(facet.first[axis]);
    bits[static_cast<std::size_t>(axis) + 6] = std::bit_cast<std::uint64_t>(facet.second[axis]);
  }
  return bits;
}

struct Hash {
  std::size_t operator()(const Bits& bits) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : bits) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

}  // namespace

DistinctFacets distinct_facets(const std::vector<Facet>& all) {
  DistinctFacets distinct;
  distinct.places.reserve(all.size());
  std::unordered_map<Bits, std::uint32_t, Hash> known;
  known.reserve(all.size());
  for (std::uint32_t triangle = 0; triangle < all.size(); ++triangle) {
    const Facet& facet = all[triangle];
    if (facet.normal == glm::dvec3{0.0}) {
      distinct.places.push_back(no_facet);
      continue;
    }
    const auto [place, added] = known.try_emplace(bits_of(facet), static_cast<std::uint32_t>(distinct.facets.size()));
    distinct.places.push_back(place->second);
    if (!added) continue;
    distinct.facets.push_back(facet);
    distinct.triangles.push_back(triangle);
  }
  return distinct;
}

}  // namespace detp::sim
