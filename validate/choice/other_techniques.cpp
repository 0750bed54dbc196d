#include "other_techniques.hpp"

#include <algorithm>
#include <cmath>

#include "allowed_ranking.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/sim/effects/observe.hpp"

namespace detp::validate {
namespace {

/// The least counts with which any technique can find the hits, other than brute force.
Counts<double> least_counts(const SearchSize& size, double hits) {
  return {.loaded = size.rays,
          .segments = size.segments ? size.rays : 0,
          .visits = size.discs,
          .disc_tests = hits,
          .placements = size.discs,
          .sorted = size.discs,
          .hits = hits};
}

class Comparison {
 public:
  Comparison(const sim::Problem& problem, const SearchSize& size, const Prices& prices, const PilotOptions& options,
             PilotChoice& found)
      : problem_(problem),
        size_(size),
        prices_(prices),
        options_(options),
        found_(found),
        least_(least_counts(size, found.choice().counts.hits)) {}

  void compare(Technique technique) {
    const double at_least = prices_(least_, technique).time.total();
    if (at_least >= best()) return found_.ruled_out.push_back({technique, at_least, true});
    if (!model::has_closed_form(technique) || !can_measure() || !(options_.all_closed_forms || worth_finding()))
      return found_.unexamined.push_back(technique);
    const model::SearchLimits limits{.threads = prices_.most_threads,
                                     .stop = options_.stop,
                                     .fastest = closed_form_doubt * best() * prices_.most_threads};  // on one thread
    const auto tuned = model::best_of(technique, workload(), prices_.costs, limits);
    if (!tuned) return found_.unexamined.push_back(technique);
    const double seconds = tuned->time.total();
    if (seconds >= closed_form_doubt * best()) return found_.ruled_out.push_back({technique, seconds, false});
    found_.candidates.push_back({.candidate = tuned->candidate,
                                 .counts = tuned->counts,
                                 .time = tuned->time,
                                 .threads = tuned->threads,
                                 .error = seconds * (closed_form_doubt - 1),
                                 .closed_form = true,
                                 .extrapolated = tuned->extrapolated});
  }

 private:
  [[nodiscard]] double best() const { return found_.choice().time.total(); }
  [[nodiscard]] bool can_measure() const { return options_.workload || !problem_.rays().empty(); }

  /// Whether closed forms, and the measurements that they need, take less than some 2 % of the best.
  [[nodiscard]] bool worth_finding() const { return best() > 50 * 0.0025; }

  const Workload& workload() {
    if (!workload_) {
      workload_ = options_.workload ? *options_.workload : sim::observe(problem_, {}, {}, options_.stop).workload;
      workload_->rays = size_.rays;
    }
    return *workload_;
  }

  const sim::Problem& problem_;
  SearchSize size_;
  const Prices& prices_;
  const PilotOptions& options_;
  PilotChoice& found_;
  Counts<double> least_;
  std::optional<Workload> workload_;
};

}  // namespace

Piloted priced(const Candidate& candidate, const Counts<double>& counts, const Counts<double>& error,
               const Prices& prices) {
  const auto [threads, time] = prices(counts, candidate.technique);
  Counts<double> more = counts;
  more += error;
  const double of_counts = price(more, prices.costs, candidate.technique, threads).total() - time.total();
  return {
      .candidate = candidate,
      .counts = counts,
      .time = time,
      .threads = threads,
      .error = std::hypot(
          of_counts, static_cast<const CostTable&>(prices.costs).relative_error_of(candidate.technique) * time.total()),
      .counts_error = error};
}

bool is_allowed(Technique technique, const PilotOptions& options) {
  return std::find(options.disabled.begin(), options.disabled.end(), technique) == options.disabled.end();
}

void compare_others(const sim::Problem& problem, const SearchSize& size, const Prices& prices,
                    const PilotOptions& options, PilotChoice& found) {
  Comparison comparison(problem, size, prices, options, found);
  for (const TechniqueRecord& record : technique_records)
    if (record.exact && record.technique != Technique::box_tree && record.technique != Technique::brute_force &&
        is_allowed(record.technique, options))
      comparison.compare(record.technique);
}

}  // namespace detp::validate
