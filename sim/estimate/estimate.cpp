#include "estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "surface.hpp"
#include "variable_radius.hpp"

namespace detp::sim {
namespace {

void require_pairs_of(const EstimateRequest& request) {
  if (request.candidate.technique == Technique::photon_map)
    throw std::invalid_argument(fmt::format("{} needs a technique that finds pairs of rays and discs (got {})",
                                            name(request.estimator), name(request.candidate.technique)));
}

/// Throws unless the estimator has all that it looks at.
void require_surfaces(const Problem& problem, const EstimateRequest& request) {
  const std::string_view estimator = name(request.estimator);
  if (request.mesh == nullptr || request.mesh->triangles.empty())
    throw std::invalid_argument(fmt::format("{} needs a mesh: a scene with triangles", estimator));
  if (problem.triangles().empty())
    throw std::invalid_argument(fmt::format(
        "{} needs to know which triangles the photons met: photon paths that were traced in the scene", estimator));
  const auto triangles = static_cast<std::uint32_t>(request.mesh->triangles.size());
  for (const std::uint32_t triangle : problem.triangles())
    if (triangle != no_triangle && triangle >= triangles)
      throw std::invalid_argument(fmt::format("a photon met triangle {}, but the mesh has {}", triangle, triangles));
}

void refuse_options(const RunOptions& options, std::string_view estimator) {
  if (options.pairs) throw std::invalid_argument(fmt::format("{} finds no pairs of rays and discs", estimator));
  if (options.totals != nullptr)
    throw std::invalid_argument(fmt::format("{} needs all rays at once, so it adds to no totals", estimator));
}

Outcome by_paths(const Problem& problem, const EstimateRequest& request, const RunOptions& options) {
  if (request.scene == nullptr) throw std::invalid_argument("gather needs a scene: its surfaces and lights");
  check_options(options, problem);
  return gather(problem, *request.scene, request.paths, request.seed, options);
}

Outcome by_surfaces(const Problem& problem, const EstimateRequest& request, const RunOptions& options) {
  require_surfaces(problem, request);
  return run(problem, *prepare_surfaces(request.estimator, *request.mesh, options.stop), options);
}

Outcome by_estimator(const Problem& problem, const EstimateRequest& request, const RunOptions& options) {
  switch (request.estimator) {
    case Estimator::disc:
      require_pairs_of(request);
      return run(problem, request.candidate, options);
    case Estimator::variable_radius:
      require_pairs_of(request);
      refuse_options(options, name(request.estimator));
      return estimate_with_variable_radius(problem, request.candidate, options);
    case Estimator::nearest:
      return run(problem, Candidate{Technique::photon_map, PhotonMapParameters{request.nearest, request.nearest_form}},
                 options);
    default:
      refuse_options(options, name(request.estimator));
      return record_of(request.estimator).needs_scene ? by_paths(problem, request, options)
                                                      : by_surfaces(problem, request, options);
  }
}

}  // namespace

std::unique_ptr<Index> prepare_surfaces(Estimator estimator, const Mesh& mesh, const std::stop_token& stop,
                                        std::shared_ptr<const NearTriangles> triangles) {
  PrepareSurfaces* const prepare = record_of(estimator).prepare;
  if (prepare == nullptr) throw std::invalid_argument(fmt::format("{} does not look at surfaces", name(estimator)));
  return prepare(mesh, stop, std::move(triangles));
}

Outcome estimate(const Problem& problem, const EstimateRequest& request, const RunOptions& options) {
  const DefaultFloatingPoint mode;
  Outcome outcome;
  try {
    outcome = by_estimator(problem, request, options);
  } catch (const Stopped&) {  // stopped before the search
    outcome = unsearched_outcome(problem, options);
  }
  if (record_of(request.estimator).needs_scene && outcome.progress.of == 0)
    outcome.progress = {0, problem.discs().size(), "discs"};
  return outcome;
}

}  // namespace detp::sim
