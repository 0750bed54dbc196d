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
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

namespace detp::validate {
namespace {

/// A technique of ours is left out if its predicted time exceeds this many times our shortest predicted time.
constexpr double hopeless = 30;
/// The largest product of rays and discs for which brute force determines the right hits.
constexpr double checkable = 2e7;

struct Contenders {
  std::vector<Candidate> candidates;  ///< shortest predicted time first; empty if none fits in memory
  double hits = 0;                    ///< expected number of hits, by the closed forms
};

/// The exact techniques, or only the exact techniques in `named` if it is not empty. Each has the parameters with the
/// shortest predicted time. Techniques without a closed form come last, with default parameters. Hopeless ones are left out.
Contenders contenders(const Workload& workload, std::span<const Technique> named) {
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

constexpr double share_of_job = 0.1;  ///< rough share of a workload's time for making scene and rays

class Benchmark {
 public:
  Benchmark(std::span<const BenchWorkload> workloads, const BenchOptions& options)
      : workloads_(workloads), options_(options) {
    if (!options.instruction_set.empty()) only_.emplace(options.instruction_set);
    if (options.embree_modes.empty()) return;
    for (const int threads : options.threads)
      peers_.try_emplace(threads, std::make_unique<EmbreePeer>(threads, options.instruction_set));
  }

  BenchResult run_all() && {
    BenchResult result;
    static_cast<SetProgress&>(result) = run_each(
        workloads_,
        [&](std::size_t i, const sim::ReportPhase& progress) {
          if (i == 0 || !same_but_rays(workloads_[i - 1], workloads_[i])) hits_per_ray_ = 0;
          return run(workloads_[i], progress);
        },
        options_.race.stop, options_.race.progress);
    result.entries = std::move(entries_);
    return result;
  }

 private:
  /// The progress of one part of a workload, such as "@tree 10000 rays, races".
  [[nodiscard]] static sim::ReportPhase part(const sim::ReportPhase& progress, const BenchWorkload& workload,
                                             std::string_view what, double from, double to) {
    return titled(sim::part_of(progress, from, to),
                  fmt::format("{} {:g} rays, {}", workload.scene, workload.rays, what));
  }

  /// Why the workload is skipped if more than most_hits hits are expected; else nothing. `expected` comes from a run with fewer rays, or
  /// from the model.
  [[nodiscard]] std::string too_many_hits(double expected) const {
    return expected <= options_.most_hits
               ? ""
               : fmt::format("{:.1e} hits expected, more than {:g}", expected, options_.most_hits);
  }

  std::string run(const BenchWorkload& workload, const sim::ReportPhase& progress) {
    if (std::string why = too_many_hits(hits_per_ray_ * workload.rays); !why.empty()) return why;
    const Job job = make_bench_job(workload, options_.seed, options_.race.stop,
                                   part(progress, workload, "making rays", 0, share_of_job));
    const Contenders ours = contenders(job.workload(), options_.techniques);
    if (ours.candidates.empty()) return "none of the techniques named fits in memory on it";
    if (hits_per_ray_ == 0)
      if (std::string why = too_many_hits(ours.hits); !why.empty()) {
        hits_per_ray_ = ours.hits / workload.rays;
        return why;
      }
    run_races(workload, job, ours.candidates, part(progress, workload, "races", share_of_job, 1));
    return "";
  }

  void run_races(const BenchWorkload& workload, const Job& job, const std::vector<Candidate>& ours,
                 const sim::ReportPhase& progress) {
    if (progress) progress({"right hits", 0, 0});
    const RightHits right = right_hits(job, ours.front(), checkable, options_.race.stop);
    const auto sum = std::accumulate(right.hits.begin(), right.hits.end(), std::uint64_t{0});
    hits_per_ray_ = static_cast<double>(sum) / workload.rays;
    std::vector<Competitor> competitors(ours.begin(), ours.end());
    competitors.insert(competitors.end(), options_.embree_modes.begin(), options_.embree_modes.end());
    if (options_.race.costs && sim::PilotedDiscs::can_pilot(job.problem())) competitors.emplace_back(OwnChoice{});
    double before = 0;
    for (const int threads : options_.threads) {
      const double after = before + 1.0 / static_cast<double>(options_.threads.size());
      RaceOptions how = options_.race;
      how.threads = threads;
      how.progress = sim::part_of(progress, before, after);
      before = after;
      Race found = race(job, right, peers_.empty() ? nullptr : peers_.at(threads).get(), competitors, how);
      const bool complete = found.complete;
      if (!found.results.empty())
        entries_.push_back({workload, job.given.samples, job.given.disc_radius, threads, sim::stream::instruction_set(),
                            right.judge, std::move(found)});
      if (!complete) throw sim::Stopped("stopped during a race");
    }
  }

  std::span<const BenchWorkload> workloads_;
  const BenchOptions& options_;
  std::optional<sim::stream::OnlyInstructionSet> only_;
  std::map<int, std::unique_ptr<EmbreePeer>> peers_;
  std::vector<BenchEntry> entries_;
  double hits_per_ray_ = 0;
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

std::optional<double> BenchEntry::ratio(Ours ours) const {
  const CompetitorResult* own = ours == Ours::best ? best(true) : choice();
  const CompetitorResult* peer = best(false);
  if (!race.complete || own == nullptr || peer == nullptr) return std::nullopt;
  return peer->median_seconds() / own->median_seconds();
}

BenchResult run_bench(std::span<const BenchWorkload> workloads, const BenchOptions& options) {
  return Benchmark(workloads, options).run_all();
}

std::vector<EmbreeMode> best_embree_modes() {
  std::vector<EmbreeMode> best{{EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::low, false},
                               {EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::medium, false},
                               {EmbreeQuery::occluded, EmbreeRays::one, EmbreeQuality::high, false},
                               {EmbreeQuery::occluded, EmbreeRays::packet_8, EmbreeQuality::medium, false},
                               {EmbreeQuery::occluded, EmbreeRays::stream_of_packets, EmbreeQuality::low, false},
                               {EmbreeQuery::intersect, EmbreeRays::one, EmbreeQuality::medium, false}};
  const std::vector<EmbreeMode> all = all_embree_modes();
  std::erase_if(best, [&](const EmbreeMode& mode) { return std::ranges::find(all, mode) == all.end(); });
  return best;
}

}  // namespace detp::validate
