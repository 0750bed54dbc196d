#include "reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/resample.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t paths_at_first = 64;
constexpr std::uint64_t most_paths = 1 << 22;
constexpr std::size_t rays_of_a_batch = 1'000'000;
constexpr int fewest_batches = 4;
constexpr int most_batches = 1024;

class ReferenceMaker {
 public:
  ReferenceMaker(const sim::Scene& scene, const ReferenceOptions& options) : scene_(scene), options_(options) {
    reference_.scene = scene.name;
    sim::add_by_area(reference_.samples, scene.mesh, options.samples, options.seed, options.stop);
    if (reference_.samples.empty())
      throw std::invalid_argument("a reference needs triangles with an area; " + scene.name + " has none");
    reference_.irradiance.resize(reference_.samples.size());
    reference_.variance.resize(reference_.samples.size());
  }

  Reference make() && {
    if (scene_.known_irradiance) {
      std::ranges::fill(reference_.irradiance, *scene_.known_irradiance);
    } else if (sim::misses_light(scene_)) {
      by_landings();
    } else {
      by_backward_paths();
    }
    reference_.seconds = watch_.seconds();
    return std::move(reference_);
  }

 private:
  [[nodiscard]] bool over() const { return options_.stop.stop_requested() || watch_.seconds() >= options_.seconds; }

  void report(const char* doing) {
    if (!options_.progress) return;
    const double target = std::pow(options_.error / std::max(options_.error, reference_.error()), 2);
    options_.progress({doing, std::min(1.0, std::max(target, watch_.seconds() / options_.seconds)), 1});
  }

  void by_backward_paths() {
    reference_.kind = ReferenceKind::backward;
    const sim::BackwardPaths walk(scene_, options_.seed, options_.stop);
    std::vector<sim::PathSums> sums(reference_.samples.size());
    for (std::uint64_t paths = paths_at_first; paths <= most_paths; paths += paths / 2) {
      sim::on_threads(sim::thread_count(options_.threads), [&] {
        sim::add_backward_paths(walk, reference_.samples, paths, options_.front_facing, sums, options_.stop);
      });
      if (options_.stop.stop_requested() && std::ranges::any_of(sums, [](const auto& one) { return one.paths == 0; }))
        throw sim::Stopped("stopped before the reference had a value for each sample");
      reference_.paths = paths;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        reference_.irradiance[i] = sums[i].irradiance();
        reference_.variance[i] = sums[i].variance();
        reference_.paths = std::min(reference_.paths, sums[i].paths);
      }
      if (reference_.error() <= options_.error) return;
      report("reference: backward paths");
      if (over()) break;
    }
    reference_.stopped = true;
  }

  /// Batches of photons with seeds of their own; their spread gives the variance.
  void by_landings() {
    reference_.kind = ReferenceKind::landings;
    const auto caster = sim::caster_for(scene_, options_.stop);
    const double radius =
        options_.patch_radius > 0 ? options_.patch_radius : sim::mean_edge_length(scene_.mesh, options_.stop) / 8;
    std::vector<sim::Disc> patches;
    for (const sim::Sample& sample : reference_.samples) patches.push_back({sample.position, sample.normal, radius});
    std::vector<double> sums(patches.size());
    std::vector<double> squares(patches.size());
    for (int batch = 1; batch <= most_batches; ++batch) {
      const sim::Paths paths = sim::photon_paths(scene_, rays_of_a_batch, seed_of(batch), caster, options_.stop);
      const sim::Problem problem =
          sim::make_problem(paths, patches, options_.front_facing, sim::thread_count(options_.threads), options_.stop);
      const sim::Outcome outcome =
          sim::estimate(problem, {.estimator = sim::Estimator::area_corrected, .mesh = &scene_.mesh},
                        {.count = false, .stop = options_.stop, .threads = options_.threads});
      if (outcome.stopped && batch <= fewest_batches)
        throw sim::Stopped("stopped before the reference had a value for each sample");
      if (outcome.stopped) break;
      reference_.paths += paths.photon_count;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] += outcome.irradiance[i];
        squares[i] += outcome.irradiance[i] * outcome.irradiance[i];
        reference_.irradiance[i] = sums[i] / batch;
        if (batch > 1)
          reference_.variance[i] =
              std::max(0.0, squares[i] / batch - std::pow(reference_.irradiance[i], 2)) / (batch - 1);
      }
      if (batch >= fewest_batches && reference_.error() <= options_.error) return;
      report("reference: photons on patches");
      if (batch >= fewest_batches && over()) break;
    }
    reference_.stopped = true;
  }

  /// Apart from the seeds of the runs that are judged.
  [[nodiscard]] std::uint64_t seed_of(int batch) const {
    return (options_.seed << 20) + (std::uint64_t{1} << 63) + static_cast<std::uint64_t>(batch);
  }

  const sim::Scene& scene_;
  const ReferenceOptions& options_;
  sim::Stopwatch watch_;
  Reference reference_;
};

}  // namespace

std::string_view name(ReferenceKind kind) {
  switch (kind) {
    case ReferenceKind::known:
      return "known";
    case ReferenceKind::backward:
      return "backward paths";
    case ReferenceKind::landings:
      return "photons on patches";
  }
  return "";
}

double Reference::error() const {
  double errors = 0;
  double squares = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    errors += variance[i];
    squares += irradiance[i] * irradiance[i] - variance[i];
  }
  return errors > 0 ? std::sqrt(errors / std::max(squares, 1e-300)) : 0;
}

Reference make_reference(const sim::Scene& scene, const ReferenceOptions& options) {
  const sim::DefaultFloatingPoint mode;
  require_count("number of samples of a reference", static_cast<double>(options.samples), 1, 1e7);
  require_positive("error of a reference", options.error);
  require_positive("seconds of a reference", options.seconds);
  require_non_negative("radius of the reference's patches", options.patch_radius);
  return ReferenceMaker(scene, options).make();
}

}  // namespace detp::validate
