#include "gather.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/near/each_disc.hpp"
#include "detp/sim/photons/lights.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t paths_at_once = 1024;  // by one thread, before it looks for a stop request
constexpr std::uint64_t most_parts = 256;      // of so many paths, at a time

const Scene& with_light(const Scene& scene, std::uint64_t paths) {
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument("gather needs a scene with triangles; " + scene.name + " has none");
  if (scene.lights.empty()) throw std::invalid_argument("gather needs a light; " + scene.name + " has none");
  static_cast<void>(Lights(scene));  // checks them
  constexpr std::uint64_t most = std::uint64_t{1} << 32;
  if (paths < 1 || paths > most)
    throw std::invalid_argument(fmt::format("number of paths must be 1 to {} (got {})", most, paths));
  return scene;
}

void operator+=(PathSums& all, const PathSums& more) {
  all.front += more.front;
  all.back += more.back;
  all.front_squares += more.front_squares;
  all.back_squares += more.back_squares;
  all.largest = std::max(all.largest, more.largest);
  all.lit += more.lit;
}

bool has_light(const Scene& scene) {
  return std::ranges::any_of(scene.lights, [](const Light& light) { return light.flux > 0; });
}

class GatherIndex final : public Index {
 public:
  GatherIndex(const Scene& scene, std::uint64_t paths, std::uint64_t seed, const std::stop_token& stop)
      : walk_(with_light(scene, paths), seed, stop), paths_(paths) {
    built_.seconds.build = watch_.seconds();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const std::size_t discs = problem.discs().size();
    add_checked_bytes("sums over paths", static_cast<double>(discs) * (sizeof(PathSums) + 4 * sizeof(double)), problem,
                      outcome);
    resize_results(discs, options.standard_error, outcome);
    std::vector<PathSums> sums(discs);
    const std::vector<char> done = for_each_disc(
        options, discs, 1, [&] { return [&](std::size_t i) { return sum(problem, i, options.stop, sums[i]); }; });
    finish(sums, options.standard_error, outcome);
    outcome.progress = {discs, discs, "discs"};
    add_up_discs(done, outcome);
  }

 private:
  /// Parts of many paths are added in order. Returns false on a stop request.
  [[nodiscard]] bool sum(const Problem& problem, std::size_t number, const std::stop_token& stop, PathSums& all) const {
    const Disc& disc = problem.discs()[number];
    std::vector<PathSums> parts(std::min(most_parts, (paths_ + paths_at_once - 1) / paths_at_once));
    for (all.paths = 0; all.paths < paths_; all.paths += parts.size() * paths_at_once) {
      sim::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
        parts[i] = {.paths = std::min(paths_, all.paths + i * paths_at_once)};
        if (!stop.stop_requested())
          walk_.add({disc.centre, disc.normal}, number, std::min(paths_, parts[i].paths + paths_at_once),
                    problem.front_facing(), parts[i]);
      });
      if (stop.stop_requested()) return false;
      for (const PathSums& part : parts) all += part;
    }
    all.paths = paths_;
    return true;
  }

  void finish(std::span<const PathSums> sums, bool errors, Outcome& outcome) const {
    const auto paths = static_cast<double>(paths_);
    double heaviest = 0;
    for (const PathSums& one : sums) heaviest = std::max(heaviest, one.largest);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const PathSums& one = sums[i];
      outcome.hits[i] = one.lit;
      outcome.irradiance[i] = (one.front + one.back) / paths;
      if (!errors) continue;
      outcome.standard_error[i] = one.lit > 1 && paths_ > 1 ? std::sqrt(one.variance()) : unbounded;
      outcome.upper_bound[i] = heaviest > 0 ? bound_of(one, heaviest) / paths : unbounded;
    }
  }

  /// Of the sum. Pairs of a path in front and one behind, which are independent: Σ (x + y)² = Σ x² + Σ y² + 2 Σ x Σ y / N.
  [[nodiscard]] double bound_of(const PathSums& one, double heaviest) const {
    const auto paths = static_cast<double>(paths_);
    const double squares = one.front_squares + one.back_squares + 2 * one.front * (one.back / paths);
    return error_of_power(one.front + one.back, {squares, one.largest}, heaviest, paths).upper_bound;
  }

  Stopwatch watch_;
  BackwardPaths walk_;
  std::uint64_t paths_;
};

}  // namespace

Scene in_band(const Scene& scene, int band) {
  Scene one = scene;
  one.rgb = false;
  one.mesh.materials.take_band(band);
  for (Light& light : one.lights)
    if (kind_of(light) == LightKind::surface) light.flux = emitted_flux(one.mesh);
  return one;
}

Outcome gather(const Problem& problem, const Scene& scene, std::uint64_t paths, std::uint64_t seed,
               const RunOptions& options) {
  const auto in_scene = [&](const Scene& one) {
    return run(problem, *prepare_gather(one, paths, seed, options), options);
  };
  if (!scene.rgb) return in_scene(scene);
  std::vector<BandResults> bands;
  Outcome all;  // hits are those of the first band with light
  for (int band = 0; band < 3; ++band) {
    Outcome found;
    if (const Scene one = in_band(scene, band); has_light(one))
      found = in_scene(one);
    else
      resize_results(problem.discs().size(), options.standard_error, found);
    bands.push_back(found);
    if (found.progress.of == 0) continue;  // dark
    const double before = all.seconds.search;
    if (all.progress.of == 0 || found.stopped) all = std::move(found);
    all.seconds.search += before;
    if (all.stopped) break;
  }
  bands.resize(3, bands.back());  // of a stopped search, bands that were not begun have no meaning
  static_cast<BandResults&>(all) = bands[0];
  all.further.assign(bands.begin() + 1, bands.end());
  if (all.stopped && !all.done_discs.empty()) keep_done_discs(all);
  return all;
}

std::unique_ptr<Index> prepare_gather(const Scene& scene, std::uint64_t paths, std::uint64_t seed,
                                      const RunOptions& options) {
  return std::make_unique<GatherIndex>(scene, paths, seed, options.stop);
}

}  // namespace detp::sim
