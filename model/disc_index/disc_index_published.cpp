#include "disc_index_published.hpp"

#include <algorithm>
#include <cmath>

namespace detp::model::published {
namespace {

/// The result of octree_depth for the largest double as side and the smallest as d.
constexpr int deepest = 2096;

void check_depth(int depth) { require_count("depth", depth, 0, deepest); }

/// u n_R n_P/4^k in long double: u may be large and 4^{-k} small.
long double time(const Valid<Workload>& workload, int depth, double disc_test) {
  require_non_negative("time of a ray-disc test", disc_test);
  check_depth(depth);
  return disc_test * std::ldexp(static_cast<long double>(workload.rays) * workload.samples, -2 * depth);
}

}  // namespace

int octree_depth(DiscRadius disc, double side) {
  require_positive("disc radius", disc.value);
  require_positive("scene side", side);
  int depth = std::ilogb(side) - std::ilogb(disc.value) - 1;  // right, or one too large
  if (std::ldexp(disc.value, depth + 1) > side) --depth;
  return std::max(depth, 0);
}

double cells_per_line(int depth) {
  check_depth(depth);
  return saturated(std::ldexp(1.0L, depth));
}

double discs_per_cell(double samples, int depth) {
  require_count("number of samples", samples, 1, 1e18);
  check_depth(depth);
  return std::ldexp(samples, -3 * depth);
}

double tests_per_line(double samples, int depth) {
  require_count("number of samples", samples, 1, 1e18);
  check_depth(depth);
  return std::ldexp(samples, -2 * depth);
}

double octree_time(const Valid<Workload>& workload, int depth, double disc_test) {
  return saturated(depth * time(workload, depth, disc_test));
}

double balanced_octree_time(const Valid<Workload>& workload, int depth, double disc_test) {
  return saturated(time(workload, depth, disc_test));
}

}  // namespace detp::model::published
