#include "disc_index_published.hpp"

#include <algorithm>
#include <cmath>

namespace detp::model::published {
namespace {

void check_depth(int depth) { require_count("depth", depth, 0, 500); }

}  // namespace

int octree_depth(DiscRadius disc, double side) {
  require_positive("disc radius", disc.value);
  require_positive("scene side", side);
  int depth = std::ilogb(side) - std::ilogb(disc.value) - 1;  // right, or one too many
  if (std::ldexp(disc.value, depth + 1) > side) --depth;
  return std::max(depth, 0);
}

double cells_per_line(int depth) {
  check_depth(depth);
  return std::ldexp(1.0, depth);
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

double octree_time(const Workload& workload, int depth, double disc_test) {
  return depth * balanced_octree_time(workload, depth, disc_test);
}

double balanced_octree_time(const Workload& workload, int depth, double disc_test) {
  require_non_negative("time of a ray-disc test", disc_test);
  check(workload);
  return disc_test * workload.rays * tests_per_line(workload.samples, depth);
}

}  // namespace detp::model::published
