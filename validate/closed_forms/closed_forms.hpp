#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "detp/model/techniques/registry.hpp"
#include "detp/validate/base/fields.hpp"

/// What the closed forms say of one technique: `detp model`. Times are in the unit of the costs: if each costs 1, they are counts.
namespace detp::validate {

struct ModelRequest {
  Workload workload;
  Technique technique = Technique::sphere_cache;
  /// Of the technique. The others are the paper's rule for sphere cache, octree and grid, else those with the least predicted time.
  model::FixedParameters parameters = {};
  bool fastest_stop = false;  ///< of a sphere cache: the k with the least time; false: all spheres that can hold a disc
  Form form = Form::corrected;
  UnitCosts costs = {};
  Engine engine = Engine::simd;
  std::int64_t levels = 64;                 ///< at most so many spheres are listed
  std::optional<double> curvature = {};     ///< ∇²f/f of the density f of the hits, 1/length²
  std::optional<double> target_error = {};  ///< of the irradiance, relative
};

/// Numbers of spheres of a cache.
struct CacheStops {
  std::int64_t spheres = 0;    ///< k of this answer
  std::int64_t most = 0;       ///< that can hold a disc
  std::int64_t best = 0;       ///< with the least time
  std::int64_t published = 0;  ///< `most` by the paper's form
  std::int64_t corrected = 0;  ///< `most` by ours
};

/// A sphere of a cache, or all of one level of a hierarchy.
struct ModelLevel {
  std::int64_t i = 0;
  double radius = 0;
  double rays = 0;
  std::optional<double> listed = {};
  double rebuilds = 0;
  double rebuild_cost = 0;
  std::optional<double> samples = {};
};

/// Per line that hits the box of an octree or a grid.
struct IndexFigures {
  std::optional<int> depth = {};  ///< of an octree
  double cells_per_line = 0;
  double discs_per_cell = 0;
  double tests_per_line = 0;
  std::optional<double> cells_per_disc = {};
  std::optional<double> bytes = {};
};

/// What a technique or form does not have is left out.
struct ModelTimes {
  std::optional<double> rebuild = {};
  std::optional<double> intersect = {};
  std::optional<double> copy = {};
  std::optional<double> order = {};
  std::optional<double> build = {};
  std::optional<double> traverse = {};
  double total = 0;
  std::optional<double> rebuild_few_samples = {};
  std::optional<double> balanced = {};
};

/// How the time grows with the number of samples, and how accurate the estimates are.
struct Outlook {
  std::optional<double> growth_power = {};
  std::optional<int> growth_logarithms = {};
  std::optional<double> uniform_field_deviation = {};
  std::optional<double> rays_for_deviation = {};
  std::optional<double> mean_disc_hits = {};
  std::optional<double> mean_disc_deviation = {};
  std::optional<double> rays_for_mean_disc = {};
  std::optional<double> density_bias = {};
  std::optional<double> density_error = {};
  std::optional<double> best_density_radius = {};
  std::optional<double> best_nearest = {};
  std::optional<double> nearest_error = {};
  std::optional<double> plain_nearest_error = {};
  std::optional<double> photons_for_error = {};
  std::optional<double> radius_for_error = {};
  std::optional<double> photons_for_nearest_error = {};
  std::optional<double> nearest_for_error = {};
  std::vector<std::string> notes = {};  ///< what some of these numbers mean
};

struct ModelAnswer {
  Candidate candidate;  ///< with all parameters
  Form form = Form::corrected;
  std::optional<CacheStops> stops = {};
  std::optional<IndexFigures> index = {};
  std::optional<std::vector<ModelLevel>> spheres = {};  ///< of techniques that have some
  ModelTimes times = {};
  std::optional<Counts<double>> counts = {};
  Outlook outlook = {};
  std::vector<std::string> extrapolated_because = {};  ///< outside of what was compared with counts
};

/// Throws std::invalid_argument for a technique without a closed form or without the paper's, for parameters of other techniques, for numbers
/// out of range, and if the time exceeds the largest double; std::length_error if the technique would not fit in memory.
[[nodiscard]] ModelAnswer answer(const ModelRequest& request);

/// See the fields. The deviation of irradiance in a uniform field is known if the rays are lines, both faces count and a disc fits in S₀; else that
/// of a disc with the mean number of hits. Throws std::invalid_argument for numbers out of range.
[[nodiscard]] Outlook outlook(const ModelRequest& request, const Parameters& parameters);

/// The other parameters or the other form, for comparison.
struct ModelComparison {
  std::optional<Candidate> best =
      {};  ///< with the least time by the form; a sphere cache without spheres is brute force
  double best_time = 0;
  std::optional<ModelAnswer> other_form =
      {};  ///< with the same parameters, k its own; nothing if there is no other form
};
[[nodiscard]] ModelComparison compare(const ModelRequest& request, const ModelAnswer& answer);

/// How accurate estimates are: a part of the fields of an answer.
[[nodiscard]] const Fields<Outlook>& error_fields();

/// What the lists of fields say: of an answer, of its spheres and of the inputs.
[[nodiscard]] std::vector<FieldText> describe_model();

/// The inputs that are not of the workload.
[[nodiscard]] Json inputs_of(const ModelRequest& request);

/// In the order in which text shows it.
[[nodiscard]] Json json_of(const ModelAnswer& answer);

/// The columns of a table, after those of the workload and the candidate.
[[nodiscard]] Columns model_columns();
/// Those that short tables show, with or without `error_fields`.
[[nodiscard]] Columns main_model_columns(bool with_errors);

/// A row for each sphere, at least one; without the cells of the workload.
[[nodiscard]] std::vector<Json> cells_of(const ModelRequest& request, const ModelAnswer& answer);

}  // namespace detp::validate
