#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

/// A technique's parameter as a row of a table. Checks, descriptions, JSON, command-line options and the variants that
/// tests run all follow from the table.
namespace detp {

/// The names of an enumeration's values, in their order from 0; empty for a type that is not a choice.
template <class E>
inline constexpr std::array<std::string_view, 0> choice_names{};

template <class E>
concept NamedEnum = std::is_enum_v<E> && !choice_names<E>.empty();

/// The name on the command line and in files.
template <NamedEnum E>
[[nodiscard]] constexpr std::string_view name(E value) {
  return choice_names<E>[static_cast<std::size_t>(value)];
}

/// The value with that name; nullopt if there is none.
template <NamedEnum E>
[[nodiscard]] constexpr std::optional<E> choice_named(std::string_view wanted) {
  for (std::size_t i = 0; i < choice_names<E>.size(); ++i)
    if (choice_names<E>[i] == wanted) return static_cast<E>(i);
  return std::nullopt;
}

/// A parameter's value: a real number, a whole number, or the name of a choice.
using ParameterValue = std::variant<double, std::int64_t, std::string_view>;

/// One row of a technique's table. `Parameters` is the variant of all techniques' parameters.
template <class Parameters>
struct ParameterRecord {
  std::string_view name;    ///< on the command line: "fan-out"; in JSON with underscores
  std::string_view symbol;  ///< in descriptions: "Q"
  std::string_view what;    ///< in messages: "radius ratio Q"
  std::string_view help;    ///< what it does, in a few words
  double least = 0;         ///< smallest value of a number; for a ratio 0 and 1 are excluded
  double most = 0;
  ParameterValue small = std::int64_t{0};          ///< a value for few samples, for tests and first trials
  std::span<const std::string_view> choices = {};  ///< names of a choice
  double step = 1.4;                               ///< factor between neighbouring values; 0: neighbours differ by 1
  ParameterValue (*get)(const Parameters&) = nullptr;
  void (*set)(Parameters&, const ParameterValue&) = nullptr;
};

/// Reads and writes the member of a technique's parameters, as a ParameterValue.
template <class Parameters, auto member>
struct ParameterAccess;

template <class Parameters, class Own, class T, T Own::*member>
struct ParameterAccess<Parameters, member> {
  static ParameterValue get(const Parameters& parameters) {
    const T& value = std::get<Own>(parameters).*member;
    if constexpr (std::is_enum_v<T>)
      return name(value);
    else if constexpr (std::is_integral_v<T>)
      return static_cast<std::int64_t>(value);
    else
      return value;
  }

  /// The value must be of the parameter's kind.
  static void set(Parameters& parameters, const ParameterValue& value) {
    T& own = std::get<Own>(parameters).*member;
    if constexpr (std::is_enum_v<T>)
      own = choice_named<T>(std::get<std::string_view>(value)).value();
    else if constexpr (std::is_integral_v<T>)
      own = static_cast<T>(std::get<std::int64_t>(value));
    else
      own = std::get<double>(value);
  }
};

}  // namespace detp
