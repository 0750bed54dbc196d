#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "detp/model/ranks/ranks.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/job/job.hpp"

/// `detp choose --ranks`: what processes that share a run take.
namespace detp::cli {

struct RanksOptions {
  std::optional<double> ranks;
  double bytes_per_second = model::Network{}.bytes_per_second;
};

/// The time for making all rays and checking them, from some of them.
struct MakingTime {
  double seconds = 0;
  double error = 0;  ///< standard error
};

/// Times further rays of a job, which has its scene if they are photon paths. Throws std::invalid_argument for rays of a file.
[[nodiscard]] MakingTime making_time(const validate::Job& job, const std::stop_token& stop);
/// Times lines, as many as a workload has.
[[nodiscard]] MakingTime making_time(const Workload& workload, std::uint64_t seed, const std::stop_token& stop);

struct RanksAnswer {
  double ranks = 1;
  model::Network network;
  bool by_rays = true;  ///< what is chosen
  bool fits = true;     ///< in a rank's memory
  double memory_limit = 0;
  model::SharedTime rays;
  model::SharedTime discs;
  double alone = 0;  ///< seconds of one process
  double error =
      0;  ///< of the chosen time, as far as it is known: the prediction's of the search, the standard error of making rays

  [[nodiscard]] const model::SharedTime& best() const { return by_rays ? rays : discs; }
};

/// `search_error`: of the predicted seconds. `costs`: of the predicted technique. Chooses the faster of those that fit in memory.
[[nodiscard]] RanksAnswer choose_ranks(const RanksOptions& options, const Workload& workload, double photons_per_ray,
                                       bool photon_paths, double triangles, const Prediction& prediction,
                                       double search_error, const MakingTime& making, const UnitCosts& costs);

[[nodiscard]] Json to_json(const RanksAnswer& answer);
[[nodiscard]] std::string ranks_line(const RanksAnswer& answer);

}  // namespace detp::cli
