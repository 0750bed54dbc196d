#include "facet.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

// numbers that define a facet, at the front of its record; the normal follows from them
constexpr std::size_t numbers = 9;

bool same_bits(const Facet& a, const Facet& b) { return std::memcmp(&a, &b, numbers * sizeof(double)) == 0; }

std::uint64_t hash_of(const Facet& facet) {
  std::uint64_t words[numbers];
  std::memcpy(words, &facet, sizeof words);
  std::uint64_t hash = 0;
  for (const std::uint64_t word : words) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
  return hash;
}

}  // namespace

DistinctFacets distinct_facets(std::vector<Facet> all, const std::stop_token& stop) {
  StopCheck check(stop, "looking for identical triangles");
  DistinctFacets distinct;
  distinct.places.reserve(all.size());
  distinct.triangles.reserve(all.size());
  std::vector<std::uint32_t> table(std::bit_ceil(2 * all.size() + 1), no_facet);  // hash table of places
  std::uint32_t count = 0;  // facets kept so far, at the front of `all`
  for (std::uint32_t triangle = 0; triangle < all.size(); ++triangle) {
    const Facet facet = all[triangle];
    check.after(1);
    if (facet.normal == glm::dvec3{0.0}) {
      distinct.places.push_back(no_facet);
      continue;
    }
    std::size_t slot = hash_of(facet) & (table.size() - 1);
    while (table[slot] != no_facet && !same_bits(all[table[slot]], facet)) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == no_facet) {
      table[slot] = count;
      all[count++] = facet;
      distinct.triangles.push_back(triangle);
    }
    distinct.places.push_back(table[slot]);
  }
  all.resize(count);
  distinct.facets = std::move(all);
  return distinct;
}

}  // namespace detp::sim
