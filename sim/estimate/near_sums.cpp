#include "near_sums.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/irradiance.hpp"

namespace detp::sim {
namespace {

/// The sums of one disc.
struct DiscSums {
  PhotonSums photons;
  double power = 0;
  double area = 0;
  double most_weight = 0;
  bool done = false;
};

/// Reports the share of the discs that are done, from any thread.
class DiscProgress {
 public:
  DiscProgress(const RunOptions& options, std::size_t discs) : options_(options), discs_(discs) {}

  void done() {
    const std::size_t before = done_++;
    if (!options_.progress || before % 64 != 0) return;
    const std::lock_guard lock(one_at_a_time_);
    options_.progress(static_cast<double>(done_ - 1) / static_cast<double>(discs_));
  }

 private:
  const RunOptions& options_;
  std::size_t discs_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex one_at_a_time_;
};

/// Adds the landings of one disc, which are brought into the order of their rays.
void add(const Problem& problem, Near& near, bool errors, DiscSums& sums) {
  const double unit = std::ldexp(1.0, unit_exponent(problem.largest_power()));
  std::ranges::sort(near.landed, {}, &Landed::ray);
  for (const Landed& one : near.landed) {
    const double power = one.weight * problem.rays()[one.ray].power;
    sums.power += power;
    sums.most_weight = std::max(sums.most_weight, one.weight);
    if (errors) sums.photons.add(problem.photon(one.ray), 0, power, unit);
  }
  sums.photons.close(unit);
  sums.area = near.area;
  sums.done = true;
}

/// Largest power of one photon at any disc, whatever the discs' weights.
double heaviest(std::span<const DiscSums> all, double largest_power) {
  for (const DiscSums& one : all)
    if (one.most_weight > 0) largest_power = std::max(largest_power, one.photons.largest / one.most_weight);
  return largest_power;
}

}  // namespace

double near_bytes(const Problem& problem, const RunOptions& options) {
  constexpr double results = sizeof(std::uint64_t) + sizeof(double);
  const double errors = options.standard_error ? 2 * sizeof(double) : 0;
  return static_cast<double>(problem.discs().size()) * (sizeof(DiscSums) + results + errors);
}

void sum_near(const Problem& problem, const RunOptions& options,
              const std::function<void(std::uint32_t disc, Near& near)>& find, Outcome& outcome) {
  constexpr std::size_t discs_at_once = 128;
  const std::size_t discs = problem.discs().size();
  std::vector<DiscSums> sums(discs);
  resize_results(discs, options.standard_error, outcome);
  DiscProgress progress(options, discs);
  const std::size_t chunks = (discs + discs_at_once - 1) / discs_at_once;
  on_threads(thread_count(options.threads), [&] {
    parallel_for(ParallelRange(0, chunks, 1), [&](const ParallelRange& part) {
      Near near;
      for (std::size_t chunk = part.begin(); chunk != part.end(); ++chunk)
        for (std::size_t i = chunk * discs_at_once; i < std::min(discs, (chunk + 1) * discs_at_once); ++i) {
          if (options.stop.stop_requested()) return;
          progress.done();
          near.clear();
          find(static_cast<std::uint32_t>(i), near);
          outcome.hits[i] = near.landed.size();
          add(problem, near, options.standard_error, sums[i]);
        }
    });
  });
  const double heaviest_power = heaviest(sums, problem.largest_power());
  const auto photons = static_cast<double>(problem.photons_to());
  outcome.stopped = false;
  for (std::size_t i = 0; i < discs; ++i) {
    const DiscSums& one = sums[i];
    outcome.stopped = outcome.stopped || !one.done;
    outcome.total_hits += outcome.hits[i];
    outcome.irradiance[i] = one.area > 0 ? one.power / one.area : 0;
    if (!options.standard_error) continue;
    const double weight = one.most_weight > 0 ? one.most_weight : 1;
    const ErrorSums sums_of_squares{one.photons.squares.x, one.photons.largest, one.photons.photons,
                                    unit_exponent(problem.largest_power())};
    const PowerError error = error_of_power(one.power, sums_of_squares, weight * heaviest_power, photons);
    outcome.standard_error[i] = one.area > 0 ? error.standard_error / one.area : unbounded;
    outcome.upper_bound[i] = one.area > 0 ? error.upper_bound / one.area : unbounded;
  }
  outcome.counts.hits = outcome.total_hits;
  outcome.progress = {problem.rays().size(), problem.rays().size()};
  if (!outcome.stopped) return;
  outcome.done_discs.resize(discs);
  for (std::size_t i = 0; i < discs; ++i) outcome.done_discs[i] = sums[i].done;
  outcome.standard_error.clear();
  outcome.upper_bound.clear();
  keep_done_discs(outcome);
}

}  // namespace detp::sim
