#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// Properties of the mesh from which the samples come; zeros without a mesh.
struct SurfaceFacts {
  double area = 0;         ///< of all triangles
  double edge_length = 0;  ///< mean
};

/// What effects are looked for in. It refers to the problem, which must outlive it.
struct EffectSample {
  EffectSample(const Problem& of, const SurfaceFacts& mesh, std::stop_token stop_token);

  const Problem& problem;
  SurfaceFacts surface;
  std::stop_token stop;
  std::vector<std::size_t> rays;   ///< stratified, at most 2048
  std::vector<std::size_t> discs;  ///< stratified, at most 8192
};

/// The values of an evidence with which its effect is on.
struct Threshold {
  enum class Side {
    above,  ///< greater than `at`
    below,  ///< less than `at`
    apart   ///< farther than `tolerance` from `at`
  };
  Side side = Side::above;
  double at = 0;
  double tolerance = 0;

  [[nodiscard]] bool passed(double value) const;
  /// Distance from the value to the nearest value at which the effect would be switched.
  [[nodiscard]] double distance(double value) const;
};

/// Measured evidence.
struct Finding {
  double value = 0;
  double standard_error = 0;  ///< of the value; 0 if it is computed from all rays and discs
  /// Sets what predictions take from the effect. Called only if the effect is on.
  std::function<void(Workload&)> apply = [](Workload&) {};
};

/// A way in which rays and discs deviate from the assumptions of the models.
struct Effect {
  std::string_view name;      ///< "finite paths"; in options with hyphens
  std::string_view evidence;  ///< what the value is
  Threshold threshold;
  /// A meaning of the input, not an approximation: nobody can switch it. It is on if the input says so.
  bool is_input = false;
  Finding (*find)(const EffectSample&);
  /// The value for a workload that is given by numbers.
  double (*of_numbers)(const Workload&);
};

}  // namespace detp::sim
