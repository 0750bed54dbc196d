#include "bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/tree_search.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

namespace detp::validate {
namespace {

struct Contenders {
  std::vector<Candidate> candidates;  ///< shortest predicted time first; empty if none fits in memory
  double hits = 0;                    ///< expected number of hits, by the closed forms
};

/// The exact techniques, or only the exact techniques in `named` if it is not empty. Each has the parameters with the
/// shortest predicted time. Techniques without a closed form come last, with default parameters. Leaves out candidates
/// whose predicted time exceeds `hopeless` times that of the first.
Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless) {
  const auto wanted = [&](Technique technique) {
    return named.empty() || std::find(named.begin(), named.end(), technique) != named.end();
  };
  std::vector<Prediction> ranking = model::rank(workload, built_in_unit_costs());
  Contenders found{.candidates = {}, .hits = ranking.front().counts.hits};
  std::erase_if(ranking, [&](const Prediction& ranked) { return !wanted(ranked.candidate.technique); });
  for (const Prediction& ranked : ranking)
    if (ranked.time.total() <= hopeless * ranking.front().time.total()) found.candidates.push_back(ranked.candidate);
  for (const Technique technique : exact_techniques)
    if (wanted(technique) && !model::has_closed_form(technique))
      found.candidates.push_back(default_candidate(technique));
  return found;
}

JobRequest request_of(const BenchWorkload& workload, std::uint64_t seed) {
  JobRequest request;
  request.scene = workload.path;
  request.field = workload.field;
  request.samples = workload.samples;
  request.disc_radius = workload.disc_radius;
  request.rays = workload.rays;
  request.seed = seed;
  return request;
}

/// Roughly proportional to the time of the workload.
double effort(const BenchWorkload& workload) { return workload.rays + 3e4; }

constexpr double share_of_job = 0.1;  ///< rough share of a workload's time for making scene and rays

class Benchmark {
 public:
  Benchmark(std::span<const BenchWorkload> workloads, const BenchOptions& options)
      : workloads_(workloads), options_(options) {
    result_.workloads = workloads.size();
    if (!options.instruction_set.empty()) only_.emplace(options.instruction_set);
    for (const int threads : options.threads)
      peers_.try_emplace(threads, std::make_unique<EmbreePeer>(threads, options.instruction_set));
  }

  BenchResult run_all() {
    for (std::size_t i = 0; i < workloads_.size() && !options_.stop.stop_requested(); ++i) {
      if (i == 0 || !same_but_rays(workloads_[i - 1], workloads_[i])) hits_per_ray_ = 0;
      progress_ = progress_of(i);
      const std::size_t skipped = result_.skipped.size();
      try {
        if (run(workloads_[i])) ++result_.done;
        if (result_.skipped.size() == skipped) effort_done_ += effort(workloads_[i]);
      } catch (const sim::Stopped&) {  // stopped while making rays
      }
    }
    result_.stopped = result_.done < workloads_.size();
    return std::move(result_);
  }

 private:
  /// The progress callback for workload number `place`. Expects that each remaining workload takes a time proportional
  /// to its effort(), at the speed so far.
  [[nodiscard]] sim::ReportPhase progress_of(std::size_t place) const {
    const double done = watch_.seconds();
    const double speed = effort_done_ > 0 ? done / effort_done_ : 1;
    double later = 0;
    for (std::size_t i = place; i < workloads_.size(); ++i) later += speed * effort(workloads_[i]);
    const double whole = effort_done_ > 0 ? done + later : later;
    const double before = effort_done_ > 0 ? done : 0;
    return sim::part_of(options_.progress, before / whole, (before + speed * effort(workloads_[place])) / whole);
  }

  /// The progress callback for one part of a workload, such as "@tree 10000 rays, races".
  [[nodiscard]] sim::ReportPhase part(const BenchWorkload& workload, std::string what, double from, double to) const {
    if (!progress_) return {};
    return [part = sim::part_of(progress_, from, to),
            title = fmt::format("{} {:g} rays, {}", workload.scene, workload.rays, what)](sim::Phase phase) {
      phase.what = fmt::format("{}: {}", title, phase.what);
      part(phase);
    };
  }

  /// If more than most_hits hits are expected, notes that the workload is skipped, and returns true. `expected` comes
  /// from a run with fewer rays, or from the model.
  bool too_many_hits(const BenchWorkload& workload, double expected) {
    if (expected <= options_.most_hits) return false;
    result_.skipped.push_back(
        {workload, fmt::format("{:.1e} hits expected, more than {:g}", expected, options_.most_hits)});
    return true;
  }

  /// Returns false if a stop request ended the races.
  bool run(const BenchWorkload& workload) {
    if (too_many_hits(workload, hits_per_ray_ * workload.rays)) return true;
    const Job job =
        make_job(request_of(workload, options_.seed), options_.stop, part(workload, "making rays", 0, share_of_job));
    const Contenders ours = contenders(job.workload(), options_.techniques, options_.hopeless);
    if (ours.candidates.empty()) {
      result_.skipped.push_back({workload, "none of the techniques named fits in memory on it"});
      return true;
    }
    if (hits_per_ray_ == 0 && too_many_hits(workload, ours.hits)) {
      hits_per_ray_ = ours.hits / workload.rays;
      return true;
    }
    const auto races = part(workload, "races", share_of_job, 1);
    if (races) races({"right hits", 0, 0});
    const auto right = right_hits(job, ours.candidates.front(), options_.checkable, options_.stop);
    if (!right) return false;
    const auto sum = std::accumulate(right->hits.begin(), right->hits.end(), std::uint64_t{0});
    hits_per_ray_ = static_cast<double>(sum) / workload.rays;
    std::vector<Competitor> competitors(ours.candidates.begin(), ours.candidates.end());
    competitors.insert(competitors.end(), options_.embree_modes.begin(), options_.embree_modes.end());
    if (options_.costs && sim::PilotedDiscs::can_pilot(job.problem())) competitors.emplace_back(OwnChoice{});
    double before = 0;
    for (const int threads : options_.threads) {
      const double after = before + 1.0 / static_cast<double>(options_.threads.size());
      const RaceOptions how{.repeats = options_.repeats,
                            .most_seconds = options_.most_seconds,
                            .threads = threads,
                            .costs = options_.costs.value_or(CostTable{}),
                            .stop = options_.stop,
                            .progress = sim::part_of(races, before, after)};
      before = after;
      Race found = race(job, *right, *peers_.at(threads), competitors, how);
      const bool complete = found.complete;
      if (!found.results.empty())
        result_.entries.push_back({workload, job.given.samples, job.given.disc_radius, threads,
                                   sim::stream::instruction_set(), right->judge, std::move(found)});
      if (!complete) return false;
    }
    return true;
  }

  std::span<const BenchWorkload> workloads_;
  const BenchOptions& options_;
  std::optional<sim::stream::OnlyInstructionSet> only_;
  std::map<int, std::unique_ptr<EmbreePeer>> peers_;
  BenchResult result_;
  double hits_per_ray_ = 0;
  sim::Stopwatch watch_;
  double effort_done_ = 0;     ///< sum of effort() over the workloads that were run
  sim::ReportPhase progress_;  ///< progress callback of the current workload
};

}  // namespace

const CompetitorResult* BenchEntry::best(bool ours) const {
  const CompetitorResult* fastest = nullptr;
  for (const CompetitorResult& competitor_result : race.results)
    if ((ours ? is_own_technique : is_embree)(competitor_result.competitor) &&
        (fastest == nullptr || competitor_result.median_seconds() < fastest->median_seconds()))
      fastest = &competitor_result;
  return fastest;
}

const CompetitorResult* BenchEntry::choice() const {
  for (const CompetitorResult& result : race.results)
    if (std::holds_alternative<OwnChoice>(result.competitor)) return &result;
  return nullptr;
}

double BenchEntry::ratio() const { return embree_over(best(true)); }

double BenchEntry::choice_ratio() const { return embree_over(choice()); }

double BenchEntry::embree_over(const CompetitorResult* ours) const {
  const CompetitorResult* peer = best(false);
  if (!race.complete || ours == nullptr || peer == nullptr) return 0;
  return peer->median_seconds() / ours->median_seconds();
}

BenchResult run_bench(std::span<const BenchWorkload> workloads, const BenchOptions& options) {
  return Benchmark(workloads, options).run_all();
}

std::vector<EmbreeMode> best_embree_modes() {
  return {{EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::low, false},
          {EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::medium, false},
          {EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::high, false},
          {EmbreeQuery::occluded, EmbreeRays::packet_8, EmbreeQuality::medium, false},
          {EmbreeQuery::occluded, EmbreeRays::stream_of_packets, EmbreeQuality::low, false},
          {EmbreeQuery::intersect, EmbreeRays::one, EmbreeQuality::medium, false}};
}

}  // namespace detp::validate
