#include "reason.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "detp/validate/choice/prediction_error.hpp"

namespace detp::validate {
namespace {

std::optional<Prediction> predicted(const Workload& workload, const CostTable& costs, const Contender& contender) {
  const auto& [candidate, threads] = contender;
  if (!model::has_closed_form(candidate.technique)) return std::nullopt;
  try {
    Prediction ranked = model::assess(workload, candidate, costs);
    ranked.threads = threads;
    ranked.time = price(ranked.counts, costs, candidate.technique, threads);
    return ranked;
  } catch (const std::invalid_argument&) {  // some parameters have no closed form
    return std::nullopt;
  }
}

std::string counts_reason(const PredictionError& of_choice, const PredictionError& of_best) {
  const bool is_choice = std::abs(std::log(of_choice.counts)) > std::abs(std::log(of_best.counts));
  const PredictionError& error = is_choice ? of_choice : of_best;
  const std::string_view whose = is_choice ? "choice" : "best";
  if (!std::isfinite(error.worst_ratio))
    return fmt::format("counts: {} of the {} predicted, but none counted", error.worst, whose);
  return fmt::format("counts: {} of the {} predicted {:.2g} times", error.worst, whose, error.worst_ratio);
}

}  // namespace

std::string reason_of_regret(const Workload& workload, const CostTable& costs, const Timed& choice, const Timed& best,
                             double noise) {
  if (choice.contender == best.contender) return "";
  const double regret = choice.judged_ratio(best);
  if (regret <= std::max(noise, 1 / noise)) return "within the noise";
  if (choice.contender.candidate == best.contender.candidate)
    return fmt::format("costs of threads: {} chosen, the best takes {}", choice.contender.threads,
                       best.contender.threads);
  const auto of_choice = predicted(workload, costs, choice.contender);
  const auto of_best = predicted(workload, costs, best.contender);
  if (!of_best) return fmt::format("{} has no closed form", title(best.contender.candidate));
  if (!of_choice) return fmt::format("{} has no closed form", title(choice.contender.candidate));
  const double ratio = of_best->time.total() / of_choice->time.total();
  if (ratio < 1) return fmt::format("the best was not tried: predicted {:.2g} times the choice's seconds", ratio);
  if (choice.abandoned)
    return fmt::format("the choice was abandoned after {:.2g} s, predicted {:.2g} s", choice.first_seconds,
                       of_choice->time.total());
  const PredictionError choice_error = prediction_error(*of_choice, choice.counts, choice.judging_seconds(), costs);
  const PredictionError best_error = prediction_error(*of_best, best.counts, best.judging_seconds(), costs);
  if (best_error.counts / choice_error.counts > best_error.unit_costs / choice_error.unit_costs)
    return counts_reason(choice_error, best_error);
  return fmt::format("unit costs: right counts give {:.2g} times the choice's seconds, {:.2g} times the best's",
                     choice_error.unit_costs, best_error.unit_costs);
}

}  // namespace detp::validate
