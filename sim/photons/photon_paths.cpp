#include "photon_paths.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "photon_rounds.hpp"
#include "photon_tracer.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t block_size = 256;               // number of photons that one thread traces at a time
constexpr std::uint64_t photons_in_round = 1ULL << 17;  // photons, whose pieces are in memory beside the paths

/// Of a block, photons beyond those that have `most` pieces alone are not traced.
std::vector<PhotonPieces> trace_round(const PhotonTracer& tracer, std::uint64_t first, std::uint64_t photons,
                                      std::uint64_t most, const std::stop_token& stop) {
  std::vector<PhotonPieces> blocks((photons + block_size - 1) / block_size);
  sim::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::uint64_t start = first + i * block_size;
    blocks[i] = tracer.trace(start, std::min(start + block_size, first + photons), stop, most);
  });
  return blocks;
}

/// Number of the pieces that reach `missing` pieces and the end of a photon's path; all if there are fewer.
std::size_t whole_photons(const PhotonPieces& pieces, std::size_t missing) {
  if (missing == 0) return 0;
  if (missing >= pieces.rays.size()) return pieces.rays.size();
  const auto end = std::ranges::upper_bound(pieces.photons, pieces.photons[missing - 1]);
  return static_cast<std::size_t>(end - pieces.photons.begin());
}

/// For `count` pieces and the rest of the last photon's.
void reserve(std::size_t count, Paths& paths) {
  const std::size_t room = count + count / 256 + 64;
  paths.rays.reserve(room);
  paths.photons.reserve(room);
  paths.landings.reserve(room);
  paths.triangles.reserve(room);
  paths.further.reserve(room * paths.further_bands);
}

void append(const PhotonPieces& pieces, std::size_t count, Paths& paths) {
  const auto add = [count](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
  };
  add(pieces.rays, paths.rays);
  add(pieces.photons, paths.photons);
  add(pieces.landings, paths.landings);
  add(pieces.triangles, paths.triangles);
  const auto powers = static_cast<std::ptrdiff_t>(count * pieces.further_bands);
  paths.further.insert(paths.further.end(), pieces.further.begin(), pieces.further.begin() + powers);
}

std::vector<double> shares_of(const Paths& paths, std::uint64_t wanted) {
  std::vector<std::uint64_t> pieces(paths.photon_count);
  for (const std::uint64_t photon : paths.photons) ++pieces[photon];
  return photon_shares(pieces, wanted);
}

}  // namespace

TracedPaths photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed, const std::stop_token& stop) {
  return photon_paths(scene, count, seed, caster_for(scene, stop), stop);
}

TracedPaths photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                         std::shared_ptr<const RayCaster> caster, const std::stop_token& stop, PhotonPowers powers) {
  const DefaultFloatingPoint mode;
  const PhotonTracer tracer(scene, seed, std::move(caster));
  PhotonRounds rounds(scene.name, count, photons_in_round);
  TracedPaths paths;
  paths.further_bands = tracer.bands() - 1;
  reserve(count, paths);
  std::vector<PathEnd> ends;  // of photons
  std::vector<std::array<BandLedger, 3>> bands;
  std::uint64_t traced = 0;
  StopCheck check(stop, "copying photon paths");
  try {
    while (paths.rays.size() < count) {
      const std::uint64_t photons = rounds.next(paths.rays.size());
      for (const PhotonPieces& block : trace_round(tracer, traced, photons, count - paths.rays.size(), stop)) {
        const std::size_t missing = count - std::min(count, paths.rays.size());
        if (missing == 0) break;
        const std::size_t taken = whole_photons(block, missing);
        append(block, taken, paths);
        ends.insert(ends.end(), block.ends.begin(), block.ends.end());
        bands.insert(bands.end(), block.bands.begin(), block.bands.end());
        check.after(taken);
      }
      traced += photons;
    }
    if (count > 0) paths.photon_count = paths.photons.back() + 1;
    for (std::uint64_t photon = 0; photon < paths.photon_count; ++photon) {
      paths.light.add(ends[photon], tracer.power(photon));
      for (std::size_t band = 0; !bands.empty() && band < 3; ++band) paths.light.bands[band] += bands[photon][band];
    }
    paths.light.landings = static_cast<std::uint64_t>(
        std::ranges::count_if(paths.landings, [](double distance) { return distance < unbounded; }));
    const std::vector<double> shares = powers == PhotonPowers::equal ? std::vector<double>() : shares_of(paths, count);
    const auto equal = static_cast<double>(paths.photon_count);
    if (powers == PhotonPowers::scaled && shares.empty()) {
      paths.scale = 1 / equal;
      return paths;
    }
    for_each_checked(0, paths.rays.size(), check, [&](std::size_t i) {
      const auto scale = [&](double& power) {
        if (shares.empty())
          power /= equal;
        else
          power *= shares[paths.photons[i]];
      };
      scale(paths.rays[i].power);
      for (std::size_t band = 0; band < paths.further_bands; ++band)
        scale(paths.further[i * paths.further_bands + band]);
    });
  } catch (const Stopped&) {
    stopped_tracing(paths.rays.size(), count);
  }
  return paths;
}

std::vector<double> photon_shares(std::span<const std::uint64_t> pieces, std::uint64_t wanted) {
  const std::size_t n = pieces.size();
  if (n < 2 || n >= many_photons) return {};
  const std::uint64_t excess = std::accumulate(pieces.begin(), pieces.end(), std::uint64_t{0}) - wanted;
  const auto may_be_last = [&](std::uint64_t own) { return own > excess; };
  const auto m = static_cast<double>(std::ranges::count_if(pieces, may_be_last));
  if (m == static_cast<double>(n)) return {};
  const double other = 1 / static_cast<double>(n - 1);
  std::vector<double> shares;
  for (const std::uint64_t own : pieces) shares.push_back(may_be_last(own) ? (1 - 1 / m) * other : other);
  return shares;
}

}  // namespace detp::sim
