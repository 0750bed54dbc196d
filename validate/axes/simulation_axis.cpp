#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "axes.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/search/problem.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "owen_sobol.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t replicates = 16;
constexpr std::size_t most_discs_of_axis = 16;
constexpr std::array<std::uint32_t, 2> numbers_of_lines{1U << 12, 1U << 15};

using Coordinates = std::array<double, 4>;
/// Coordinates of line `index` of so many.
using Sampler = std::function<Coordinates(std::uint64_t seed, std::uint32_t index, std::uint32_t count)>;

Coordinates random_point(std::uint64_t seed, std::uint32_t index, std::uint32_t) {
  return sim::uniform4(seed, sim::Stream::tests, index);
}

/// In cells of a lattice whose sides are powers of two: the number of lines is 2^k, and the four coordinates share k bits.
Coordinates stratified_point(std::uint64_t seed, std::uint32_t index, std::uint32_t count) {
  Coordinates point = random_point(seed, index, count);
  int bits = 0;
  while (count >> (bits + 1)) ++bits;
  for (int axis = 0; axis < 4; ++axis) {
    const int own = bits / 4 + (axis < bits % 4 ? 1 : 0);
    const std::uint32_t cell = index & ((1U << own) - 1);
    index >>= own;
    point[static_cast<std::size_t>(axis)] =
        (cell + point[static_cast<std::size_t>(axis)]) / static_cast<double>(1U << own);
  }
  return point;
}

struct Way {
  const char* name;
  Sampler sampler;
  bool conditioned = false;  ///< on the direction
};

/// Adds to the estimated number of lines that hit each disc.
void add_line(const Way& way, const Coordinates& point, std::span<const sim::Disc> discs, const sim::Sphere& sphere,
              std::vector<double>& sums) {
  if (way.conditioned) {
    const glm::dvec3 direction = sim::uniform_direction(point[0], point[1]);
    for (std::size_t i = 0; i < discs.size(); ++i)
      sums[i] += std::pow(discs[i].radius / sphere.radius, 2) * std::abs(glm::dot(discs[i].normal, direction));
  } else {
    const sim::Ray line = sim::line_at(sphere, point);
    for (std::size_t i = 0; i < discs.size(); ++i) sums[i] += sim::hits(line, discs[i]) ? 1 : 0;
  }
}

AxisPoint measured(const Way& way, std::uint32_t count, std::span<const sim::Disc> discs, const sim::Sphere& sphere,
                   const AxisOptions& options) {
  std::vector<double> squares;
  const sim::Stopwatch watch;
  for (std::uint64_t replicate = 0; replicate < replicates; ++replicate) {
    sim::StopCheck(options.stop, "sampling lines").now();
    std::vector<double> sums(discs.size());
    const std::uint64_t seed = options.seed * 1000 + replicate;
    for (std::uint32_t i = 0; i < count; ++i) add_line(way, way.sampler(seed, i, count), discs, sphere, sums);
    double square = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const double known = 0.5 * std::pow(discs[i].radius / sphere.radius, 2);
      square += std::pow(sums[i] / count / known - 1, 2) / static_cast<double>(discs.size());
    }
    squares.push_back(square);
  }
  const Estimate mean = batch_means(squares);
  const double half = interval_width(0.05, 1, replicates) * mean.standard_error;
  return {.axis = "simulation",
          .setting = fmt::format("{}, {} lines", way.name, count),
          .quantity = "probability that a line hits a disc",
          .error = std::sqrt(mean.mean),
          .interval = AxisInterval{std::sqrt(std::max(0.0, mean.mean - half)), std::sqrt(mean.mean + half)},
          .seconds = watch.seconds() / replicates,
          .work = static_cast<double>(count)};
}

}  // namespace

std::vector<AxisPoint> simulation_axis(std::span<const sim::Disc> discs, const AxisOptions& options) {
  const sim::Sphere sphere = sim::enclosing_sphere(discs, options.stop);
  std::vector<sim::Disc> some;
  const std::size_t step = (discs.size() - 1) / most_discs_of_axis + 1;
  for (std::size_t i = step / 2; i < discs.size(); i += step) some.push_back(discs[i]);
  const Sampler owen = [](std::uint64_t seed, std::uint32_t index, std::uint32_t) {
    return OwenSobol(seed).point(index);
  };
  const std::vector<Way> ways{{"plain", random_point},
                              {"stratified", stratified_point},
                              {"Owen-scrambled Sobol", owen},
                              {"conditioned on direction", random_point, true},
                              {"conditioned, Owen-scrambled Sobol", owen, true}};
  std::vector<AxisPoint> points;
  for (const Way& way : ways)
    for (const std::uint32_t count : numbers_of_lines) points.push_back(measured(way, count, some, sphere, options));
  return points;
}

}  // namespace detp::validate
