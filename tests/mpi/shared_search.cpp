// A search that the processes of mpirun share: prints what rank 0 found. shared_search RAYS DISCS
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "../support/discs_elsewhere.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/sim/ranks/mpi_ranks.hpp"

using namespace detp;
using namespace detp::sim;
using support::DiscsElsewhere;

namespace {

template <class T>
std::uint64_t digest(const std::vector<T>& values) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const T& value : values) {
    std::uint64_t bits;
    static_assert(sizeof(value) == sizeof(bits));
    std::memcpy(&bits, &value, sizeof(bits));
    hash = (hash ^ bits) * 1099511628211ULL;
  }
  return hash;
}

void search_stored(const std::vector<Disc>& discs, const RaySource& source, Ranks& ranks) {
  const StreamOptions options{.run = {.pairs = true, .standard_error = true}};
  const Candidate candidate{Technique::box_tree, BoxTreeParameters{}};
  const RankedOutcome found = run_on_ranks(DiscsElsewhere(discs), source, candidate, options, ranks);
  if (ranks.rank() != 0) return;
  std::vector<double> irradiance;
  std::vector<std::uint64_t> pairs;
  found.results->for_each_disc(
      [&](std::span<const DiscResult> found_in) { irradiance.push_back(found_in[0].irradiance); });
  found.results->for_each_pair([&](const Pair& pair) { pairs.push_back(std::uint64_t{pair.ray} << 32 | pair.disc); });
  std::printf("stored discs: irradiance %016llx, pairs %016llx\n", static_cast<unsigned long long>(digest(irradiance)),
              static_cast<unsigned long long>(digest(pairs)));
}

void search(const char* what, const std::vector<Disc>& discs, const RaySource& source, Ranks& ranks) {
  const StreamOptions options{.run = {.standard_error = true}};
  for (const Candidate& candidate :
       {Candidate{Technique::box_tree, BoxTreeParameters{}}, Candidate{Technique::octree, OctreeParameters{4}}}) {
    const StreamedOutcome found = run_on_ranks(discs, source, candidate, options, ranks).found;
    if (ranks.rank() == 0)
      std::printf("%s, %s: %llu hits, irradiance %016llx, errors %016llx\n", what,
                  std::string(name(candidate.technique)).c_str(),
                  static_cast<unsigned long long>(found.outcome.total_hits),
                  static_cast<unsigned long long>(digest(found.outcome.irradiance)),
                  static_cast<unsigned long long>(digest(found.outcome.standard_error)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const auto begin = std::chrono::steady_clock::now();
  const std::uint64_t rays = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'500'000;
  const std::size_t samples = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 300;
  {
    MpiRanks ranks(MPI_COMM_WORLD);
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, samples, 0.05, 3);
    search("lines", discs, LinesOfField(enclosing_sphere(discs), 1, rays), ranks);
    search_stored(discs, LinesOfField(enclosing_sphere(discs), 1, rays / 10), ranks);
    const Scene scene = open_scene({"@cornell", samples, 1, {}, {}});
    std::vector<Disc> on_surface;
    for (const Sample& sample : scene.samples) on_surface.push_back({sample.position, sample.normal, 0.05});
    search("photon paths", on_surface, PhotonSource(scene, rays, 1, caster_for(scene), {}, &ranks), ranks);
    if (ranks.rank() == 0)
      std::fprintf(stderr, "%.3f s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  MPI_Finalize();
}
