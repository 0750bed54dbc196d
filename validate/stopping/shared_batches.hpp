#pragma once

#include <deque>
#include <nlohmann/json.hpp>

#include "detp/model/techniques/registry.hpp"
#include "detp/sim/ranks/farm.hpp"
#include "execute_until.hpp"
#include "job_batches.hpp"

/// Runs in batches of rays: as JSON, for a CheckpointFile or another process, and shared by ranks.
namespace detp::validate {

struct SavedRun {
  Candidate candidate;
  UntilState state;
  ExecutedUntil so_far;  ///< hits, counts and seconds; no result
};

[[nodiscard]] nlohmann::json json_of(const Candidate& candidate, const UntilState& state, const ExecutedUntil& so_far);

/// Throws nlohmann::json::exception or std::invalid_argument unless the JSON is that of json_of.
[[nodiscard]] SavedRun saved_run_of(const nlohmann::json& json);

/// To be sent to another process.
[[nodiscard]] std::string bytes_of(const FoundBatch& found);
[[nodiscard]] FoundBatch found_batch_of(const std::string& bytes);

/// Makes and searches the batches of a job: those that will follow one another on different ranks at the same time. The batches do not depend on the
/// number of ranks. The job's own rays are searched on rank 0.
class SharedBatches {
 public:
  /// Keeps references to job and search, which are the same on all ranks. `ranks`: null for this process alone.
  SharedBatches(const Job& job, JobSearch& search, std::stop_token stop, sim::Ranks* ranks, BandInQuestion band = {});

  /// As JobBatches.
  void skip(std::uint64_t batches, double photons, std::uint64_t rays) { rays_.skip(batches, photons, rays); }
  /// On rank 0; as FindBatch.
  [[nodiscard]] std::optional<FoundBatch> next(std::uint64_t rays, std::uint64_t following);
  /// On rank 0. Throws sim::RankFailed if another rank has died: a stop request may have come from its launcher.
  void roll_call();
  /// On the other ranks. Returns when rank 0 needs no more.
  void serve() { farm_->serve(); }

 private:
  [[nodiscard]] std::optional<FoundBatch> next_here(std::uint64_t rays);
  [[nodiscard]] std::string find(const std::string& task);

  JobSearch& search_;
  JobBatches rays_;
  BandInQuestion band_;
  std::size_t at_once_ = 1;
  std::deque<FoundBatch> ahead_;
  sim::Farm::Work work_;
  std::optional<sim::Farm> farm_;
};

}  // namespace detp::validate
