#include "resample.hpp"

#include <algorithm>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

/// Running sum of the triangles' doubled areas, in units of scale², so that the areas neither vanish nor overflow.
std::vector<double> running_areas(const Mesh& mesh, double scale) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3& corner = mesh.positions[a];
    sum += glm::length(glm::cross((mesh.positions[b] - corner) / scale, (mesh.positions[c] - corner) / scale));
    sums.push_back(sum);
  }
  return sums;
}

/// A uniform point in the triangle: a uniform point of the unit square, folded along its diagonal.
Sample sample_in(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle, double u, double v, double scale) {
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const glm::dvec3& corner = mesh.positions[triangle[0]];
  const glm::dvec3 first = mesh.positions[triangle[1]] - corner;
  const glm::dvec3 second = mesh.positions[triangle[2]] - corner;
  return {.position = corner + u * first + v * second,
          .normal = unit_or_zero(glm::cross(first / scale, second / scale))};
}

}  // namespace

std::vector<Sample> random_subset(const std::vector<Sample>& samples, std::size_t count, std::uint64_t seed,
                                  const std::stop_token& stop) {
  StopCheck check(stop, "thinning samples");
  // Selection sampling: Knuth, The Art of Computer Programming 2, 3.4.2, algorithm S.
  std::vector<Sample> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < samples.size() && kept.size() < count; ++i) {
    const double left = static_cast<double>(samples.size() - i);
    const double wanted = static_cast<double>(count - kept.size());
    if (left * uniform4(seed, Stream::thinning, i)[0] < wanted) kept.push_back(samples[i]);
    check.after(1);
  }
  return kept;
}

void add_by_area(std::vector<Sample>& samples, const Mesh& mesh, std::size_t count, std::uint64_t seed,
                 const std::stop_token& stop) {
  StopCheck check(stop, "spreading samples over the triangles");
  const double scale = used_box(mesh).longest_side();
  if (!(scale > 0)) return;
  const std::vector<double> sums = running_areas(mesh, scale);
  if (!(sums.back() > 0)) return;
  samples.reserve(samples.size() + count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = uniform4(seed, Stream::samples, i);
    const auto chosen = std::upper_bound(sums.begin(), sums.end(), random[0] * sums.back());
    const std::size_t index = std::min<std::size_t>(chosen - sums.begin(), sums.size() - 1);
    samples.push_back(sample_in(mesh, mesh.triangles[index], random[1], random[2], scale));
    check.after(1);
  }
}

}  // namespace detp::sim
