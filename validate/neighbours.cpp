#include "neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::validate {
namespace {

Parameters defaults_of(Technique technique) {
  switch (technique) {
    case Technique::brute_force:
      return BruteForceParameters{};
    case Technique::sphere_cache:
    case Technique::sphere_cache_published:
      return SphereCacheParameters{};
    case Technique::cell_spheres:
      return CellSpheresParameters{};
    case Technique::sphere_tree:
      return SphereTreeParameters{4, 16, Bounds::boxes};
    case Technique::octree:
      return OctreeParameters{};
    case Technique::grid:
      return GridParameters{};
    case Technique::bsp:
      return BspParameters{};
    case Technique::bvh:
      return BvhParameters{};
    case Technique::photon_map:
      return PhotonMapParameters{};
  }
  throw std::logic_error("a technique without parameters");
}

std::vector<Parameters> steps_from(const BruteForceParameters&) { return {}; }
std::vector<Parameters> steps_from(const PhotonMapParameters&) { return {}; }

std::vector<Parameters> steps_from(const SphereCacheParameters& p) {
  std::vector<Parameters> steps;
  for (const double ratio : {0.85 * p.ratio, 1.15 * p.ratio})
    if (ratio < 1) steps.emplace_back(SphereCacheParameters{ratio, p.spheres, p.order});
  for (const std::int64_t spheres : {p.spheres - 1, p.spheres + 1})
    if (spheres >= 1) steps.emplace_back(SphereCacheParameters{p.ratio, spheres, p.order});
  return steps;
}

std::vector<Parameters> steps_from(const CellSpheresParameters& p) {
  std::vector<Parameters> steps;
  for (const int depth : {p.depth - 1, p.depth + 1})
    if (depth >= 0 && depth <= 16) steps.emplace_back(CellSpheresParameters{depth});
  return steps;
}

std::vector<Parameters> steps_from(const SphereTreeParameters& p) {
  std::vector<Parameters> steps;
  for (const int fan_out : {4, 8})
    for (const int leaf : {8, 16, 64}) steps.emplace_back(SphereTreeParameters{fan_out, leaf, p.bounds});
  return steps;
}

std::vector<Parameters> steps_from(const OctreeParameters& p) {
  std::vector<Parameters> steps;
  for (const int depth : {p.depth - 1, p.depth + 1})
    if (depth >= 0 && depth <= 20) steps.emplace_back(OctreeParameters{depth, p.traversal});
  return steps;
}

std::vector<Parameters> steps_from(const GridParameters& p) {
  std::vector<Parameters> steps;
  for (const double share : {0.7, 1.4}) {
    const auto cells = static_cast<int>(std::lround(share * p.cells));
    if (cells >= 1 && cells <= 1 << 20) steps.emplace_back(GridParameters{cells});
  }
  return steps;
}

std::vector<Parameters> steps_from(const BspParameters& p) {
  std::vector<Parameters> steps;
  for (const int leaf : {p.leaf / 4, 4 * p.leaf})
    if (leaf >= 1 && leaf <= 1 << 20) steps.emplace_back(BspParameters{p.depth, leaf});
  return steps;
}

std::vector<Parameters> steps_from(const BvhParameters&) {
  return {BvhParameters{BuildQuality::low}, BvhParameters{BuildQuality::medium}};
}

}  // namespace

std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> left_out;
  for (const Technique technique : all_techniques) {
    const bool there = std::any_of(candidates.begin(), candidates.end(),
                                   [&](const Candidate& candidate) { return candidate.technique == technique; });
    if (finds_all_hits(technique) && !there) left_out.push_back({technique, defaults_of(technique)});
  }
  return left_out;
}

std::vector<Candidate> neighbours(const Candidate& candidate) {
  std::vector<Candidate> all;
  std::visit(
      [&](const auto& parameters) {
        for (const Parameters& step : steps_from(parameters))
          if (!(step == candidate.parameters)) all.push_back({candidate.technique, step});
      },
      candidate.parameters);
  return all;
}

}  // namespace detp::validate
