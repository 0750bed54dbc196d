#include "map_checkpoint.hpp"

#include <algorithm>
#include <utility>

#include "detp/validate/checkpoint/value_json.hpp"
#include "detp/validate/choice/candidate_json.hpp"

namespace detp::validate {
namespace {

template <class T>
nlohmann::json optional_json(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

template <class T>
std::optional<T> optional_of(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<T>());
}

nlohmann::json json_of(const Analysis& analysis) {
  nlohmann::json candidates = nlohmann::json::array();
  for (const Analysed& one : analysis.candidates)
    candidates.push_back(
        {{"candidate", {{"technique", name(one.candidate.technique)}, {"parameters", to_json(one.candidate)}}},
         {"threads", one.threads},
         {"counted", optional_json(one.counted)},
         {"seconds", optional_json(one.seconds)},
         {"spread", one.spread},
         {"given_up_after", optional_json(one.given_up_after)},
         {"refused", one.refused}});
  return {{"candidates", candidates},
          {"tried", analysis.tried},
          {"best", optional_json(analysis.best)},
          {"regret", optional_json(analysis.regret)}};
}

Analysis analysis_of(const nlohmann::json& json, const std::vector<Prediction>& ranking) {
  Analysis analysis;
  json.at("tried").get_to(analysis.tried);
  analysis.best = optional_of<std::size_t>(json.at("best"));
  analysis.regret = optional_of<double>(json.at("regret"));
  for (const nlohmann::json& one : json.at("candidates")) {
    const nlohmann::json& kept = one.at("candidate");
    const auto technique = technique_named(kept.at("technique").get<std::string>());
    if (!technique) throw std::invalid_argument("there is no such technique");
    Analysed candidate{.candidate = candidate_of(*technique, kept.at("parameters")),
                       .threads = one.at("threads").get<int>(),
                       .counted = optional_of<Counts<std::uint64_t>>(one.at("counted")),
                       .seconds = optional_of<double>(one.at("seconds")),
                       .spread = one.at("spread").get<double>(),
                       .given_up_after = optional_of<double>(one.at("given_up_after")),
                       .refused = one.at("refused").get<std::string>()};
    const auto predicted = std::ranges::find(ranking, candidate.candidate, &Prediction::candidate);
    if (predicted != ranking.end()) candidate.predicted = *predicted;
    analysis.candidates.push_back(std::move(candidate));
  }
  if (analysis.best && *analysis.best >= analysis.candidates.size())
    throw std::invalid_argument("the best candidate is none of the cell's");
  return analysis;
}

}  // namespace

void MapCheckpoint::read(std::stop_token stop) {
  const auto state = file_.read(std::move(stop));
  if (!state) return;
  try {
    state->get_to(cells_);
    for (const auto& [cell, json] : cells_) static_cast<void>(analysis_of(json, {}));
  } catch (const nlohmann::json::exception& error) {
    throw file_.damaged(error.what());
  } catch (const std::invalid_argument& error) {
    throw file_.damaged(error.what());
  }
}

std::optional<Analysis> MapCheckpoint::find(const std::string& cell, const std::vector<Prediction>& ranking) const {
  const auto found = cells_.find(cell);
  return found == cells_.end() ? std::nullopt : std::optional(analysis_of(found->second, ranking));
}

void MapCheckpoint::add(const std::string& cell, const Analysis& analysis) {
  cells_[cell] = json_of(analysis);
  if (file_.due()) write();
}

}  // namespace detp::validate
