#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "detp/sim/estimate/estimator.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/accuracy/judged_samples.hpp"
#include "detp/validate/job/job.hpp"
#include "execute_until.hpp"

namespace detp::validate {

/// The power of a ray does not depend on the number of rays.
[[nodiscard]] inline bool powers_add_up(const Job& job) {
  return !job.rays_from_file && job.field != sim::Field::photons;
}

/// Gives the rays of a job, then further ones of the same kind (Job::more_rays); of a file only those, in random order. Irradiances are those that all
/// photons bring together; of lines, which have power 1 each, those of one line.
class JobBatches {
 public:
  /// The job must outlive this.
  explicit JobBatches(const Job& job, std::stop_token stop = {})
      : job_(job),
        stop_(std::move(stop)),
        own_(job.paths(), job.independent_photons(), job.rays_from_file ? std::optional(job.seed) : std::nullopt) {}

  /// Goes on after so many batches of the same job, which gave so many photons and rays.
  void skip(std::uint64_t batches, double photons, std::uint64_t rays) {
    batches_ = batches;
    made_ = rays;
    own_.skip(static_cast<std::uint64_t>(photons), rays);
  }

  /// Throws sim::Stopped on a stop request.
  [[nodiscard]] std::optional<RayBatch> next(std::uint64_t rays);

  /// Where the next batch is, if it has none of the job's own rays.
  struct Place {
    std::uint64_t batch = 0;
    std::uint64_t made = 0;
  };
  /// Nothing if the next batch has rays of the job's own, or if there are no others.
  [[nodiscard]] std::optional<Place> next_place() const;
  /// A batch at the next place was given, by other means.
  void count(std::uint64_t rays) {
    ++batches_;
    made_ += rays;
  }
  /// The batch at any place. It stays until the next one is made.
  [[nodiscard]] RayBatch at(const Place& place, std::uint64_t rays);

 private:
  const Job& job_;
  std::stop_token stop_;
  StoredBatches own_;
  sim::TracedPaths more_;
  std::uint64_t batches_ = 0;  ///< that were given
  std::uint64_t made_ = 0;     ///< their rays
};

/// Searches rays of a job's kind, batch by batch: an index over its discs, or over its scene's surfaces, is built once.
class JobSearch {
 public:
  /// The candidate matters to estimators that find pairs. The job, which must outlive this, has its rays in memory, and its scene if
  /// the estimator looks at surfaces. Throws as sim::Searcher, and std::invalid_argument for nearest and variable-radius, which need all
  /// rays at once.
  JobSearch(const Job& job, sim::Estimator estimator, const Candidate& candidate, sim::RunOptions options);

  const sim::Outcome& operator()(const sim::PathRays& rays);
  [[nodiscard]] const sim::Built& built() const { return searcher_ ? searcher_->built() : surfaces_->built(); }

 private:
  const Job& job_;
  sim::RunOptions options_;
  std::optional<sim::Searcher> searcher_;
  std::unique_ptr<const sim::Index> surfaces_;
  sim::SearchScratch scratch_;
};

/// Throws std::invalid_argument for an estimator that needs all its rays at once, or none.
void require_batches(sim::Estimator estimator);

/// Weights of the job's discs for errors: the area around the scene's samples (area_weights), else the discs' own.
[[nodiscard]] std::vector<double> weights_of(const Job& job, Surfaces surfaces = Surfaces::without_mirrors);

}  // namespace detp::validate
