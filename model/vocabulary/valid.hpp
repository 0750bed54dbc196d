#pragma once

#include <concepts>
#include <type_traits>

namespace detp {

/// A T for which `check(value)` did not throw. Use Valid<T>, which is const: the value cannot change after its check.
template <class T>
struct Checked : T {
  /// Throws as check does.
  Checked(const T& plain) : T(plain) { check(plain); }

  /// Makes the value from the members of an aggregate, as in {Technique::grid, GridParameters{64}}. Throws as check
  /// does.
  template <class... Members>
  requires(!(std::derived_from<std::remove_cvref_t<Members>, T> || ...)) && requires(Members... m) { T{m...}; }
  Checked(const Members&... members) : Checked(T{members...}) {}

  /// For a part of a checked value, such as the parameters of a candidate: the part is not checked again.
  template <class Whole>
  Checked(const Checked<Whole>&, const T& covered) : T(covered) {}
};

/// The parameter type of a function that requires a valid T. A plain T is checked when it converts to this type; a
/// Valid<T> is passed on by reference.
template <class T>
using Valid = const Checked<T>;

}  // namespace detp
