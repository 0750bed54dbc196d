#include "tips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"

namespace detp::validate {
namespace {

/// The choice, with counts of box trees that can be extrapolated.
Choice with_growth(const Choice& choice) {
  Choice found = choice;
  for (Prediction& one : found.candidates) {
    const auto* shape = std::get_if<BoxTreeParameters>(&one.candidate.parameters);
    if (one.counts_at || shape == nullptr || !choice.discs) continue;
    one.counts_at = [counts = choice.discs->counts(*shape, true)](double radius_ratio, double rays) {
      return counts.at(radius_ratio, rays);
    };
  }
  return found;
}

/// The time of the candidate in that choice; by its closed form if it is not among those that were compared.
double seconds_in(const Choice& there, const Candidate& candidate, const Workload& workload, const CostTable& costs,
                  int threads) {
  for (const Prediction& one : there.candidates)
    if (one.candidate == candidate) return one.seconds();
  if (there.rigor != Rigor::estimate || candidate.technique != there.best().candidate.technique)
    return there.best().seconds();
  return model::assess(workload, candidate, costs, threads).seconds();
}

ChoiceThere choice_there(const Choice& choice, double unchanged_seconds) {
  ChoiceThere there{choice.best(), unchanged_seconds, choice.unexamined};
  if (choice.rigor == Rigor::estimate) return there;
  for (const Prediction& one : choice.candidates)
    if (one.source == Source::closed_form && one.candidate.technique != choice.best().candidate.technique)
      there.not_ruled_out.push_back(one.candidate.technique);
  return there;
}

constexpr double accuracy = 1.05;  // of the value at which a choice changes
constexpr std::array all_kinds{TipKind::technique, TipKind::not_ruled_out, TipKind::parameters, TipKind::threads};

TipInputs with_value(TipInputs inputs, TipInput input, double value) {
  inputs[input] = value;
  return inputs;
}

/// A number >= 1, rounded to three digits.
double three_digits(double number) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(number)) - 2));
  return std::round(number / unit) * unit;
}

std::string threads_words(double threads) { return fmt::format("{:.0f} thread{}", threads, threads == 1 ? "" : "s"); }

/// " (40 % fewer)", " (4 times as many)": how far from the present value; nothing for threads.
std::string how_far(const Tip& tip) {
  if (tip.input == TipInput::threads) return "";
  const bool rays = tip.input == TipInput::rays;
  if (tip.ratio >= 1.995) return fmt::format(" ({:.3g} times as {})", tip.ratio, rays ? "many" : "large");
  return fmt::format(" ({:.0f} % {})", 100 * std::abs(tip.ratio - 1),
                     tip.ratio > 1 ? (rays ? "more" : "larger") : (rays ? "fewer" : "smaller"));
}

double factor_between(double a, double b) { return std::max(a, b) / std::min(a, b); }

class TipFinder {
 public:
  TipFinder(const TipInputs& present, const TipSearch& search, const ChooseForInputs& choose,
            const std::stop_token& stop)
      : present_(present), search_(search), choose_(choose), stop_(stop) {}

  Tips run() {
    for (const TipInput input : tip_inputs)
      found_.ranges[static_cast<std::size_t>(input)] = {present_[input], present_[input]};
    const auto now = choice_with(present_);
    if (!now) return std::move(found_);
    now_ = *now;
    for (const TipInput input : tip_inputs) {
      for (const bool up : {false, true})
        walk(input, input == TipInput::threads ? thread_values(up) : values(input, up));
      if (!stop_.stop_requested()) ++found_.inputs;
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] std::vector<double> values(TipInput input, bool up) {
    std::vector<double> all;
    double last = present_[input];
    for (int i = 1; i <= search_.steps; ++i) {
      const double power = static_cast<double>(up ? i : -i) / search_.steps;
      const double value = rounded(input, present_[input] * std::pow(search_.factor, power));
      if (value != last) all.push_back(value);
      last = value;
    }
    return all;
  }

  [[nodiscard]] std::vector<double> thread_values(bool up) const {
    std::vector<double> all;
    for (const int threads : thread_numbers(std::max(search_.most_threads, static_cast<int>(present_.threads))))
      if (up ? threads > present_.threads : threads < present_.threads) all.push_back(threads);
    if (!up) std::reverse(all.begin(), all.end());
    return all;
  }

  static double rounded(TipInput input, double value) {
    constexpr double most_rays = 1e18;
    return input == TipInput::rays ? std::clamp(std::round(value), 1.0, most_rays) : value;
  }

  std::optional<ChoiceThere> choice_with(const TipInputs& inputs) {
    ++found_.choices;
    std::optional<ChoiceThere> choice;
    if (!stop_.stop_requested()) choice = choose_(inputs);
    if (stop_.stop_requested()) return std::nullopt;  // the choice may be that of a search that was ended
    return choice;
  }

  /// A technique that is not ruled out there, but is with the present inputs.
  [[nodiscard]] std::optional<Technique> possible(const ChoiceThere& there) const {
    for (const Technique one : there.not_ruled_out)
      if (std::ranges::find(now_.not_ruled_out, one) == now_.not_ruled_out.end()) return one;
    return std::nullopt;
  }

  [[nodiscard]] bool is_changed(TipKind kind, const ChoiceThere& there, const TipInputs& inputs) const {
    const bool same = there.best.candidate.technique == now_.best.candidate.technique;
    switch (kind) {
      case TipKind::technique:
        return !same;
      case TipKind::not_ruled_out:
        return possible(there).has_value();
      case TipKind::parameters:
        return same && there.unchanged_seconds > (1 + distinguishable) * there.best.seconds();
      case TipKind::threads:
        return same && there.best.threads != std::min<double>(now_.best.threads, inputs.threads);
    }
    return false;
  }

  /// The nearest value with the change: it is not at `before`, but at `value`.
  Tip nearest(TipInput input, TipKind kind, double before, double value, ChoiceThere there) {
    while (input != TipInput::threads && factor_between(before, value) > accuracy) {
      const double middle = rounded(input, std::sqrt(before) * std::sqrt(value));
      if (middle == before || middle == value) break;
      const TipInputs inputs = with_value(present_, input, middle);
      auto choice = choice_with(inputs);
      if (!choice) break;
      if (is_changed(kind, *choice, inputs)) {
        value = middle;
        there = std::move(*choice);
      } else {
        before = middle;
      }
    }
    const Candidate candidate =
        kind == TipKind::not_ruled_out ? default_candidate(possible(there).value()) : there.best.candidate;
    return {input, kind, value, value / present_[input], candidate, there.best.threads};
  }

  /// Examines values that are farther and farther away.
  void walk(TipInput input, const std::vector<double>& values) {
    std::vector<Tip> tips;
    const auto find = [&](TipKind kind) { return std::ranges::find(tips, kind, &Tip::kind); };
    double before = present_[input];
    for (const double value : values) {
      const TipInputs inputs = with_value(present_, input, value);
      const auto there = choice_with(inputs);
      if (!there) break;
      TipRange& range = found_.ranges[static_cast<std::size_t>(input)];
      range = {std::min(range.least, value), std::max(range.most, value)};
      for (const TipKind kind : all_kinds)
        if (find(kind) == tips.end() && is_changed(kind, *there, inputs))
          tips.push_back(nearest(input, kind, before, value, *there));
      if (find(TipKind::technique) != tips.end()) break;
      before = value;
    }
    const auto distance = [](const Tip& tip) { return std::abs(std::log(tip.ratio)); };
    std::ranges::stable_sort(tips, {}, distance);
    if (const auto last = find(TipKind::technique); last != tips.end()) tips.erase(last + 1, tips.end());
    found_.tips.insert(found_.tips.end(), tips.begin(), tips.end());
  }

  TipInputs present_;
  TipSearch search_;
  const ChooseForInputs& choose_;
  const std::stop_token& stop_;
  ChoiceThere now_;
  Tips found_;
};

}  // namespace

Tips find_tips(const TipInputs& present, const TipSearch& search, const ChooseForInputs& choose,
               const std::stop_token& stop) {
  return TipFinder(present, search, choose, stop).run();
}

Tips tips_of(const Choice& choice, const Question& question, const Valid<CostTable>& costs) {
  const Workload& workload = question.workload.value();
  const Candidate present = choice.best().candidate;
  const Choice counted = with_growth(choice);
  const CostTable priced = costs_for(question, costs);
  const auto choose = [&](const TipInputs& inputs) -> std::optional<ChoiceThere> {
    try {
      Question changed = question;
      changed.threads = static_cast<int>(inputs.threads);
      const Choice there =
          choose_again(counted, changed, inputs.disc_radius / workload.disc_radius, inputs.rays, costs);
      Workload with_inputs = with_disc_radius(workload, inputs.disc_radius);
      with_inputs.rays = inputs.rays;
      return choice_there(there, seconds_in(there, present, with_inputs, priced, changed.threads));
    } catch (const std::invalid_argument&) {  // no workload has this radius
      return std::nullopt;
    } catch (const sim::Stopped&) {
      return std::nullopt;
    }
  };
  return find_tips(
      {workload.disc_radius, question.ray_count.value_or(workload.rays),
       static_cast<double>(sim::useful_threads(question.threads))},
      {.factor = choice.rigor == Rigor::estimate ? 16.0 : 4.0, .steps = 4, .most_threads = sim::useful_threads(0)},
      choose, question.stop);
}

std::string place_of(const Tip& tip) {
  if (tip.input == TipInput::threads) return threads_words(tip.at);
  if (tip.input == TipInput::rays)
    return fmt::format("{:.0f} rays or {}", three_digits(tip.at), tip.ratio > 1 ? "more" : "fewer");
  return fmt::format("d = {:.3g} or {}", tip.at, tip.ratio > 1 ? "more" : "less");
}

std::string text_of(const Tip& tip) {
  const auto technique = name(tip.candidate.technique);
  const std::string there = place_of(tip) + how_far(tip);
  switch (tip.kind) {
    case TipKind::technique:
      return fmt::format("{} is faster with {}", technique, there);
    case TipKind::not_ruled_out:
      return fmt::format("{} is no longer ruled out with {}", technique, there);
    case TipKind::parameters:
      return fmt::format("{} is {:.0f} % faster with {}", title(tip.candidate), 100 * distinguishable, there);
    case TipKind::threads:
      return fmt::format("{} {} faster with {}", threads_words(tip.threads), tip.threads == 1 ? "is" : "are", there);
  }
  return "";
}

std::string text_of(TipInput input, const TipRange& range) {
  if (input == TipInput::disc_radius) return fmt::format("d from {:.3g} to {:.3g}", range.least, range.most);
  if (input == TipInput::rays)
    return fmt::format("{:.0f} to {:.0f} rays", three_digits(range.least), three_digits(range.most));
  return fmt::format("{:.0f} to {:.0f} threads", range.least, range.most);
}

}  // namespace detp::validate
