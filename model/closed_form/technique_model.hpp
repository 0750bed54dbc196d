#pragma once

#include <limits>
#include <optional>
#include <stop_token>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "reasons.hpp"

/// The model of a technique: its prediction, its best parameters, and the range in which it was checked.
namespace detp::model {

/// Limits on the parameters searched, and on the search.
struct SearchLimits {
  int most_depth = 14;           ///< of an octree, and of cells with spheres
  double most_cells = 1 << 26;   ///< total number in a grid: 8 bytes each
  double most_references = 1e9;  ///< references to discs in an index: 4 bytes each
  int threads = 1;               ///< most threads of a search, at least 1
  Engine engine = Engine::simd;  ///< whose counts `best` compares; complete and best_of set that of the costs
  std::stop_token stop = {};     ///< ends the search, which then returns what it has found so far
  /// Time of the fastest candidate so far of other techniques, in the unit of the costs. If it is finite, a search may
  /// end early: its parameters make the technique at most 1 % slower than the best ones, or the technique is slower than
  /// this candidate anyway.
  double fastest = std::numeric_limits<double>::infinity();
};

/// Parameters that the user sets by name. The others are chosen.
struct FixedParameters {
  std::vector<std::pair<std::string_view, ParameterValue>> values = {};

  /// The fixed value of the parameter with this name; nullopt if it is not fixed. T must be the type of the value.
  template <class T>
  [[nodiscard]] std::optional<T> value(std::string_view name) const {
    for (const auto& [parameter, value] : values)
      if (parameter == name) return std::get<T>(value);
    return std::nullopt;
  }
};

/// Parameters found by a search.
struct FoundParameters {
  Parameters parameters;
  std::optional<Counts<double>> counts = {};  ///< what `predict` returns for them, if the search has computed it
  bool tuned = true;  ///< false: the search ended early; the best ones would be slower than SearchLimits::fastest
};

struct TechniqueModel {
  /// Expected counts of a search by that engine. Null where there is no closed form.
  Counts<double> (*predict)(const Valid<Workload>&, const Valid<Candidate>&, Engine) = nullptr;

  /// The fastest parameters that have the fixed values; nullopt if no such parameters are within the limits. Not called
  /// if all numbers are fixed.
  std::optional<FoundParameters> (*best)(const Valid<Workload>&, const Valid<UnitCosts>&, const FixedParameters&,
                                         const SearchLimits&) = nullptr;

  /// Adds reasons why the prediction is outside the range in which it was compared with counts.
  void (*uncounted)(const Valid<Workload>&, const Parameters&, Reasons&) = nullptr;
};

}  // namespace detp::model
