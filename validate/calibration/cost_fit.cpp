#include "cost_fit.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "detp/validate/statistics/non_negative_fit.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

using Terms = std::vector<const UnitCostTerm*>;

constexpr UnitCosts no_costs = [] {
  UnitCosts costs;
  for (const UnitCostTerm& term : unit_cost_terms) costs.*term.cost = 0;
  return costs;
}();

CostEngine engine_of(Technique technique) {
  return record_of(technique).ray_by_ray ? CostEngine::ray_by_ray : CostEngine::lists;
}

bool occurs(const UnitCostTerm& term, std::span<const TimedRun> runs) {
  return std::any_of(runs.begin(), runs.end(), [&](const auto& run) { return term.quantity(run.counts) > 0; });
}

/// The terms whose counts occur in the runs. Of terms with the same counts in all runs, only the first.
Terms occurring_terms(std::span<const TimedRun> runs, Technique technique) {
  Terms terms;
  for (const UnitCostTerm& term : unit_cost_terms) {
    if (term.engine != CostEngine::both && term.engine != engine_of(technique)) continue;
    const bool known = std::any_of(terms.begin(), terms.end(), [&](const UnitCostTerm* other) {
      return std::all_of(runs.begin(), runs.end(),
                         [&](const auto& run) { return term.quantity(run.counts) == other->quantity(run.counts); });
    });
    if (occurs(term, runs) && !known) terms.push_back(&term);
  }
  return terms;
}

/// What of the term's quantity belongs to the seconds for sorting and building. (Discs that no near cache holds slow the search, too.)
double quantity_of_building(const UnitCostTerm& term, const Counts<double>& counts) {
  if (term.cost == &UnitCosts::far)
    return far_discs({.references = counts.references, .placements = counts.placements, .sorted = counts.sorted});
  return term.part == &CostBreakdown::order || term.part == &CostBreakdown::build ? term.quantity(counts) : 0;
}

/// Costs that are expected, on this machine, where nothing else is known. 0: nothing is expected.
UnitCosts expected_costs(std::span<const TimedRun> runs, Technique technique, const std::optional<UnitCosts>& usual) {
  if (!usual) return no_costs;
  std::vector<double> slower;
  for (const TimedRun& run : runs) {
    const double seconds = price(run.counts, *usual, technique).total();
    if (seconds > 0) slower.push_back(run.seconds / seconds);
  }
  if (slower.empty()) return no_costs;
  const double factor = median(std::move(slower));
  UnitCosts expected = *usual;
  for (const UnitCostTerm& term : unit_cost_terms) expected.*term.cost *= factor;
  return expected;
}

/// The equations whose squared errors the fit minimises.
struct Equations {
  std::vector<double> left;  ///< row by row: the factor of each cost
  std::vector<double> right;

  void add(std::span<const double> row, double sum) {
    left.insert(left.end(), row.begin(), row.end());
    right.push_back(sum);
  }
};

Equations equations_of(std::span<const TimedRun> runs, const Terms& terms, const UnitCosts& expected) {
  Equations equations;
  std::vector<double> row(terms.size());
  const auto add_shares = [&](const TimedRun& run, double seconds, bool only_building) {
    for (std::size_t i = 0; i < terms.size(); ++i)
      row[i] = (only_building ? quantity_of_building(*terms[i], run.counts) : terms[i]->quantity(run.counts)) / seconds;
    if (std::any_of(row.begin(), row.end(), [](double share) { return share > 0; })) equations.add(row, 1);
  };
  for (const TimedRun& run : runs) {
    add_shares(run, run.seconds, false);
    if (run.build_seconds > 0) add_shares(run, run.build_seconds, true);
  }
  const double weight = std::sqrt(weight_of_usual);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double usual = expected.*terms[i]->cost;
    if (!(usual > 0)) continue;
    std::fill(row.begin(), row.end(), 0);
    row[i] = weight / usual;
    equations.add(row, weight);
  }
  return equations;
}

UnitCosts fit(std::span<const TimedRun> runs, const Terms& terms, const UnitCosts& expected) {
  const Equations equations = equations_of(runs, terms, expected);
  const std::vector<double> x = non_negative_fit(equations.left, terms.size(), equations.right);
  UnitCosts costs = no_costs;
  for (std::size_t i = 0; i < terms.size(); ++i) costs.*terms[i]->cost = x[i];
  return costs;
}

Terms positive_terms(const Terms& terms, const UnitCosts& costs) {
  Terms positive;
  for (const UnitCostTerm* term : terms)
    if (costs.*term->cost > 0) positive.push_back(term);
  return positive;
}

struct Separation {
  double condition;           ///< ratio of the largest to the smallest singular value of the terms' columns
  Terms hardest_to_separate;  ///< terms with a large component in the singular vector of the smallest singular value
};

Separation separation(std::span<const TimedRun> runs, const Terms& terms, const UnitCosts& expected) {
  constexpr double large = 0.3;
  const Equations equations = equations_of(runs, terms, expected);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd matrix =
      Eigen::Map<const Rows>(equations.left.data(), static_cast<Eigen::Index>(equations.right.size()),
                             static_cast<Eigen::Index>(terms.size()));
  matrix.colwise().normalize();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinV);
  const auto last = static_cast<Eigen::Index>(terms.size()) - 1;
  Separation found{svd.singularValues()[0] / svd.singularValues()[last], {}};
  for (std::size_t j = 0; j < terms.size(); ++j)
    if (std::abs(svd.matrixV()(static_cast<Eigen::Index>(j), last)) >= large)
      found.hardest_to_separate.push_back(terms[j]);
  return found;
}

/// The term that contributes the smallest share of the runs' times, summed over the runs.
const UnitCostTerm* smallest_term(std::span<const TimedRun> runs, const Terms& terms, const UnitCosts& costs) {
  const auto share = [&](const UnitCostTerm* term) {
    double sum = 0;
    for (const TimedRun& run : runs) sum += term->quantity(run.counts) * costs.*term->cost / run.seconds;
    return sum;
  };
  return *std::min_element(terms.begin(), terms.end(),
                           [&](const auto* a, const auto* b) { return share(a) < share(b); });
}

std::vector<double> relative_errors(std::span<const TimedRun> runs, const UnitCosts& costs, Technique technique) {
  std::vector<double> errors;
  for (const TimedRun& run : runs)
    errors.push_back(std::abs(price(run.counts, costs, technique).total() / run.seconds - 1));
  return errors;
}

/// The fit of the terms that the runs can tell apart; adds the others to `dropped`.
UnitCosts fit_separable(std::span<const TimedRun> runs, Terms terms, const UnitCosts& expected, CostFit& result) {
  for (;;) {
    const UnitCosts costs = fit(runs, terms, expected);
    const Terms positive = positive_terms(terms, costs);
    const Separation separated = separation(runs, positive, expected);
    result.condition = separated.condition;
    if (result.condition <= largest_condition || positive.size() == 1) {
      for (const UnitCostTerm* term : positive) result.fitted.push_back(term->symbol);
      return costs;
    }
    const UnitCostTerm* const smallest = smallest_term(runs, separated.hardest_to_separate, costs);
    result.dropped.push_back(smallest->symbol);
    std::erase(terms, smallest);
  }
}

constexpr std::size_t thread_unknowns = 3;  // the members of ThreadCosts, in their order

class ThreadFitter {
 public:
  ThreadFitter(Technique technique, Engine engine, const std::optional<ThreadCosts>& usual)
      : technique_(technique), engine_(engine), usual_(usual) {}

  [[nodiscard]] ThreadCosts fit(std::span<const ThreadedRun> runs) const {
    std::vector<double> rows;
    std::vector<double> right;
    for (const ThreadedRun& run : runs) {
      const Pieces pieces = pieces_of(run.counts, technique_, engine_);
      const double preparing = run.one_preparing / busy_threads(pieces.preparing, run.threads);
      const double search = (run.one_seconds - run.one_preparing) / busy_threads(pieces.search, run.threads);
      const double more_preparing = run.one_preparing - preparing;  // if nothing ran in parallel
      const double more_search = run.one_seconds - run.one_preparing - search;
      const auto add = [&](double measured, double least, double p, double s, double a) {
        for (const double one : {p, s, a}) rows.push_back(one / measured);
        right.push_back((measured - least) / measured);
      };
      const bool divided = more_preparing > 0 || more_search > 0;
      add(run.seconds, preparing + search, more_preparing, more_search, divided ? run.threads - 1 : 0);
      if (run.preparing > 0 && more_preparing > 0) add(run.preparing, preparing, more_preparing, 0, 0);
    }
    std::array<bool, thread_unknowns> divided{};
    for (std::size_t i = 0; i < rows.size(); ++i) divided[i % thread_unknowns] |= rows[i] > 0;
    if (usual_) add_usual(rows, right);
    const std::vector<double> x = non_negative_fit(rows, thread_unknowns, right);
    const auto share = [&](std::size_t column) { return divided[column] ? std::min(1.0, x[column]) : 1.0; };
    return {.serial_preparing = share(0), .serial_search = share(1), .start = x[2]};
  }

  [[nodiscard]] std::vector<double> errors(std::span<const ThreadedRun> runs, const ThreadCosts& costs) const {
    std::vector<double> all;
    for (const ThreadedRun& run : runs) {
      const CostBreakdown one{.build = run.one_preparing, .intersect = run.one_seconds - run.one_preparing};
      const Pieces pieces = pieces_of(run.counts, technique_, engine_);
      all.push_back(std::abs(on_threads(one, pieces, costs, run.threads).total() / run.seconds - 1));
    }
    return all;
  }

 private:
  void add_usual(std::vector<double>& rows, std::vector<double>& right) const {
    const double weight = std::sqrt(weight_of_usual);
    const std::array usual{usual_->serial_preparing, usual_->serial_search, usual_->start};
    for (std::size_t i = 0; i < thread_unknowns; ++i) {
      const double scale = i == 2 ? usual_->start : 1;
      if (!(scale > 0)) continue;
      for (std::size_t j = 0; j < thread_unknowns; ++j) rows.push_back(i == j ? weight / scale : 0);
      right.push_back(weight * usual[i] / scale);
    }
  }

  Technique technique_;
  Engine engine_;
  std::optional<ThreadCosts> usual_;
};

/// The errors of runs by fits without them: errors(fitted, left out) of five divisions, each of which leaves out the workloads whose number
/// has one remainder modulo 5.
template <class Run, class Errors>
std::vector<double> errors_left_out(std::span<const Run> runs, const Errors& errors) {
  constexpr std::size_t parts = 5;
  std::vector<double> all;
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<Run> fitted;
    std::vector<Run> left_out;
    for (const Run& run : runs) (run.workload % parts == part ? left_out : fitted).push_back(run);
    if (fitted.empty()) continue;
    const std::vector<double> of_part = errors(fitted, left_out);
    all.insert(all.end(), of_part.begin(), of_part.end());
  }
  return all;
}

}  // namespace

double FitQuality::left_out_median_error() const { return median(left_out_errors); }

CostFit fit_costs(std::span<const TimedRun> runs, Technique technique, const std::optional<UnitCosts>& usual,
                  Engine engine) {
  constexpr std::size_t least_runs = 10;
  if (runs.size() < least_runs)
    throw std::invalid_argument(fmt::format("a fit of unit costs takes at least {} runs of {} (got {})", least_runs,
                                            name(technique), runs.size()));
  for (const TimedRun& run : runs) require_positive("seconds of a run", run.seconds);
  CostFit result{{.technique = technique, .engine = engine, .runs = runs.size()}, no_costs};
  const Terms terms = occurring_terms(runs, technique);
  const UnitCosts expected = expected_costs(runs, technique, usual);
  result.costs = fit_separable(runs, terms, expected, result);
  for (const UnitCostTerm& term : unit_cost_terms)
    if (!occurs(term, runs)) result.costs.*term.cost = expected.*term.cost;
  result.median_error = median(relative_errors(runs, result.costs, technique));
  const Terms fitted = positive_terms(terms, result.costs);
  result.left_out_errors = errors_left_out(runs, [&](std::span<const TimedRun> others, std::span<const TimedRun> some) {
    return relative_errors(some, fit(others, fitted, expected), technique);
  });
  return result;
}

ThreadFit fit_threads(std::span<const ThreadedRun> runs, Technique technique, Engine engine,
                      const std::optional<ThreadCosts>& usual) {
  constexpr std::size_t least_runs = 5;
  if (runs.size() < least_runs)
    throw std::invalid_argument(fmt::format("a fit of the costs of threads takes at least {} runs of {} (got {})",
                                            least_runs, name(technique), runs.size()));
  for (const ThreadedRun& run : runs) {
    require_positive("seconds of a run", run.seconds);
    require_positive("seconds of a run on one thread", run.one_seconds);
    require_count("number of threads of a run", run.threads, 2, 1e6);
  }
  const ThreadFitter fitter(technique, engine, usual);
  ThreadFit result{{.technique = technique, .engine = engine, .runs = runs.size()}, fitter.fit(runs)};
  result.median_error = median(fitter.errors(runs, result.costs));
  result.left_out_errors =
      errors_left_out(runs, [&](std::span<const ThreadedRun> others, std::span<const ThreadedRun> some) {
        return fitter.errors(some, fitter.fit(others));
      });
  return result;
}

}  // namespace detp::validate
