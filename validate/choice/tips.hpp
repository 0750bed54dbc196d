#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "choice.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// Tips: which change of an input changes a choice.
namespace detp::validate {

/// Candidates whose times differ by less than this share cannot be told apart: about the error of unit costs.
inline constexpr double distinguishable = 0.15;

enum class TipInput { disc_radius, rays, threads };

inline constexpr std::array tip_inputs{TipInput::disc_radius, TipInput::rays, TipInput::threads};

enum class TipKind {
  technique,      ///< another technique is chosen
  not_ruled_out,  ///< another technique may be faster, but its time is not known well enough
  parameters,     ///< the same technique with other parameters is faster, by more than `distinguishable`
  threads         ///< the same technique takes another number of threads
};

/// Inputs of a choice.
struct TipInputs {
  double disc_radius = 0;  ///< length
  double rays = 0;         ///< number of rays, a whole number
  double threads = 1;      ///< most threads, a whole number

  [[nodiscard]] double& operator[](TipInput input) {
    return input == TipInput::disc_radius ? disc_radius : input == TipInput::rays ? rays : threads;
  }
};

/// The choice for some inputs.
struct ChoiceThere {
  Prediction best;
  /// Predicted time with the parameters of the present choice. That of `best`, if the technique is another one.
  double unchanged_seconds = 0;
  std::vector<Technique> not_ruled_out = {};  ///< techniques that may be faster
};

/// The choice for some inputs; nothing if there is none.
using ChooseForInputs = std::function<std::optional<ChoiceThere>(const TipInputs&)>;

/// How far and how closely the inputs are examined.
struct TipSearch {
  double factor = 4;     ///< radius and number of rays are multiplied and divided by up to this factor
  int steps = 4;         ///< in as many equal steps each way
  int most_threads = 1;  ///< numbers of threads: thread_numbers of this
};

/// A change of one input that changes the choice.
struct Tip {
  TipInput input = TipInput::disc_radius;
  TipKind kind = TipKind::technique;
  double at = 0;             ///< value of the input, in the input's unit
  double ratio = 1;          ///< the same over the present value
  Candidate candidate = {};  ///< the choice there; of not_ruled_out only the technique, with default parameters
  int threads = 1;           ///< number of threads of the choice there
};

/// The values of one input that were examined, with the present values of the other inputs.
struct TipRange {
  double least = 0;
  double most = 0;
};

struct Tips {
  std::vector<Tip> tips;                ///< in the order of the inputs
  std::array<TipRange, 3> ranges = {};  ///< one for each TipInput
  std::size_t choices = 0;              ///< that were made to find the tips
  std::size_t inputs = 0;               ///< that were examined; fewer than all if a stop request ended the search

  [[nodiscard]] bool stopped() const { return inputs < ranges.size(); }
  [[nodiscard]] const TipRange& range(TipInput input) const { return ranges[static_cast<std::size_t>(input)]; }
};

/// Changes one input at a time, step by step away from its present value, and makes the choice again. For each kind of
/// change, the first step that has it is searched by bisection: so `at` has the change, and a value at most 5 % (of the
/// number of rays: or one ray) nearer to the present one has not. A change that comes and goes between two steps is not
/// seen. Behind another technique, nothing more is examined.
///
/// Cost       1 + 4 steps choices, one for each other number of threads, and, with the default search, 3 for each tip
[[nodiscard]] Tips find_tips(const TipInputs& present, const TipSearch& search, const ChooseForInputs& choose,
                             const std::stop_token& stop = {});

/// choose_again for other radii, numbers of rays and threads: after a pilot, for radii and rays up to four times larger or
/// smaller (the range for which extrapolated counts were compared with new pilots), by closed forms up to 16 times.
/// `question` must be that of the choice, and have a workload; the choice's index must not be built yet.
///
/// Cost       after a pilot 1.3 to 13 million instructions for 2000 to 86 000 discs and 300 to 3 000 000 rays, 3.0 in @tree
///            with 100 000 photon paths, a tenth to a half of those of the pilot; by closed forms 55 to 236 million in
///            four examples (valgrind --tool=callgrind)
[[nodiscard]] Tips tips_of(const Choice& choice, const Question& question, const Valid<CostTable>& costs);

/// "d = 0.31 or more", "3000 rays or fewer" or "1 thread".
[[nodiscard]] std::string place_of(const Tip& tip);

/// "grid is faster with 3000 rays or fewer (40 % fewer)".
[[nodiscard]] std::string text_of(const Tip& tip);

/// "d from 0.25 to 4".
[[nodiscard]] std::string text_of(TipInput input, const TipRange& range);

}  // namespace detp::validate

namespace detp {
template <>
inline constexpr std::array<std::string_view, 3> choice_names<validate::TipInput>{"disc_radius", "rays", "threads"};
template <>
inline constexpr std::array<std::string_view, 4> choice_names<validate::TipKind>{"technique", "not ruled out",
                                                                                 "parameters", "threads"};
}  // namespace detp
