#include "bytes_touched.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "ray_blocks.hpp"

namespace detp {
namespace {

constexpr double float_disc = 32;
constexpr double order = 4;
constexpr double results = 16;  // hits and irradiance
constexpr double sums = 32;
constexpr double listed_ray = 72;  // in double

/// Lists of rays in floats, block after block. (Several threads load the next block meanwhile, in other memory.)
double bytes_of_floats(const Counts<double>& counts, double discs, Technique technique) {
  constexpr double hits = 12;
  constexpr double sorting = 48;     // by whole codes
  constexpr double curve_place = 8;  // by coarse ones
  constexpr double made_node = 72;   // in the binary tree, and in the tree made of it
  const double block = ray_blocks(counts.loaded, discs, Engine::simd).size;
  const double loaded_ray = counts.segments > 0 ? 28 : 20;
  const double in_list = technique == Technique::brute_force ? 0 : loaded_ray;
  const double in_order = counts.sorted > 0 ? technique == Technique::box_tree ? curve_place : sorting : 0;
  return discs * (float_disc + order + hits + results + in_order) + made_node * counts.made +
         (loaded_ray + in_list) * std::min(block, counts.loaded);
}

double bytes_of_plain_lists(const Counts<double>& counts, double discs, Technique technique) {
  if (technique == Technique::brute_force) return discs * (sums + results);
  const bool spheres = technique == Technique::sphere_tree;
  const double lists = spheres ? 6 : 1;  // inside the outermost, in its rays
  return discs * (order + sums + results + (spheres ? 2 * listed_ray : 0)) + listed_ray * (1 + lists) * counts.loaded;
}

double bytes_of_cells(const Counts<double>& counts, const Candidate& candidate, Engine engine) {
  constexpr double reference = 4;
  constexpr double placing = 6;
  constexpr double bvh_disc = 200;
  const double mapped_ray = engine == Engine::simd ? 260 : 80;
  constexpr double mapped_disc = 60;
  constexpr double grid_cell = 16;
  if (candidate.technique == Technique::bvh) return bvh_disc * counts.references;
  if (candidate.technique == Technique::ray_map || candidate.technique == Technique::photon_map)
    return mapped_ray * counts.loaded + mapped_disc * counts.visits;
  const auto* const grid = std::get_if<GridParameters>(&candidate.parameters);
  return counts.references * (reference + results + (engine == Engine::simd ? float_disc : 0)) +
         placing * counts.placements + (grid != nullptr ? grid_cell * std::pow(grid->cells, 3) : 0);
}

}  // namespace

double bytes_touched(const Counts<double>& counts, const Candidate& candidate, Engine engine) {
  const TechniqueRecord& record = record_of(candidate.technique);
  if (record.ray_by_ray) return bytes_of_cells(counts, candidate, engine);
  const bool all = candidate.technique == Technique::brute_force;
  const double discs = !all                ? std::max(counts.placements, counts.sorted)
                       : counts.loaded > 0 ? counts.disc_tests / counts.loaded
                                           : 0;
  return engine == Engine::simd && record.simd ? bytes_of_floats(counts, discs, candidate.technique)
                                               : bytes_of_plain_lists(counts, discs, candidate.technique);
}

}  // namespace detp
