#include <fmt/format.h>

#include "closed_forms.hpp"
#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

using Answer = ModelAnswer;

/// A field that is left out where there is no value.
template <class Part, class Value>
Field<Part> known_field(const char* name, const char* unit, const char* meaning, std::optional<Value> Part::*value) {
  return Field<Part>(name, unit, meaning, value).where_known();
}

const Fields<CacheStops>& stop_fields() {
  static const Fields<CacheStops> fields{
      {"k", "", "spheres of the cache", &CacheStops::spheres},
      {"k_max", "", "spheres that can hold a disc, by this form", &CacheStops::most},
      {"k_best", "", "k with the least time, by this form", &CacheStops::best},
      {"k_published", "", "spheres that can hold a disc, by the paper's form", &CacheStops::published},
      {"k_corrected", "", "spheres that can hold a disc, by ours", &CacheStops::corrected}};
  return fields;
}

const Fields<IndexFigures>& index_fields() {
  using Index = IndexFigures;
  static const Fields<Index> fields{
      Field<Index>("depth", "", "of the octree", &Index::depth)
          .where_known()
          .in_json_alone(),  // a column of candidates
      {"cells_per_line", "", "that a line crosses if it hits the index's box", &Index::cells_per_line},
      {"discs_per_cell", "", "references to discs", &Index::discs_per_cell},
      {"tests_per_line", "", "ray-disc tests of a line that hits the index's box", &Index::tests_per_line},
      known_field("cells_per_disc", "", "that a disc overlaps", &Index::cells_per_disc),
      known_field("index_bytes", "bytes", "of the index", &Index::bytes)};
  return fields;
}

Fields<Answer> time_fields() {
  using Times = ModelTimes;
  // Text shows an index's tests after its steps, as they happen; the columns of tables are in one order.
  const Field<Answer> intersect("intersect_time", "unit of the costs", "T_I: testing rays with discs",
                                [](const Answer& answer) { return answer.times.intersect; });
  const auto time = [](const char* name, const char* meaning, std::optional<double> Times::*value) {
    return Field<Answer>(name, "unit of the costs", meaning,
                         [value](const Answer& answer) { return answer.times.*value; })
        .where_known();
  };
  Field<Answer> beside_rebuilds = intersect;
  beside_rebuilds.value = [](const Answer& answer) {
    return answer.index || !answer.times.intersect ? left_out() : Json(*answer.times.intersect);
  };
  Field<Answer> after_steps = intersect;
  after_steps.value = [](const Answer& answer) {
    return answer.index && answer.times.intersect ? Json(*answer.times.intersect) : left_out();
  };
  return {time("rebuild_time", "T_R: making lists of rays", &Times::rebuild),
          intersect.where_known().in_tables_alone(),
          beside_rebuilds.in_json_alone(),
          time("copy_time", "copying rays", &Times::copy),
          time("order_time", "sorting discs", &Times::order),
          time("build_time", "building the index", &Times::build),
          time("traverse_time", "walking through cells", &Times::traverse),
          after_steps.in_json_alone(),
          {"total_time", "unit of the costs", "T", [](const Answer& answer) { return answer.times.total; }},
          time("rebuild_time_few_samples", "T_R by the paper's form for few samples", &Times::rebuild_few_samples),
          time("balanced_time", "of a balanced octree, by the paper", &Times::balanced)};
}

Field<Answer> extrapolated_field() {
  return {"extrapolated", "", "the workload is outside of what was compared with counts",
          [](const Answer& answer) { return !answer.extrapolated_because.empty(); }};
}

const Fields<ModelLevel>& level_fields() {
  using Level = ModelLevel;
  static const Fields<Level> fields{
      {"i", "", "number of the sphere or level", &Level::i},
      Field<Level>("radius", "length", "of the sphere", &Level::radius).in({{"radius_i"}}),
      Field<Level>("rays", "", "that cross it", &Level::rays).in({{"rays_i"}}),
      known_field("listed", "", "rays in its list", &Level::listed).in({{"listed_i"}}),
      Field<Level>("rebuilds", "", "of its list; of a level: its spheres", &Level::rebuilds).in({{"rebuilds_i"}}),
      Field<Level>("rebuild_cost", "unit of the costs", "of one rebuild", &Level::rebuild_cost)
          .in({{"rebuild_cost_i"}}),
      known_field("samples", "", "in a sphere of the level", &Level::samples).in({{"samples_i"}})};
  return fields;
}

const Fields<Outlook>& growth_fields() {
  static const Fields<Outlook> fields{
      known_field("growth_power", "", "p: with discs as large as samples are apart, T grows as n_P^p (log n_P)^q",
                  &Outlook::growth_power),
      known_field("growth_logarithms", "", "q", &Outlook::growth_logarithms)};
  return fields;
}

/// Numbers of spheres, and whether the prediction is extrapolated.
Columns main_stop_columns() { return columns_of(stop_fields()) + columns_of(Fields<Answer>{extrapolated_field()}); }

const Fields<ModelRequest>& model_input_fields() {
  using Input = Field<ModelRequest>;
  static const Fields<ModelRequest> fields{
      known_field("curvature", "1/length²", "Laplacian of the density of hits, over it", &ModelRequest::curvature),
      known_field("target_error", "", "of the irradiance, relative", &ModelRequest::target_error),
      Input("form", "", "published: the paper's; corrected: ours",
            [](const ModelRequest& one) { return name(one.form); }),
      Input("engine", "", "simd or plain", [](const ModelRequest& one) { return name(one.engine); }).in_json_alone(),
      Input("levels", "", "at most so many spheres are listed", &ModelRequest::levels).in_json_alone()};
  return fields;
}

const Fields<ModelRequest>& cost_fields() {
  static const Fields<ModelRequest> fields = [] {
    std::vector<Column> columns;
    for (const UnitCostTerm& one : unit_cost_terms)
      columns.push_back({fmt::format("cost_{}", one.symbol), fmt::format("/{}", one.symbol)});
    const auto costs_json = [](const ModelRequest& request) {
      Json costs;
      for (const UnitCostTerm& one : unit_cost_terms) costs[std::string(one.symbol)] = request.costs.*one.cost;
      return costs;
    };
    return Fields<ModelRequest>{
        Field<ModelRequest>("unit_costs", "seconds, or 1 each", "of each operation", costs_json).in(columns)};
  }();
  return fields;
}

Json spheres_json(const Answer& answer) {
  if (!answer.spheres) return left_out();
  Json spheres = Json::array();
  for (const ModelLevel& level : *answer.spheres) spheres.push_back(json_of(level_fields(), level));
  return spheres;
}

Json counts_json(const Answer& answer) { return answer.counts ? to_json(*answer.counts) : left_out(); }

Json notes_json(const Answer& answer) { return answer.outlook.notes.empty() ? left_out() : Json(answer.outlook.notes); }

/// All of the answer, as text shows it.
const Fields<Answer>& answer_fields() {
  using One = Field<Answer>;
  static const Fields<Answer> fields =
      Fields<Answer>{One("technique", "", "that the closed forms describe",
                         [](const Answer& one) { return name(one.candidate.technique); })
                         .in_json_alone(),
                     One("parameters", "", "of the technique", [](const Answer& one) { return to_json(one.candidate); })
                         .in_json_alone(),
                     One("form", "", "published: the paper's; corrected: ours",
                         [](const Answer& one) { return name(one.form); })} +
      fields_of_part<Answer>(stop_fields(), &Answer::stops) + fields_of_part<Answer>(index_fields(), &Answer::index) +
      Fields<Answer>{One("spheres", "", "of a cache, or the levels of a hierarchy", spheres_json).in_json_alone()} +
      time_fields() + Fields<Answer>{One("counts", "", "expected operations of a search", counts_json).as_counts("")} +
      fields_of_part<Answer>(growth_fields() + error_fields(), &Answer::outlook) +
      Fields<Answer>{One("notes", "", "what some of these numbers mean", notes_json).in_json_alone(),
                     extrapolated_field(),
                     One("extrapolated_because", "", "reasons", &Answer::extrapolated_because).in_json_alone()};
  return fields;
}

}  // namespace

const Fields<Outlook>& error_fields() {
  // Text shows the best radius after the nearest photons, tables before.
  static const Field<Outlook> radius = known_field(
      "best_density_radius", "length", "disc radius of the least density_error", &Outlook::best_density_radius);
  static const Fields<Outlook> fields{
      known_field("uniform_field_deviation", "", "relative standard deviation of a disc's irradiance, uniform field",
                  &Outlook::uniform_field_deviation),
      known_field("rays_for_deviation", "", "rays at which this is the target error", &Outlook::rays_for_deviation),
      known_field("mean_disc_hits", "", "mean number of hits of a disc", &Outlook::mean_disc_hits),
      known_field("mean_disc_deviation", "", "relative deviation of a disc with the mean number of hits",
                  &Outlook::mean_disc_deviation),
      known_field("rays_for_mean_disc", "", "rays at which this is the target error", &Outlook::rays_for_mean_disc),
      known_field("density_bias", "", "of discs, relative, for the curvature", &Outlook::density_bias),
      known_field("density_error", "", "noise and bias of discs together, relative", &Outlook::density_error),
      radius.in_tables_alone(),
      known_field("best_nearest", "", "number of nearest photons with the least error", &Outlook::best_nearest),
      known_field("nearest_error", "", "error with this number, relative", &Outlook::nearest_error),
      known_field("plain_nearest_error", "", "the same without the correction of the radius",
                  &Outlook::plain_nearest_error),
      radius.in_json_alone(),
      known_field("photons_for_error", "", "photons for the target error, discs of the best radius",
                  &Outlook::photons_for_error),
      known_field("radius_for_error", "length", "this radius", &Outlook::radius_for_error),
      known_field("photons_for_nearest_error", "", "photons for the target error, best number of nearest photons",
                  &Outlook::photons_for_nearest_error),
      known_field("nearest_for_error", "", "this number", &Outlook::nearest_for_error)};
  return fields;
}

std::vector<FieldText> describe_model() {
  return describe_fields(answer_fields()) + describe_fields(level_fields()) + describe_fields(model_input_fields()) +
         describe_fields(cost_fields());
}

Json inputs_of(const ModelRequest& request) {
  Json json = json_of(model_input_fields(), request);
  json.update(json_of(cost_fields(), request));
  return json;
}

Json json_of(const ModelAnswer& answer) { return json_of(answer_fields(), answer); }

Columns model_columns() {
  return columns_of(model_input_fields()) + main_stop_columns() + columns_of(time_fields()) +
         columns_of(index_fields()) + columns_of(growth_fields()) + columns_of(error_fields()) + count_columns() +
         columns_of(cost_fields()) + columns_of(level_fields());
}

Columns main_model_columns(bool with_errors) {
  return main_stop_columns() + (with_errors ? columns_of(error_fields()) : Columns{}) + columns_of(time_fields()) +
         columns_of(index_fields());
}

std::vector<Json> cells_of(const ModelRequest& request, const ModelAnswer& answer) {
  Json shared = candidate_cells(answer.candidate);
  for (const Json& more :
       {cells_of(model_input_fields(), request), cells_of(cost_fields(), request), cells_of(answer_fields(), answer)})
    shared.update(more);
  std::vector<Json> rows;
  for (const ModelLevel& level : answer.spheres.value_or(std::vector<ModelLevel>{})) {
    rows.push_back(shared);
    rows.back().update(cells_of(level_fields(), level));
  }
  return rows.empty() ? std::vector{shared} : rows;
}

}  // namespace detp::validate
