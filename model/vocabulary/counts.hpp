#pragma once

#include <array>
#include <cstddef>
#include <string_view>

/// The counted operations of a technique: a prediction (double, an expectation) or an observation (std::uint64_t). A
/// term means the same for every technique and engine.
namespace detp {

template <class T>
struct Counts {
  T loaded{};      ///< rays brought into a search
  T segments{};    ///< the same rays, if some of them end: then each test also compares with the ray's ends
  T cull_tests{};  ///< ray-sphere and ray-box tests of rays in lists
  T culls{};       ///< lists made: for each block of rays, one for each sphere or box
  T listed{};      ///< rays added to these lists
  T visits{};      ///< (disc, list) pairs: discs tested against a list of at least one ray
  T disc_tests{};  ///< ray-disc tests
  T doubtful{};    ///< ray-disc tests repeated in double because single precision was not certain
  T steps{};       ///< grid cells visited by rays
  T nodes{};       ///< tree nodes, inner nodes and leaves, visited by single rays or single discs
  T references{};  ///< disc references stored in an index
  T placements{};  ///< insertions of a disc into a cell or node while an index is built, at all levels
  T made{};        ///< nodes made of a tree of boxes (of its binary tree) or of spheres
  T sorted{};      ///< discs sorted along a curve
  T hits{};        ///< (ray, disc) pairs found
  /// Memory that a search touches for the first time, unless an earlier search left it its arrays. Not counted by `sim`: see bytes_touched.hpp
  T bytes_touched{};

  bool operator==(const Counts&) const = default;
  constexpr Counts& operator+=(const Counts& more);
};

/// A term and its name in results.
template <class T>
struct CountTerm {
  std::string_view name;
  T Counts<T>::*term;
};

/// All terms, in the order in which results list them.
template <class T>
inline constexpr std::array<CountTerm<T>, 16> count_terms{{{"loaded", &Counts<T>::loaded},
                                                           {"segments", &Counts<T>::segments},
                                                           {"cull_tests", &Counts<T>::cull_tests},
                                                           {"culls", &Counts<T>::culls},
                                                           {"listed", &Counts<T>::listed},
                                                           {"visits", &Counts<T>::visits},
                                                           {"disc_tests", &Counts<T>::disc_tests},
                                                           {"doubtful", &Counts<T>::doubtful},
                                                           {"steps", &Counts<T>::steps},
                                                           {"nodes", &Counts<T>::nodes},
                                                           {"references", &Counts<T>::references},
                                                           {"placements", &Counts<T>::placements},
                                                           {"made", &Counts<T>::made},
                                                           {"sorted", &Counts<T>::sorted},
                                                           {"hits", &Counts<T>::hits},
                                                           {"bytes_touched", &Counts<T>::bytes_touched}}};

template <class T>
constexpr Counts<T>& Counts<T>::operator+=(const Counts& more) {
  for (const auto& [name, term] : count_terms<T>) this->*term += more.*term;
  return *this;
}

/// Calls visit(name, value) for each term.
template <class T, class Visit>
constexpr void for_each_term(const Counts<T>& counts, Visit&& visit) {
  for (const auto& [name, term] : count_terms<T>) visit(name, counts.*term);
}
template <class T, class Visit>
constexpr void for_each_term(Counts<T>& counts, Visit&& visit) {
  for (const auto& [name, term] : count_terms<T>) visit(name, counts.*term);
}

/// Ray-sphere, ray-box and ray-disc tests together: a single number that compares techniques without measuring times.
template <class T>
[[nodiscard]] constexpr T tests(const Counts<T>& counts) {
  return counts.cull_tests + counts.disc_tests;
}

/// An observation converted to a prediction's record.
template <class T>
[[nodiscard]] constexpr Counts<double> as_expected(const Counts<T>& counts) {
  Counts<double> expected;
  for (std::size_t i = 0; i < count_terms<T>.size(); ++i)
    expected.*count_terms<double>[i].term = static_cast<double>(counts.*count_terms<T>[i].term);
  return expected;
}

}  // namespace detp
