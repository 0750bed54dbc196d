#pragma once

#include <concepts>
#include <type_traits>

/// A value that passed its check: made where a value comes in, and passed on without a second check.
namespace detp {

/// A T for which `check(value)` did not throw. Use it as Valid<T>, which is const, so that it stays as it was checked.
template <class T>
struct Checked : T {
  /// Throws as check does.
  Checked(const T& plain) : T(plain) { check(plain); }

  /// From the members of an aggregate, as in {Technique::grid, GridParameters{64}}. Throws as check does.
  template <class... Members>
  requires(!(std::derived_from<std::remove_cvref_t<Members>, T> || ...)) && requires(Members... m) { T{m...}; }
  Checked(const Members&... members) : Checked(T{members...}) {}

  /// A value that the check of another one covers, as the parameters of a candidate: not checked again.
  template <class Whole>
  Checked(const Checked<Whole>&, const T& covered) : T(covered) {}
};

/// What a function takes that must not see an invalid T. A plain T converts to it, and is checked then; a Valid<T> is
/// passed on by reference.
template <class T>
using Valid = const Checked<T>;

}  // namespace detp
