#include "concave_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "all_effects.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t most_centres = 256;
constexpr std::size_t in_array = 16;  // neighbours on each side
constexpr std::size_t on_curve = 8;
constexpr double tolerated = 0.02;  // height over the plane, in disc radii
constexpr double farthest = 4;      // in disc radii

bool is_in_front(const Disc& disc, const glm::dvec3& neighbour, bool front_facing) {
  const glm::dvec3 to = (neighbour - disc.centre) / disc.radius;
  const double signed_height = glm::dot(to, disc.normal);
  const double height = front_facing ? signed_height : std::abs(signed_height);
  const double squared = glm::dot(to, to);
  if (!(height > tolerated) || squared > farthest * farthest) return false;
  return squared <= 1 || (height > tolerated * squared && 2 * height * height < squared);
}

class Neighbours {
 public:
  Neighbours(std::span<const Disc> discs, std::span<const SampledDisc> sampled, bool front_facing)
      : discs_(discs), sampled_(sampled), front_facing_(front_facing) {}

  /// Whether a neighbour of the disc with this place is in front of it.
  [[nodiscard]] bool any_in_front(std::size_t place) const {
    const std::size_t number = sampled_[place].number;
    const Disc& disc = discs_[number];
    for (std::size_t i = from(number, in_array); i < end(number, in_array, discs_.size()); ++i)
      if (is_in_front(disc, discs_[i].centre, front_facing_)) return true;
    for (std::size_t i = from(place, on_curve); i < end(place, on_curve, sampled_.size()); ++i)
      if (is_in_front(disc, discs_[sampled_[i].number].centre, front_facing_)) return true;
    return false;
  }

 private:
  static std::size_t from(std::size_t middle, std::size_t reach) { return middle - std::min(middle, reach); }
  static std::size_t end(std::size_t middle, std::size_t reach, std::size_t size) {
    return std::min(size, middle + reach + 1);
  }

  std::span<const Disc> discs_;
  std::span<const SampledDisc> sampled_;
  bool front_facing_;
};

/// The share, with the standard error of a binomial share of (found + ½)/(tried + 1): never 0.
Finding share_of(double found, double tried) {
  const double likely = (found + 0.5) / (tried + 1);
  return {.value = found / tried, .standard_error = std::sqrt(likely * (1 - likely) / tried)};
}

bool is_decided(const Finding& finding) {
  return concave_surfaces.threshold.distance(finding.value) > 3 * finding.standard_error;
}

Finding find_concave_surfaces(const EffectSample& sample) {
  return sample.surface.self_shadow.value_or(Finding{});  // rays that are given are taken as they are
}

double concavity_of_numbers(const Workload&) { return 0; }

}  // namespace

Finding concavity(std::span<const Disc> discs, const CurveSample& sample, bool front_facing,
                  const std::stop_token& stop) {
  StopCheck check(stop, "looking for concave surfaces");
  check.now();
  const Neighbours neighbours(discs, sample.discs, front_facing);
  const std::size_t centres = std::min(most_centres, sample.discs.size());
  double found = 0;
  double tried = 0;
  // four passes along the curve, each between the places of those before
  for (const std::size_t first : {0, 2, 1, 3}) {
    for (std::size_t i = first; i < centres; i += 4) {
      check.after(2 * (in_array + on_curve));
      found += neighbours.any_in_front(i * sample.discs.size() / centres) ? 1 : 0;
      tried += 1;
    }
    if (tried > 0 && is_decided(share_of(found, tried))) break;
  }
  return share_of(found, tried);
}

Finding concavity(std::span<const Disc> discs, bool front_facing, const std::stop_token& stop) {
  return concavity(discs, curve_sample(discs, enclosing_sphere(discs, stop), EvidenceEffort{}.discs, stop),
                   front_facing, stop);
}

constinit const Effect concave_surfaces{
    .name = "concave surfaces",
    .evidence = "hits gained if paths go on by 2d, less light through sheets, over hits",
    .threshold = {Threshold::Side::above, 0.01, 0},
    .find = find_concave_surfaces,
    .of_numbers = concavity_of_numbers};

}  // namespace detp::sim
