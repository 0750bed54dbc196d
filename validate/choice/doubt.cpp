#include "doubt.hpp"

#include <algorithm>
#include <limits>

namespace detp::validate {
namespace {

double doubt_of(const Prediction& one, bool counted_scene, bool against_counts) {
  const Technique technique = one.candidate.technique;
  const bool compared = technique == Technique::brute_force || technique == Technique::box_tree;
  if (one.source != Source::closed_form || compared) return 1;
  if (one.extrapolated.empty()) return against_counts ? closed_form_doubt : 1;
  return counted_scene ? closed_form_doubt : std::numeric_limits<double>::infinity();
}

}  // namespace

void put_choice_first(std::vector<Prediction>& candidates, bool counted_scene, double prepared) {
  const bool against_counts =
      std::ranges::any_of(candidates, [](const Prediction& one) { return one.source == Source::sample; });
  for (Prediction& one : candidates) one.doubt = doubt_of(one, counted_scene, against_counts);
  std::ranges::stable_sort(candidates, {}, &Prediction::seconds);
  const auto left = [&](const Prediction& one) {
    return one.doubtful_seconds() - (one.candidate.technique == Technique::box_tree ? prepared : 0);
  };
  const auto choice = std::ranges::min_element(candidates, {}, left);
  if (choice != candidates.end()) std::rotate(candidates.begin(), choice, choice + 1);
}

}  // namespace detp::validate
