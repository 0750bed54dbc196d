#include "choice_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/usual_shape.hpp"

namespace detp::study {
namespace {

constexpr std::array<const char*, 3> selections{"auto", "all", "none"};
constexpr std::size_t leaders = 3;  ///< of the ranking with the effects that evidence calls for
constexpr double alike = 1.02;
constexpr int measured = 5;         ///< times that the evidence is collected
constexpr double most_brute = 3e9;  ///< tests by brute force; more are not counted but computed

double off_by(double ratio) { return std::max(ratio, 1 / ratio); }

double median_seconds(const StudyWorkload& workload, const char* selection) {
  std::vector<double> seconds;
  for (int i = 0; i < measured; ++i) seconds.push_back(workload.observe(sim::EffectSelection(selection)).seconds);
  return validate::median(seconds);
}

/// Times of candidates by exact counts, each counted once.
class Priced {
 public:
  explicit Priced(const StudyWorkload& workload) : workload_(workload) {}

  void add(const Candidate& candidate) { static_cast<void>(seconds(candidate)); }

  double seconds(const Candidate& candidate) {
    const auto [place, is_new] = seconds_.try_emplace(cell_of(candidate), 0);
    if (is_new) {
      counts_[place->first] = counts_of(candidate);
      place->second = price(counts_[place->first], validate::built_in_unit_costs(), candidate.technique).total();
    }
    return place->second;
  }

  [[nodiscard]] std::pair<std::string, double> best() const {
    return *std::min_element(seconds_.begin(), seconds_.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
  }

 private:
  [[nodiscard]] Counts<double> counts_of(const Candidate& candidate) const {
    const Workload& workload = workload_.automatic().workload;
    const bool too_long =
        candidate.technique == Technique::brute_force && workload.rays * workload.samples > most_brute;
    return too_long ? model::predict(workload, candidate) : workload_.count(candidate);
  }

  const StudyWorkload& workload_;
  std::map<std::string, double> seconds_;
  std::map<std::string, Counts<double>> counts_;
};

/// The effect that is off and, switched on, changes the predicted tests the most; and their ratio.
std::pair<std::string, double> largest_off(const StudyWorkload& workload, double tests) {
  std::pair<std::string, double> largest{"", 1};
  for (const sim::EffectReport& report : workload.automatic().effects) {
    if (report.on || report.effect->is_input) continue;
    const Workload switched = workload.observe_switched(*report.effect).workload;
    const double ratio = tests_of(model::predict(switched, usual_tree())) / tests;
    if (off_by(ratio) > off_by(largest.second)) largest = {std::string(report.effect->name), ratio};
  }
  return largest;
}

std::string names_on(const sim::Observed& observed) {
  std::string names;
  for (const sim::EffectReport& report : observed.effects)
    if (report.on) names += fmt::format("{}{}", names.empty() ? "" : "; ", report.effect->name);
  return names;
}

double geometric_mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace

void ChoiceTable::add(const StudyWorkload& workload) {
  Half& half = workload.workload().held_out ? held_out_ : tuned_;
  std::array<Counts<double>, selections.size()> predicted;
  std::array<Candidate, selections.size()> chosen;
  Priced priced(workload);
  for (std::size_t i = 0; i < selections.size(); ++i) {
    const Workload seen = workload.observe(sim::EffectSelection(selections[i])).workload;
    predicted[i] = model::predict(seen, usual_tree());
    chosen[i] = chosen_for(seen);
    priced.add(chosen[i]);
  }
  const Workload& seen = workload.automatic().workload;
  const auto ranking = model::rank(seen, validate::built_in_unit_costs());
  for (std::size_t i = 0; i < std::min(leaders, ranking.size()); ++i) priced.add(ranking[i].candidate);
  priced.add({Technique::box_tree, validate::usual_shape(seen.rays, seen.samples)});
  const auto [best, least] = priced.best();
  const double counted = tests_of(workload.count(usual_tree()));
  const double all = tests_of(predicted[1]);
  csv_ +=
      fmt::format("{},{},{:.5g},{:.5g},{:.5g}", workload.row(), names_on(workload.automatic()),
                  tests_of(predicted[0]) / all, predicted[0].hits / predicted[1].hits, tests_of(predicted[2]) / all);
  for (std::size_t i = 0; i < selections.size(); ++i) {
    half.tests[selections[i]].add(tests_of(predicted[i]), counted);
    csv_ += fmt::format(",{:.4g}", tests_of(predicted[i]) / counted);
  }
  const auto [cause, change] = largest_off(workload, tests_of(predicted[0]));
  csv_ += fmt::format(",{},{:.4g}", cause, change);
  for (const Candidate& one : chosen) csv_ += "," + cell_of(one);
  csv_ += "," + best;
  for (std::size_t i = 0; i < selections.size(); ++i) {
    const double ratio = priced.seconds(chosen[i]) / least;
    half.time_over_best[selections[i]].push_back(ratio);
    csv_ += fmt::format(",{:.4g}", ratio - 1);
  }
  half.tests_over_all.push_back(off_by(tests_of(predicted[0]) / all));
  if (half.tests_over_all.back() > alike) half.causes[cause] += 1;
  half.evidence.push_back(median_seconds(workload, "auto"));
  half.evidence_of_all.push_back(median_seconds(workload, "all"));
  const std::array evidence{half.evidence.back(), half.evidence_of_all.back(), 0.0};  // none needs none
  for (std::size_t i = 0; i < selections.size(); ++i)
    half.price[selections[i]].push_back((priced.seconds(chosen[i]) + evidence[i]) / least);
  csv_ += fmt::format(",{:.4g},{:.3g},{:.3g}\n", least, half.evidence.back(), half.evidence_of_all.back());
}

std::string ChoiceTable::summary() const {
  std::string text = "| | tuned | held out |\n|---|---|---|\n";
  const auto row = [&](const std::string& what, const auto& value) {
    text += fmt::format("| {} | {} | {} |\n", what, value(tuned_), value(held_out_));
  };
  row("workloads", [](const Half& half) { return half.tests_over_all.size(); });
  for (const double share : {0.5, 0.95, 1.0})
    row(fmt::format("predicted tests, auto over all, quantile {}", share), [&](const Half& half) {
      return half.tests_over_all.empty() ? "" : fmt::format("{:.3f}", validate::quantile(half.tests_over_all, share));
    });
  row("within 2 %", [](const Half& half) {
    const auto& off = half.tests_over_all;
    return std::count_if(off.begin(), off.end(), [](double one) { return one <= alike; });
  });
  row("not within 2 %, by the effect that is off and changes the most", [](const Half& half) {
    std::string causes;
    for (const auto& [effect, number] : half.causes)
      causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", effect.empty() ? "none" : effect, number);
    return causes;
  });
  for (const char* selection : selections)
    row(fmt::format("predicted over counted tests, {}: median, worst", selection), [&](const Half& half) {
      const auto found = half.tests.find(selection);
      return found == half.tests.end() ? "" : found->second.text();
    });
  const auto times = [&](const std::string& what, const auto& of) {
    for (const char* selection : selections)
      row(fmt::format("{}, {}: geometric mean, worst", what, selection), [&](const Half& half) {
        const auto found = of(half).find(selection);
        if (found == of(half).end()) return std::string();
        return fmt::format("{:.4f}, {:.2f}", geometric_mean(found->second),
                           *std::max_element(found->second.begin(), found->second.end()));
      });
  };
  times(
      "time over the best", [](const Half& half) -> const auto& { return half.time_over_best; });
  times(
      "with the evidence", [](const Half& half) -> const auto& { return half.price; });
  row("evidence, auto and all: median, ms", [](const Half& half) {
    return half.evidence.empty() ? ""
                                 : fmt::format("{:.3f}, {:.3f}", 1e3 * validate::median(half.evidence),
                                               1e3 * validate::median(half.evidence_of_all));
  });
  return text;
}

}  // namespace detp::study
