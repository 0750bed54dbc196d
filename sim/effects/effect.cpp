#include "effect.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t most_rays = 1U << 11;
constexpr std::size_t most_discs = 1U << 13;

std::vector<std::size_t> sample_of(std::size_t size, std::size_t most) {
  return stratified_sample(size, most, 1, Stream::evidence);
}

}  // namespace

EffectSample::EffectSample(const Problem& of, const SurfaceFacts& mesh, std::stop_token stop_token)
    : problem(of),
      surface(mesh),
      stop(std::move(stop_token)),
      rays(sample_of(of.rays().size(), most_rays)),
      discs(sample_of(of.discs().size(), most_discs)) {}

bool Threshold::passed(double value) const {
  switch (side) {
    case Side::above:
      return value > at;
    case Side::below:
      return value < at;
    case Side::apart:
      break;
  }
  return std::abs(value - at) > tolerance;
}

double Threshold::distance(double value) const { return std::abs(std::abs(value - at) - tolerance); }

}  // namespace detp::sim
