#include "job_batches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/estimate/surface.hpp"

namespace detp::validate {
namespace {

/// Distance from the centre of S₀ at which rays may start, if it is unusual: that of the first rays, with room for others.
std::optional<double> farthest_of(const sim::Problem& problem) {
  constexpr double usual = 1000;
  if (problem.farthest() < 0.5 * usual * problem.enclosing().radius) return std::nullopt;
  return 2 * problem.farthest();
}

}  // namespace

void require_batches(sim::Estimator estimator) {
  if (sim::record_of(estimator).needs_scene)
    throw std::invalid_argument(fmt::format(
        "the estimator {} traces no photons, so it cannot run until an error is reached: more paths, less noise",
        name(estimator)));
  if (sim::record_of(estimator).all_at_once)
    throw std::invalid_argument(
        fmt::format("the estimator {} needs all its rays at once, and cannot run until an error is reached: detp "
                    "accuracy finds its number of rays",
                    name(estimator)));
}

JobSearch::JobSearch(const Job& job, sim::Estimator estimator, const Candidate& candidate, sim::RunOptions options)
    : job_(job), options_(std::move(options)) {
  require_batches(estimator);
  if (sim::record_of(estimator).finds_pairs)
    searcher_.emplace(job.discs, candidate, farthest_of(job.problem()), job.front_facing, options_);
  else if (!job.scene)
    throw std::invalid_argument(fmt::format("{} needs a mesh: a scene with triangles", name(estimator)));
  else
    surfaces_ = sim::prepare_surfaces(estimator, job.scene->mesh, options_.stop);
}

const sim::Outcome& JobSearch::operator()(const sim::PathRays& rays) {
  if (searcher_) return searcher_->search(rays, scratch_, options_);
  const sim::Problem problem =
      sim::make_problem(rays, job_.discs, job_.front_facing, sim::thread_count(options_.threads), options_.stop);
  return scratch_.outcome = sim::run(problem, *surfaces_, options_);
}

std::optional<JobBatches::Place> JobBatches::next_place() const {
  if (job_.rays_from_file || !own_.at_end()) return std::nullopt;
  return Place{batches_, made_};
}

std::optional<RayBatch> JobBatches::next(std::uint64_t rays) {
  if (stop_.stop_requested()) throw sim::Stopped("stopped between batches");
  std::optional<RayBatch> batch;
  if (const auto place = next_place()) {
    batch = at(*place, rays);
  } else if ((batch = own_.next(rays)) && powers_add_up(job_)) {
    batch->scale = 1 / batch->photons;
  }
  if (!batch) return std::nullopt;
  ++batches_;
  made_ += batch->rays.rays.size();
  return batch;
}

RayBatch JobBatches::at(const Place& place, std::uint64_t rays) {
  more_ = job_.more_rays(place.made, place.batch, static_cast<std::size_t>(rays), stop_);
  const auto photons = static_cast<double>(more_.photon_count);
  return {more_, photons, powers_add_up(job_) ? 1 / photons : 1, more_.light};
}

std::vector<double> weights_of(const Job& job, Surfaces surfaces) {
  if (!job.scene || job.scene->mesh.triangles.empty()) return weights_by_area(job.discs);
  const bool of_samples =
      std::ranges::equal(job.scene->samples, job.discs, {}, &sim::Sample::position, &sim::Disc::centre);
  return of_samples ? area_weights(*job.scene, surfaces) : weights_by_area(job.discs);
}

}  // namespace detp::validate
