#include "photon_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "photon_rounds.hpp"
#include "photon_shares.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t group_size = 1024;  // photons in a group
constexpr std::uint64_t most_in_a_round = 1ULL << 26;

/// Of the first photons of some that begin with number `first`.
LightLedger ledger_of(const PhotonTracer& tracer, std::uint64_t first, const PhotonPieces& pieces,
                      std::uint64_t photons) {
  LightLedger light;
  for (std::uint64_t i = 0; i < photons; ++i) light.add(pieces.ends[i], tracer.power(first + i));
  for (std::size_t i = 0; i < pieces.rays.size() && pieces.photons[i] < first + photons; ++i)
    light.landings += pieces.landings[i] < unbounded ? 1 : 0;
  return light;
}

}  // namespace

PhotonSource::PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed,
                           std::shared_ptr<const RayCaster> caster, const std::stop_token& stop, Ranks* ranks)
    : tracer_(scene, seed, std::move(caster)),
      wanted_(count),
      count_(count),
      limit_(0),
      starts_{0},
      most_kept_(most_kept_bytes()) {
  const DefaultFloatingPoint mode;
  require_memory(fmt::format("numbers of {} rays", count), 16.0 * static_cast<double>(count) / group_size);
  OneRank one;
  PhotonRounds rounds(scene.name, count, most_in_a_round);
  limit_ = rounds.limit();
  try {
    for (std::uint64_t photons = 0; starts_.back() < count;) {
      photons += rounds.next(starts_.back());
      count_rays((photons + group_size - 1) / group_size, ranks != nullptr ? *ranks : one, stop);
    }
    if (count > 0) end_with_last_photon(stop);
    if (count > 0) add_up_light(stop);
  } catch (const Stopped&) {
    stopped_tracing(std::min(starts_.back(), count), count);
  }
}

PhotonPieces PhotonSource::trace_group(std::uint64_t group, const std::stop_token& stop) const {
  const std::uint64_t first = group * group_size;
  return tracer_.trace(first, std::min(first + group_size, limit_), stop, wanted_);
}

const PhotonPieces& PhotonSource::pieces_of(std::uint64_t group, PhotonPieces& traced,
                                            const std::stop_token& stop) const {
  StopCheck(stop, "making rays").now();
  if (group < kept_.size() && kept_[group]) return *kept_[group];
  return traced = trace_group(group, stop);
}

std::unique_ptr<const PhotonPieces> PhotonSource::keep(const PhotonPieces& pieces) {
  const std::size_t bytes = pieces.rays.size() * (sizeof(Ray) + sizeof(std::uint64_t));
  if (static_cast<double>(traced_bytes_.fetch_add(bytes) + bytes) > most_kept_) return nullptr;
  auto kept = std::make_unique<PhotonPieces>();
  kept->rays.assign(pieces.rays.begin(), pieces.rays.end());
  kept->photons.assign(pieces.photons.begin(), pieces.photons.end());
  return kept;
}

/// Traces further groups to count their rays, until `groups` groups are counted.
void PhotonSource::count_rays(std::uint64_t groups, Ranks& ranks, const std::stop_token& stop) {
  struct Group {
    std::uint64_t rays = 0;
    Box origins;
    LightLedger light;
  };
  const std::uint64_t known = starts_.size() - 1;
  if (groups <= known) return;
  // If few are known, each rank traces, and keeps, the groups that it is likely to search: its part of all.
  constexpr std::uint64_t few = 16;
  const std::uint64_t skipped = few * known * static_cast<std::uint64_t>(ranks.count()) <= groups ? known : 0;
  const std::uint64_t start = known - skipped;
  std::vector<Group> found(groups - start);
  kept_.resize(groups);
  const auto [first, last] = part_of(found.size(), ranks);
  do_on_all(ranks, [&, begin = std::max(first, skipped), end = last] {
    sim::parallel_for(begin, end, [&](std::size_t i) {
      const PhotonPieces pieces = trace_group(start + i, stop);
      found[i].rays = pieces.rays.size();
      for (const Ray& ray : pieces.rays) found[i].origins.include(ray.origin);
      found[i].light = ledger_of(tracer_, (start + i) * group_size, pieces, pieces.ends.size());
      kept_[start + i] = keep(pieces);
    });
  });
  share_parts(ranks, std::span(found));
  for (const Group& group : std::span(found).subspan(skipped)) {
    starts_.push_back(starts_.back() + group.rays);
    ledgers_.push_back(group.light);
    if (group.rays == 0) continue;
    origins_.include(group.origins.low);
    origins_.include(group.origins.high);
  }
}

std::uint64_t PhotonSource::group_of(std::uint64_t ray) const {
  return static_cast<std::uint64_t>(std::ranges::upper_bound(starts_, ray) - starts_.begin()) - 1;
}

void PhotonSource::end_with_last_photon(const std::stop_token& stop) {
  const std::uint64_t group = group_of(count_ - 1);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, stop).photons;
  const std::uint64_t last = photons[count_ - 1 - starts_[group]];
  count_ = starts_[group] + static_cast<std::uint64_t>(std::ranges::upper_bound(photons, last) - photons.begin());
  emitted_ = last + 1;
}

void PhotonSource::add_up_light(const std::stop_token& stop) {
  const std::uint64_t last = (emitted_ - 1) / group_size;
  for (std::uint64_t group = 0; group < last; ++group) light_ += ledgers_[group];
  light_ += ledger_of(tracer_, last * group_size, trace_group(last, stop), emitted_ - last * group_size);
  if (emitted_ >= many_photons) return;
  std::vector<std::uint64_t> pieces(emitted_);
  for (std::uint64_t group = 0; group <= last; ++group) {
    PhotonPieces traced;
    for (const std::uint64_t photon : pieces_of(group, traced, stop).photons)
      if (photon < emitted_) ++pieces[photon];
  }
  shares_ = photon_shares(pieces, wanted_);
}

std::uint64_t PhotonSource::block_end(std::uint64_t first, std::uint64_t most) const {
  if (most >= count_ - first) return count_;
  const std::uint64_t next = first + most;  // the first ray that may be in the next block
  const std::uint64_t group = group_of(next);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, {}).photons;
  const std::uint64_t cut = photons[next - starts_[group]];
  const auto begin = std::ranges::lower_bound(photons, cut) - photons.begin();
  const std::uint64_t end = starts_[group] + static_cast<std::uint64_t>(begin);
  if (end > first) return end;
  return starts_[group] + static_cast<std::uint64_t>(std::ranges::upper_bound(photons, cut) - photons.begin());
}

std::uint64_t PhotonSource::first_ray_of(std::uint64_t photon) const {
  const std::uint64_t group = photon / group_size;
  if (photon >= emitted_ || group + 1 >= starts_.size()) return count_;
  if (photon % group_size == 0) return std::min(count_, starts_[group]);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, {}).photons;
  const auto before = static_cast<std::uint64_t>(std::ranges::lower_bound(photons, photon) - photons.begin());
  return std::min(count_, starts_[group] + before);
}

void PhotonSource::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  std::vector<std::uint64_t> photons;
  read_numbered(first, block, photons, stop);
}

void PhotonSource::read_numbered(std::uint64_t first, std::span<Ray> block, std::vector<std::uint64_t>& photons,
                                 const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  photons.resize(block.size());
  if (block.empty()) return;
  const std::uint64_t last = first + block.size();
  sim::parallel_for(group_of(first), group_of(last - 1) + 1, [&](std::uint64_t group) {
    PhotonPieces traced;
    const PhotonPieces& pieces = pieces_of(group, traced, stop);
    const std::uint64_t from = std::max(first, starts_[group]);
    const std::uint64_t to = std::min(last, starts_[group] + pieces.rays.size());
    for (std::uint64_t number = from; number < to; ++number) {
      photons[number - first] = pieces.photons[number - starts_[group]];
      Ray& ray = block[number - first] = pieces.rays[number - starts_[group]];
      if (shares_.empty())
        ray.power /= static_cast<double>(emitted_);
      else
        ray.power *= shares_[pieces.photons[number - starts_[group]]];
    }
  });
}

double PhotonSource::farthest_from(const glm::dvec3& point) const { return farthest_in(origins_, point); }

}  // namespace detp::sim
