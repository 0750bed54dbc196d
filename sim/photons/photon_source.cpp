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
#include "photon_paths.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t group_size = 1024;  // photons in a group
constexpr std::uint64_t most_in_a_round = 1ULL << 26;
constexpr std::uint64_t first_known = 1ULL << 16;  // rays, before the first is read
/// With its photon's number.
std::size_t bytes_of_ray(std::size_t bands) { return bytes_of_ray_in(bands) + sizeof(std::uint64_t); }

/// Of the first photons of some that begin with number `first`.
LightLedger ledger_of(const PhotonTracer& tracer, std::uint64_t first, const PhotonPieces& pieces,
                      std::uint64_t photons) {
  LightLedger light;
  for (std::uint64_t i = 0; i < photons; ++i) {
    light.add(pieces.ends[i], tracer.power(first + i));
    for (std::size_t band = 0; !pieces.bands.empty() && band < 3; ++band) light.bands[band] += pieces.bands[i][band];
  }
  for (std::size_t i = 0; i < pieces.rays.size() && pieces.photons[i] < first + photons; ++i)
    light.landings += pieces.landings[i] < unbounded ? 1 : 0;
  return light;
}

/// All rays start in this box: at lights, and on surfaces, found in single precision.
Box origins_of(const Scene& scene) {
  Box box = scene.box;
  for (const glm::dvec3& position : scene.mesh.positions) box.include(position);
  for (const Light& light : scene.lights) {
    const Box starts = starts_of(light, scene);
    box.include(starts.low);
    box.include(starts.high);
  }
  constexpr double room = 1e-4;
  const double more = room * box.longest_side();
  return {box.low - more, box.high + more};
}

}  // namespace

PhotonSource::PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed,
                           std::shared_ptr<const RayCaster> caster, const std::stop_token& stop, Ranks* ranks,
                           Counting counting)
    : tracer_(scene, seed, std::move(caster)),
      counting_(counting),
      wanted_(count),
      most_kept_(counting == Counting::ahead ? most_kept_bytes()
                                             : 2.0 * static_cast<double>(bytes_of_ray(tracer_.bands()) * first_known)),
      origins_(origins_of(scene)),
      known_(new Known{
          .rounds = PhotonRounds(scene.name, count, most_in_a_round), .kept = {}, .ledgers = {}, .count = count}) {
  const DefaultFloatingPoint mode;
  require_memory(fmt::format("numbers of {} rays", count), 16.0 * static_cast<double>(count) / group_size);
  known_->all = count == 0;
  OneRank one;
  try {
    know(counting == Counting::ahead ? count : std::min(count, first_known), ranks != nullptr ? *ranks : one, stop);
    while (!known_->all && known_->emitted < many_photons) know(known_->starts.back() + 1, one, stop);
  } catch (const Stopped&) {
    stopped_tracing(std::min(known_->starts.back(), count), count);
  }
}

PhotonPieces PhotonSource::trace_group(std::uint64_t group, const std::stop_token& stop) const {
  const std::uint64_t first = group * group_size;
  return tracer_.trace(first, std::min(first + group_size, known_->rounds.limit()), stop, wanted_);
}

const PhotonPieces& PhotonSource::pieces_of(std::uint64_t group, PhotonPieces& traced,
                                            const std::stop_token& stop) const {
  StopCheck(stop, "making rays").now();
  if (group < known_->kept.size() && known_->kept[group]) return *known_->kept[group];
  return traced = trace_group(group, stop);
}

std::unique_ptr<const PhotonPieces> PhotonSource::keep(const PhotonPieces& pieces) const {
  const std::size_t bytes = pieces.rays.size() * bytes_of_ray(bands());
  const std::uint64_t all = known_->kept_bytes.fetch_add(bytes) + bytes;
  if (counting_ == Counting::ahead && static_cast<double>(all) > most_kept_) return nullptr;
  auto kept = std::make_unique<PhotonPieces>();
  kept->rays.assign(pieces.rays.begin(), pieces.rays.end());
  kept->photons.assign(pieces.photons.begin(), pieces.photons.end());
  kept->further = pieces.further;
  kept->further_bands = pieces.further_bands;
  return kept;
}

double PhotonSource::kept_bytes(std::size_t block) const {
  if (counting_ == Counting::ahead) return std::min(static_cast<double>(known_->kept_bytes), most_kept_);
  return std::min(static_cast<double>(wanted_ * bytes_of_ray(bands())),
                  most_kept_ + static_cast<double>(block * bytes_of_ray(bands())));
}

void PhotonSource::know(std::uint64_t rays, Ranks& ranks, const std::stop_token& stop) const {
  Known& known = *known_;
  while (!known.all && known.starts.back() < rays) {
    known.photons += known.rounds.next(known.starts.back(), std::min(rays, wanted_));
    count_rays((known.photons + group_size - 1) / group_size, ranks, stop);
    known.emitted = (known.starts.size() - 1) * group_size;
    if (known.starts.back() >= wanted_) end_with_last_photon(stop);
  }
}

void PhotonSource::count_rays(std::uint64_t groups, Ranks& ranks, const std::stop_token& stop) const {
  struct Group {
    std::uint64_t rays = 0;
    LightLedger light;
  };
  Known& all = *known_;
  const std::uint64_t known = all.starts.size() - 1;
  if (groups <= known) return;
  // If few are known, each rank traces, and keeps, the groups that it is likely to search: its part of all.
  constexpr std::uint64_t few = 16;
  const std::uint64_t skipped = few * known * static_cast<std::uint64_t>(ranks.count()) <= groups ? known : 0;
  const std::uint64_t start = known - skipped;
  std::vector<Group> found(groups - start);
  all.kept.resize(groups);
  const auto [first, last] = part_of(found.size(), ranks);
  do_on_all(ranks, [&, begin = std::max(first, skipped), end = last] {
    sim::parallel_for(begin, end, [&](std::size_t i) {
      const PhotonPieces pieces = trace_group(start + i, stop);
      found[i].rays = pieces.rays.size();
      found[i].light = ledger_of(tracer_, (start + i) * group_size, pieces, pieces.ends.size());
      all.kept[start + i] = keep(pieces);
    });
  });
  share_parts(ranks, std::span(found));
  for (const Group& group : std::span(found).subspan(skipped)) {
    all.starts.push_back(all.starts.back() + group.rays);
    all.ledgers.push_back(group.light);
  }
}

std::uint64_t PhotonSource::group_of(std::uint64_t ray) const {
  return static_cast<std::uint64_t>(std::ranges::upper_bound(known_->starts, ray) - known_->starts.begin()) - 1;
}

void PhotonSource::end_with_last_photon(const std::stop_token& stop) const {
  Known& known = *known_;
  const std::uint64_t group = group_of(wanted_ - 1);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, stop).photons;
  const std::uint64_t last = photons[wanted_ - 1 - known.starts[group]];
  known.count =
      known.starts[group] + static_cast<std::uint64_t>(std::ranges::upper_bound(photons, last) - photons.begin());
  known.emitted = last + 1;
  known.all = true;
  if (known.emitted >= many_photons) return;
  std::vector<std::uint64_t> pieces(known.emitted);
  for (std::uint64_t i = 0; i <= group; ++i) {
    PhotonPieces of_group;
    for (const std::uint64_t photon : pieces_of(i, of_group, stop).photons)
      if (photon < known.emitted) ++pieces[photon];
  }
  known.shares = photon_shares(pieces, wanted_);
}

LightLedger PhotonSource::light_of(std::uint64_t photons) const {
  LightLedger light;
  const std::uint64_t last = photons / group_size;
  for (std::uint64_t group = 0; group < last; ++group) light += known_->ledgers.at(group);
  if (const std::uint64_t rest = photons % group_size; rest > 0)
    light += ledger_of(tracer_, last * group_size, trace_group(last, {}), rest);
  return light;
}

std::uint64_t PhotonSource::photons_of(std::uint64_t rays) const {
  if (rays == 0) return 0;
  if (rays >= known_->count) return known_->emitted;
  const std::uint64_t group = group_of(rays - 1);
  PhotonPieces traced;
  return pieces_of(group, traced, {}).photons[rays - 1 - known_->starts[group]] + 1;
}

double PhotonSource::scale(std::uint64_t rays) const {
  const auto photons = static_cast<double>(photons_of(rays));
  return (known_->shares.empty() ? 1 : static_cast<double>(known_->emitted)) / photons;
}

std::uint64_t PhotonSource::block_end(std::uint64_t first, std::uint64_t most, const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  OneRank one;
  if (!known_->all) know(most >= wanted_ - first ? wanted_ : first + most + 1, one, stop);
  if (known_->all && most >= known_->count - first) return known_->count;
  const std::uint64_t next = first + most;  // the first ray that may be in the next block
  const std::uint64_t group = group_of(next);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, {}).photons;
  const std::uint64_t cut = photons[next - known_->starts[group]];
  const auto begin = std::ranges::lower_bound(photons, cut) - photons.begin();
  const std::uint64_t end = known_->starts[group] + static_cast<std::uint64_t>(begin);
  if (end > first) return end;
  return known_->starts[group] + static_cast<std::uint64_t>(std::ranges::upper_bound(photons, cut) - photons.begin());
}

std::uint64_t PhotonSource::first_ray_of(std::uint64_t photon) const {
  OneRank one;
  know(wanted_, one, {});
  const std::vector<std::uint64_t>& starts = known_->starts;
  const std::uint64_t group = photon / group_size;
  if (photon >= known_->emitted || group + 1 >= starts.size()) return known_->count;
  if (photon % group_size == 0) return std::min(known_->count, starts[group]);
  PhotonPieces traced;
  const std::vector<std::uint64_t>& photons = pieces_of(group, traced, {}).photons;
  const auto before = static_cast<std::uint64_t>(std::ranges::lower_bound(photons, photon) - photons.begin());
  return std::min(known_->count, starts[group] + before);
}

void PhotonSource::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  BesideRays beside;
  read_all(first, block, beside, stop);
}

void PhotonSource::read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                            const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  std::vector<std::uint64_t>& photons = beside.photons;
  photons.resize(block.size());
  const std::size_t further = bands() - 1;
  beside.further.resize(block.size() * further);
  if (block.empty()) return;
  const std::vector<std::uint64_t>& starts = known_->starts;
  const std::vector<double>& shares = known_->shares;
  const std::uint64_t last = first + block.size();
  sim::parallel_for(group_of(first), group_of(last - 1) + 1, [&](std::uint64_t group) {
    PhotonPieces traced;
    const PhotonPieces& pieces = pieces_of(group, traced, stop);
    const std::uint64_t from = std::max(first, starts[group]);
    const std::uint64_t to = std::min(last, starts[group] + pieces.rays.size());
    for (std::uint64_t number = from; number < to; ++number) {
      photons[number - first] = pieces.photons[number - starts[group]];
      Ray& ray = block[number - first] = pieces.rays[number - starts[group]];
      if (!shares.empty()) ray.power *= shares[photons[number - first]];
      for (std::size_t band = 0; band < further; ++band) {
        double& power = beside.further[(number - first) * further + band];
        power = pieces.further[(number - starts[group]) * further + band];
        if (!shares.empty()) power *= shares[photons[number - first]];
      }
    }
    const bool is_read = to == starts[group] + pieces.rays.size();
    if (counting_ == Counting::ahead || !is_read || static_cast<double>(known_->kept_bytes) <= most_kept_) return;
    if (known_->kept[group] == nullptr) return;
    known_->kept_bytes -= pieces.rays.size() * bytes_of_ray(bands());
    known_->kept[group] = nullptr;
  });
}

double PhotonSource::farthest_from(const glm::dvec3& point) const { return farthest_in(origins_, point); }

}  // namespace detp::sim
