#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "all_effects.hpp"
#include "detp/sim/search/disc_summary.hpp"

/// Measures what the models need of rays and discs, with the effects that the evidence calls for.
namespace detp::sim {

/// Which effects predictions take into account, as --effects says.
class EffectSelection {
 public:
  /// Those whose evidence passes its threshold by more than its standard error.
  EffectSelection() = default;

  /// "auto", "none", "all", or names separated by commas, with spaces or hyphens. Throws std::invalid_argument for
  /// anything else; the message lists the names.
  explicit EffectSelection(std::string_view text);

  [[nodiscard]] bool is_on(const Effect& effect, double value, double standard_error) const;
  /// Whether the evidence decides.
  [[nodiscard]] bool is_decided_by_evidence(const Effect& effect) const { return automatic_ || effect.is_input; }
  /// As the constructor reads it.
  [[nodiscard]] std::string text() const;

 private:
  bool automatic_ = true;
  std::vector<const Effect*> on_;
};

/// What was found of an effect.
struct EffectReport {
  const Effect* effect = nullptr;
  bool on = false;
  double value = 0;
  double standard_error = 0;
  double seconds = 0;       ///< for its evidence, and if it is on, for what predictions take from it
  std::string reason = {};  ///< why it is on or off, in words
  bool decided_by_evidence = true;

  /// The evidence decides, and the value is within two standard errors of switching, or within 2 % of
  /// the threshold (a fifth of its tolerance).
  [[nodiscard]] bool is_close() const;
};

struct Observed {
  Workload workload;
  std::vector<EffectReport> effects = {};  ///< one for each of all_effects
  std::size_t rays = 0;                    ///< sampled
  std::size_t discs = 0;                   ///< sampled
  double seconds = 0;                      ///< for all of it
};

/// The workload of the problem if there are no effects: lines, and samples that fill the volume of their box, with discs of the root
/// mean square radius, both of whose faces count. Needs no evidence.
[[nodiscard]] Workload without_effects(const Problem& problem);
/// The same of `samples` discs.
[[nodiscard]] Workload without_effects(const DiscSummary& discs, double samples, double rays, bool rays_end);

/// The same with the meanings of the input: which faces count, and radii that differ. Needs no evidence. Throws Stopped.
[[nodiscard]] Workload with_inputs_alone(const Problem& problem, const std::stop_token& stop = {});

/// without_effects, and what the effects add that are on. Throws Stopped if a stop was requested.
[[nodiscard]] Observed observe(const Problem& problem, const SurfaceFacts& surface = {},
                               const EffectSelection& selection = {}, const std::stop_token& stop = {},
                               const EvidenceEffort& effort = {});

/// The effects of a workload that is given by numbers.
[[nodiscard]] std::vector<EffectReport> effects_of_numbers(const Workload& workload);

/// The name with hyphens, as options have it.
[[nodiscard]] std::string option_name(const Effect& effect);

/// "< 0.95", "> 4" or "differs from 1 by more than 0.05": the values with which it is on.
[[nodiscard]] std::string condition(const Threshold& threshold);

}  // namespace detp::sim
