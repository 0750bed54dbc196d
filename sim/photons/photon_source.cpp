#include "photon_source.hpp"

#include <algorithm>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "photon_rounds.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t group_size = 1024;  // photons in a group

}  // namespace

PhotonSource::PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed,
                           std::shared_ptr<const RayCaster> caster, const std::stop_token& stop)
    : tracer_(scene, seed, std::move(caster)), count_(count), limit_(0), starts_{0} {
  const DefaultFloatingPoint mode;
  PhotonRounds rounds(scene.name, count);
  limit_ = rounds.limit();
  try {
    for (std::uint64_t photons = 0; starts_.back() < count;) {
      photons += rounds.next(starts_.back());
      count_rays((photons + group_size - 1) / group_size, stop);
    }
    emitted_ = static_cast<double>(emitted(stop));
  } catch (const Stopped&) {
    stopped_tracing(std::min(starts_.back(), count), count);
  }
}

PhotonPieces PhotonSource::trace_group(std::uint64_t group, const std::stop_token& stop) const {
  const std::uint64_t first = group * group_size;
  return tracer_.trace(first, std::min(first + group_size, limit_), stop);
}

/// Traces further groups to count their rays, until `groups` groups are counted.
void PhotonSource::count_rays(std::uint64_t groups, const std::stop_token& stop) {
  const std::uint64_t known = starts_.size() - 1;
  if (groups <= known) return;
  std::vector<std::uint64_t> rays(groups - known);
  std::vector<Box> boxes(groups - known);
  sim::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
    const PhotonPieces pieces = trace_group(known + i, stop);
    rays[i] = pieces.rays.size();
    for (const Ray& ray : pieces.rays) boxes[i].include(ray.origin);
  });
  for (std::size_t i = 0; i < rays.size(); ++i) {
    starts_.push_back(starts_.back() + rays[i]);
    if (rays[i] == 0) continue;
    origins_.include(boxes[i].low);
    origins_.include(boxes[i].high);
  }
}

std::uint64_t PhotonSource::emitted(const std::stop_token& stop) const {
  if (count_ == 0) return 1;
  const auto group = static_cast<std::uint64_t>(std::ranges::lower_bound(starts_, count_) - starts_.begin()) - 1;
  return trace_group(group, stop).photons[count_ - 1 - starts_[group]] + 1;
}

void PhotonSource::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  const std::uint64_t last = first + block.size();
  const auto begin = static_cast<std::uint64_t>(std::ranges::upper_bound(starts_, first) - starts_.begin()) - 1;
  const auto end = static_cast<std::uint64_t>(std::ranges::lower_bound(starts_, last) - starts_.begin());
  sim::parallel_for(begin, end, [&](std::uint64_t group) {
    const std::vector<Ray> rays = trace_group(group, stop).rays;
    const std::uint64_t from = std::max(first, starts_[group]);
    const std::uint64_t to = std::min(last, starts_[group] + rays.size());
    for (std::uint64_t number = from; number < to; ++number) {
      Ray& ray = block[number - first] = rays[number - starts_[group]];
      ray.power /= emitted_;
    }
  });
}

double PhotonSource::farthest_from(const glm::dvec3& point) const {
  constexpr double rounding = 1 + 1e-12;
  const glm::dvec3 farthest = glm::max(glm::abs(origins_.low - point), glm::abs(origins_.high - point));
  return rounding * glm::length(farthest);
}

}  // namespace detp::sim
