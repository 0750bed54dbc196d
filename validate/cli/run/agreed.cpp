#include "agreed.hpp"

#include "detp/sim/ranks/failures.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/text/result.hpp"

namespace detp::cli {

Requested agreed(sim::Ranks* ranks, const std::function<Requested()>& of_first) {
  if (ranks == nullptr) return of_first();
  const Json json = Json::parse(sim::from_first(*ranks, [&] {
    const Requested one = of_first();
    return Json{
        {"technique", name(one.candidate.technique)}, {"parameters", to_json(one.candidate)}, {"threads", one.threads}}
        .dump();
  }));
  return {candidate_of(parse_technique(json.at("technique")), json.at("parameters")), json.at("threads")};
}

}  // namespace detp::cli
