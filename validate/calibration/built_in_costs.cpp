#include "built_in_costs.hpp"

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>

namespace detp::validate {
namespace {

struct BuiltIn {
  Technique technique;
  std::string_view nanoseconds;  ///< by symbol, as `detp calibrate` prints them; costs that are not named are 0
  ThreadCosts threads = {};
};

// The mean of three runs of detp calibrate --seconds 40, by the shortest times, on a quiet machine: two virtual cores of an Intel Xeon at 2.8 GHz (Ice Lake,
// AVX-512, 1.25 MiB of second-level cache a core). Costs of threads are those of two threads; those of more are extrapolated. z: in
// large pages.
constexpr double touch_nanoseconds = 0.054;
constexpr BuiltIn of_simd[] = {
    {Technique::brute_force,
     "u 0.395, l 16.9, h 5.45, i 4.34, e 0.188, m 0.925, y 0.0493, a 7.52e+03",
     {.serial_preparing = 1, .serial_search = 0.0404, .start = 1.12e-05}},
    {Technique::sphere_cache,
     "t 0.495, u 0.525, c 0.704, s 60.1, r 101, l 110, h 0.0366, i 6.3, e 0.168, m 45.5, y 0.0447, a 1.05e+04",
     {.serial_preparing = 1, .serial_search = 0.215, .start = 3.83e-06}},
    {Technique::cell_spheres,
     "t 0.671, u 0.581, c 0.301, s 57.7, r 149, l 200, h 0.899, i 5.22, e 0.163, m 4.57, y 0.0434, a 5.9e+03",
     {.serial_preparing = 1, .serial_search = 0.255, .start = 3.73e-06}},
    {Technique::box_tree,
     "t 0.536, u 0.389, c 1.39, b 25.1, g 65.5, r 15.4, l 11.7, h 0.166, i 7.85, e 0.271, m 1.06, y 0.0533, a 1.21e+04",
     {.serial_preparing = 0.197, .serial_search = 0.18, .start = 5.4e-05}},
    {Technique::octree,
     "w 0.888, n 68.8, b 129, h 18.2, i 14.3, e 0.303, m 21.9, a 3.78e+03",
     {.serial_preparing = 1, .serial_search = 0.345, .start = 1.14e-05}},
    {Technique::grid,
     "w 0.986, v 31.2, b 124, h 35.9, i 36.3, e 0.258, m 51.9, a 339",
     {.serial_preparing = 1, .serial_search = 0.235, .start = 2.4e-05}},
    {Technique::bsp,
     "w 1.21, n 15.5, b 44.4, h 17.8, i 15.4, e 0.351, m 1.39, a 5.52e+03",
     {.serial_preparing = 1, .serial_search = 0.306, .start = 2.76e-05}},
    {Technique::bvh,
     "w 1.96, b 234, h 75.8, i 78.5, e 12.4, a 7.29e+04",
     {.serial_preparing = 1, .serial_search = 0.326, .start = 2.19e-05}},
    {Technique::ray_map, "w 0.961, n 10.9, c 3.87, r 55.2, l 1.09, h 67.1, i 13.8, e 0.0611, m 0.117, a 1.87e+03"},
};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     "u 3.21, l 1.65, h 115, i 5.96, e 0.346, a 3.18e+03",
     {.serial_preparing = 1, .serial_search = 0, .start = 1.94e-05}},
    {Technique::sphere_cache, "t 5.44, u 2.52, c 15.8, s 48.6, r 18.1, h 81, i 48.3, e 3.9, m 1.55"},
    {Technique::cell_spheres, "t 10.2, u 4.02, c 6.65, s 48.9, r 108, h 92.9, e 2.07, m 3.05, a 316"},
    {Technique::box_tree,
     "t 5.34, u 3.33, c 13.9, b 24.2, g 59.1, r 30.2, l 15.4, h 95.3, i 22.8, e 0.407, m 0.904, a 210",
     {.serial_preparing = 0.236, .serial_search = 1, .start = 5.31e-05}},
    {Technique::octree,
     "w 3.45, n 65.2, b 104, h 116, e 0.479, m 21.3",
     {.serial_preparing = 1, .serial_search = 0.0965, .start = 1.1e-05}},
    {Technique::grid,
     "w 3.34, v 26.7, b 98.4, h 152, i 21.2, e 0.714, m 39.7, a 872",
     {.serial_preparing = 1, .serial_search = 0.0869, .start = 2.18e-05}},
    {Technique::bsp,
     "w 3.59, n 20.4, b 38.1, h 106, i 0.307, e 0.621, m 1.72, a 859",
     {.serial_preparing = 1, .serial_search = 0.198, .start = 0}},
    {Technique::sphere_tree, "t 6.54, u 3.04, c 9.36, g 161, s 94, l 15.3, h 107, i 5.76, e 1.31, m 4.55"},
    {Technique::bvh,
     "w 1.75, b 211, h 125, i 58.4, e 17.3, a 5.96e+04",
     {.serial_preparing = 0.00424, .serial_search = 0.177, .start = 2.14e-05}},
    {Technique::ray_map, "w 4.7, n 20.2, c 34.4, l 52.5, h 120, i 10.3, e 0.24, m 0.492, a 2.67e+03"},
};

/// "t 0.495, u 0.525": nanoseconds of the terms with these symbols.
UnitCosts parsed_costs(std::string_view text) {
  constexpr double nano = 1e-9;
  UnitCosts costs;
  for (const UnitCostTerm& term : unit_cost_terms) costs.*term.cost = 0;
  costs.touch = nano * touch_nanoseconds;
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find(','));
    double value = 0;
    std::from_chars(one.data() + 2, one.data() + one.size(), value);
    for (const UnitCostTerm& term : unit_cost_terms)
      if (term.symbol == one.substr(0, 1)) costs.*term.cost = nano * value;
    text.remove_prefix(std::min(text.size(), one.size() + 2));
  }
  return costs;
}

/// Time of a test of a ray against a disc over that of the machine of the built-in costs.
double over_usual(const CostTable& costs) {
  return costs[Technique::box_tree].disc_test / built_in_unit_costs(costs.engine)[Technique::box_tree].disc_test;
}

}  // namespace

CostTable built_in_unit_costs(Engine engine) {
  CostTable costs;
  costs.engine = engine;
  costs.relative_errors.fill(0.5);  // two standard errors are a factor of two
  const auto set = [&](std::span<const BuiltIn> built_in) {
    for (const BuiltIn& one : built_in) {
      costs[one.technique] = parsed_costs(one.nanoseconds);
      costs.threads_of(one.technique) = one.threads;
    }
  };
  set(of_plain);
  costs[Technique::sphere_cache_published] = costs[Technique::sphere_cache];  // always plain
  if (engine == Engine::simd) set(of_simd);
  return costs;
}

CostTable costs_of_sums(CostTable costs) {
  if (costs.engine != Engine::simd) return costs;
  const double placing = costs[Technique::box_tree].placement;
  for (const TechniqueRecord& record : technique_records)
    if (record.simd && !record.ray_by_ray) {
      costs[record.technique].visit += placing;
      costs[record.technique].hit += 0.1 * placing;
    }
  costs[Technique::box_tree].placement += 0.8 * placing;
  return costs;
}

double sums_seconds(const SumsOfSearch& sums, const CostTable& costs) {
  const double errors = sums.errors ? (sums.numbered ? 9e-9 : 0.9e-9) * sums.hits : 0;
  const double of_band = 1.5e-9 * sums.rays + (sums.errors ? 1.87e-9 : 1.01e-9) * sums.hits +
                         (sums.errors ? 66.7e-9 : 6.05e-9) * sums.discs * sums.blocks;
  return (errors + (sums.bands - 1) * of_band) * over_usual(costs);
}

}  // namespace detp::validate
