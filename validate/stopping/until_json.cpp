#include "until_json.hpp"

#include <string>

namespace detp::validate {

using Json = nlohmann::ordered_json;

Json to_json(const UntilState& state, const ExecutedUntil& so_far) {
  const PairedBatches::State& batches = state.batches;
  const sim::Outcome& outcome = so_far.outcome;
  Json counts;
  for_each_term(outcome.counts, [&](std::string_view term, std::uint64_t count) { counts[std::string(term)] = count; });
  Json spheres = Json::array();
  for (const sim::SphereCounts& one : outcome.spheres) spheres.push_back({one.rebuilds, one.tests, one.listed});
  return {{"rays", state.rays},
          {"tests", state.tests},
          {"stage", {state.stage_rays, state.stage_is_test, state.stage_is_last, state.stage_batches}},
          {"sums", batches.sums},
          {"pending", batches.pending},
          {"pending_photons", batches.pending_photons},
          {"photons", batches.photons},
          {"pairs", batches.pairs},
          {"earlier", batches.earlier},
          {"products", {batches.products_of_squares, batches.squares_of_products}},
          {"hits", outcome.hits},
          {"total_hits", outcome.total_hits},
          {"counts", counts},
          {"spheres", spheres},
          {"vectors", {outcome.vectors.cull, outcome.vectors.test}},
          {"hit_batches", {outcome.batches.count, outcome.batches.rays, outcome.batches.hits, outcome.batches.squares}},
          {"seconds", {so_far.make_seconds, outcome.seconds.search}}};
}

SavedRun saved_run_of(const Json& json) {
  SavedRun saved;
  UntilState& state = saved.state;
  json.at("rays").get_to(state.rays);
  json.at("tests").get_to(state.tests);
  json.at("stage").at(0).get_to(state.stage_rays);
  json.at("stage").at(1).get_to(state.stage_is_test);
  json.at("stage").at(2).get_to(state.stage_is_last);
  json.at("stage").at(3).get_to(state.stage_batches);
  PairedBatches::State& batches = state.batches;
  json.at("sums").get_to(batches.sums);
  json.at("pending").get_to(batches.pending);
  json.at("pending_photons").get_to(batches.pending_photons);
  json.at("photons").get_to(batches.photons);
  json.at("pairs").get_to(batches.pairs);
  json.at("earlier").get_to(batches.earlier);
  json.at("products").at(0).get_to(batches.products_of_squares);
  json.at("products").at(1).get_to(batches.squares_of_products);
  sim::Outcome& outcome = saved.so_far.outcome;
  json.at("hits").get_to(outcome.hits);
  json.at("total_hits").get_to(outcome.total_hits);
  for_each_term(outcome.counts, [&](std::string_view term, std::uint64_t& count) {
    json.at("counts").at(std::string(term)).get_to(count);
  });
  for (const Json& one : json.at("spheres"))
    outcome.spheres.push_back(
        {one.at(0).get<std::uint64_t>(), one.at(1).get<std::uint64_t>(), one.at(2).get<std::uint64_t>()});
  json.at("vectors").at(0).get_to(outcome.vectors.cull);
  json.at("vectors").at(1).get_to(outcome.vectors.test);
  json.at("hit_batches").at(0).get_to(outcome.batches.count);
  json.at("hit_batches").at(1).get_to(outcome.batches.rays);
  json.at("hit_batches").at(2).get_to(outcome.batches.hits);
  json.at("hit_batches").at(3).get_to(outcome.batches.squares);
  json.at("seconds").at(0).get_to(saved.so_far.make_seconds);
  json.at("seconds").at(1).get_to(outcome.seconds.search);
  return saved;
}

}  // namespace detp::validate
