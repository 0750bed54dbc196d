#include "map_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

/// Of these candidates with their seconds, the best of each technique; without seconds, none.
template <class Candidates, class Seconds>
Json best_of_each(const Candidates& candidates, const Seconds& seconds) {
  Json best = Json::array();
  for (const auto& one : candidates) {
    const std::optional<double> took = std::invoke(seconds, one);
    if (!took) continue;
    Json json = json_of(candidate_fields(), one.candidate);
    json["seconds"] = *took;
    const auto same =
        std::ranges::find_if(best, [&](const Json& other) { return other["technique"] == json["technique"]; });
    if (same == best.end())
      best.push_back(std::move(json));
    else if ((*same)["seconds"] > json["seconds"])
      *same = std::move(json);
  }
  return best;
}

Json predicted_json(const Choice& choice) {
  Json json = json_of(candidate_fields(), choice.best().candidate);
  json["seconds"] = choice.best().seconds();
  if (choice.rigor == Rigor::pilot) json["seconds_error"] = choice.best().error;
  json["rigor"] = name(choice.rigor);
  json["techniques"] = best_of_each(choice.candidates, &Prediction::seconds);
  for (const RuledOut& one : choice.ruled_out)
    json["techniques"].push_back(
        {{"technique", name(one.technique)}, {one.by_bound ? "at_least_seconds" : "seconds", one.seconds}});
  return json;
}

Json measured_json(const Analysis& analysis) {
  const Analysed& best = *analysis.fastest();
  const Analysed& predicted = analysis.candidates.front();
  Json json = json_of(candidate_fields(), best.candidate);
  json["seconds"] = best.seconds.value();
  json["spread"] = best.spread;
  json["predicted_choice_seconds"] = predicted.seconds.value();
  json["predicted_choice_spread"] = predicted.spread;
  json["tried"] = analysis.tried;
  json["techniques"] = best_of_each(analysis.candidates, &Analysed::seconds);
  return json;
}

/// Technique and parameters in words, in columns of a table. `candidate_of` returns null for none.
template <class CandidateOf>
Field<PlacedCell> in_words(const std::string& prefix, const std::string& meaning, CandidateOf candidate_of) {
  return Field<PlacedCell>(prefix, "", meaning,
                           [candidate_of](const PlacedCell& one) {
                             const Candidate* const found = std::invoke(candidate_of, *one.cell);
                             return found == nullptr
                                        ? left_out()
                                        : Json{{"technique", name(found->technique)}, {"parameters", describe(*found)}};
                           })
      .in({{prefix + "_technique", "/technique"}, {prefix + "_parameters", "/parameters"}})
      .in_tables_alone();
}

}  // namespace

std::optional<CellVerdict> MapCell::verdict() const {
  if (!analysis) return std::nullopt;
  const Analysed& predicted = analysis->candidates.front();
  const Analysed& best = *fastest();
  return CellVerdict{
      .agrees = predicted.candidate.technique == best.candidate.technique,
      .slower = analysis->regret.value(),
      .within_noise = predicted.seconds.value() - predicted.spread <= best.seconds.value() + best.spread};
}

std::vector<PlacedCell> TechniqueMap::cells() const {
  std::vector<PlacedCell> all;
  for (const MapRow& row : rows)
    for (const MapCell& cell : row.cells) all.push_back({&row, &cell});
  return all;
}

std::size_t Agreement::within_noise() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(disagreeing, [](const PlacedCell& one) { return one.cell->verdict()->within_noise; }));
}

Agreement agreement_of(const TechniqueMap& map) {
  Agreement found;
  double logarithms = 0;
  for (const PlacedCell& one : map.cells()) {
    const auto verdict = one.cell->verdict();
    if (!verdict) continue;
    ++found.cells;
    found.agree += verdict->agrees ? 1 : 0;
    logarithms += std::log1p(verdict->slower);
    found.worst_slowdown = std::max(found.worst_slowdown, 1 + verdict->slower);
    if (!verdict->agrees) found.disagreeing.push_back(one);
  }
  if (found.cells > 0) found.mean_slowdown = std::exp(logarithms / static_cast<double>(found.cells));
  std::ranges::stable_sort(found.disagreeing, std::greater(),
                           [](const PlacedCell& one) { return one.cell->verdict()->slower; });
  return found;
}

const Fields<PlacedCell>& map_cell_fields() {
  static const Fields<PlacedCell> fields = [] {
    using Of = Field<PlacedCell>;
    const auto verdict = [](auto value) {
      return of_part([](const PlacedCell& one) { return one.cell->verdict(); }, value);
    };
    return Fields<PlacedCell>{
        Of("rays", "", "number of rays", [](const PlacedCell& one) { return whole(one.cell->rays); }).in_json_alone(),
        Of("disc_radius", "", "of all discs", [](const PlacedCell& one) { return one.row->workload.disc_radius; })
            .in_json_alone(),
        {"x", "", "distance between neighbouring samples over the disc radius",
         [](const PlacedCell& one) { return one.row->x; }},
        in_words("predicted", "the candidate that is chosen", &MapCell::predicted),
        Of("predicted", "s", "the choice, its seconds with a pilot's standard error, and the best of each technique",
           [](const PlacedCell& one) { return one.cell->choice ? predicted_json(*one.cell->choice) : left_out(); })
            .in({{"predicted_seconds", "/seconds"},
                 {"predicted_seconds_error", "/seconds_error"},
                 {"rigor", "/rigor"}}),
        in_words("measured", "the fastest measured candidate",
                 [](const MapCell& cell) { return cell.analysis ? &cell.fastest()->candidate : nullptr; }),
        Of("measured", "s", "the fastest measured candidate and the predicted choice, medians and half ranges",
           [](const PlacedCell& one) { return one.cell->analysis ? measured_json(*one.cell->analysis) : left_out(); })
            .in({{"measured_seconds", "/seconds"},
                 {"measured_spread", "/spread"},
                 {"predicted_choice_measured_seconds", "/predicted_choice_seconds"}}),
        {"slower", "", "measured time of the predicted choice over the shortest, minus 1",
         verdict(&CellVerdict::slower)},
        {"within_noise", "", "the ranges of these two times overlap", verdict(&CellVerdict::within_noise)},
        {"agrees", "", "the predicted technique was the fastest measured one", verdict(&CellVerdict::agrees)},
        in_words("paper", "what the paper's rule takes", [](const MapCell& cell) { return &cell.paper; }),
        Of("paper_rule", "", "what the paper's rule takes", [](const PlacedCell& one) {
          return json_of(candidate_fields(), one.cell->paper);
        }).in_json_alone()};
  }();
  return fields;
}

const Fields<TechniqueMap>& map_fields() {
  static const Fields<TechniqueMap> fields{
      {"axes", "", "numbers of rays, disc radii, and X of these",
       [](const TechniqueMap& map) {
         Json axes{{"rays", Json::array()}, {"disc_radius", Json::array()}, {"x", Json::array()}};
         for (const double rays : map.rays) axes["rays"].push_back(whole(rays));
         for (const MapRow& row : map.rows) {
           axes["disc_radius"].push_back(row.workload.disc_radius);
           axes["x"].push_back(row.x);
         }
         return axes;
       }},
      {"cells", "", "by disc radius, then by number of rays",
       [](const TechniqueMap& map) { return rows_json(map_cell_fields(), map.cells()); }},
      {"agreement", "", "of measured cells: where the prediction was right, and how much slower its choices are",
       [](const TechniqueMap& map) {
         const Agreement found = agreement_of(map);
         if (found.cells == 0) return left_out();
         return Json{{"cells", found.cells},
                     {"agree", found.agree},
                     {"share", found.share()},
                     {"disagree_within_noise", found.within_noise()},
                     {"slowdown", {{"geometric_mean", found.mean_slowdown}, {"worst", found.worst_slowdown}}}};
       }},
      {"warnings", "", "about rays and discs", &TechniqueMap::warnings},
      {"seconds", "s", "for predicting, with scenes and rays, and for measuring",
       [](const TechniqueMap& map) {
         return Json{{"predicting", map.predicting_seconds}, {"measuring", map.measuring_seconds}};
       }},
      {"unit_costs", "", "where they come from", &TechniqueMap::costs_origin}};
  return fields;
}

std::vector<FieldText> describe_map() { return describe_fields(map_fields()) + describe_fields(map_cell_fields()); }

std::string radius_label(const Length& radius) {
  return radius.relative ? fmt::format("{:.3g} %", 100 * radius.value) : fmt::format("{:.3g}", radius.value);
}

std::string describe(const TechniqueMap& map) {
  const Workload& workload = map.rows.front().workload;
  return fmt::format("{}: {} discs of dimension D = {:.2f}, {}", shown_path(map.name), workload.samples,
                     workload.dimension,
                     map.field == sim::Field::mixed       ? "a mixed field"
                     : map.field == sim::Field::isotropic ? "isotropic lines"
                                                          : "photon paths");
}

std::vector<double> cell_edges(const std::vector<double>& values) {
  std::vector<double> edges{0};
  for (std::size_t i = 0; i + 1 < values.size(); ++i) edges.push_back(std::sqrt(values[i]) * std::sqrt(values[i + 1]));
  const double beyond = values.size() > 1 ? values.back() / edges.back() : std::sqrt(10.0);
  edges.front() = values.front() / (values.size() > 1 ? edges[1] / values.front() : beyond);
  edges.push_back(values.back() * beyond);
  return edges;
}

}  // namespace detp::validate
