#include "contenders.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "detp/validate/unit_costs.hpp"

namespace detp::validate {
namespace {

template <std::size_t alternative>
bool takes(Technique technique) {
  try {
    check(Candidate{technique, std::variant_alternative_t<alternative, Parameters>{}});
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// The technique with its default parameters: the kind of parameters that it does not refuse.
Candidate with_defaults(Technique technique) {
  Candidate found{technique, {}};
  [&]<std::size_t... alternatives>(std::index_sequence<alternatives...>) {
    ((takes<alternatives>(technique) ? void(found.parameters = std::variant_alternative_t<alternatives, Parameters>{})
                                     : void()),
     ...);
  }
  (std::make_index_sequence<std::variant_size_v<Parameters>>{});
  return found;
}

}  // namespace

Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless) {
  const auto wanted = [&](Technique technique) {
    return finds_all_hits(technique) &&
           (named.empty() || std::find(named.begin(), named.end(), technique) != named.end());
  };
  std::vector<model::Ranked> ranking = model::rank(workload, built_in_unit_costs());
  Contenders found{.candidates = {}, .hits = ranking.front().counts.hits};
  std::erase_if(ranking, [&](const model::Ranked& ranked) { return !wanted(ranked.candidate.technique); });
  for (const model::Ranked& ranked : ranking)
    if (ranked.time.total() <= hopeless * ranking.front().time.total()) found.candidates.push_back(ranked.candidate);
  for (const Technique technique : all_techniques)
    if (wanted(technique) && !has_closed_form(technique)) found.candidates.push_back(with_defaults(technique));
  return found;
}

}  // namespace detp::validate
