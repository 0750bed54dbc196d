#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

/// Every number on the command line is a decimal number without anything around it, except for the suffixes of counts and
/// the percent sign of shares. (CLI11 would also accept 0x10, inf and " 5".)
namespace detp::cli {

/// Throws std::invalid_argument, naming the option, unless the text is a decimal number in the range of doubles.
[[nodiscard]] double parse_number(std::string_view option, std::string_view text);

/// Reads a whole number, "1000" or "1e3". Throws as parse_number does, and for a number that is not whole or is outside
/// [least, most].
[[nodiscard]] std::int64_t parse_whole(std::string_view option, std::string_view text,
                                       std::int64_t least = std::numeric_limits<std::int64_t>::min(),
                                       std::int64_t most = std::numeric_limits<std::int64_t>::max());

/// The text with a suffix of counts written as an exponent: "100k" is "100e3", "1.5M" is "1.5e6", "2G" is "2e9". Any other
/// text is returned as it is.
[[nodiscard]] std::string without_count_suffix(std::string_view text);

/// Reads the number of things: "1000", "1e3" or "100k". Throws as parse_number does.
[[nodiscard]] double parse_count(std::string_view option, std::string_view text);

/// Reads a share: "0.05" or "5%". Throws std::invalid_argument, naming the option, for other text.
[[nodiscard]] double parse_share(std::string_view option, std::string_view text);

/// Reads an integer up to 2⁶⁴ - 1, which a double cannot represent. Throws std::invalid_argument, naming the option.
[[nodiscard]] std::uint64_t parse_seed(std::string_view option, std::string_view text);

/// Seeds from the first to the last.
struct SeedRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// Reads "1:100". Throws std::invalid_argument, naming the option.
[[nodiscard]] SeedRange parse_seeds(std::string_view option, std::string_view text);

inline void read_value(std::string_view option, std::string_view text, double& value) {
  value = parse_number(option, text);
}
inline void read_value(std::string_view option, std::string_view text, std::int64_t& value) {
  value = parse_whole(option, text);
}
inline void read_value(std::string_view option, std::string_view text, int& value) {
  value = static_cast<int>(parse_whole(option, text, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}
inline void read_value(std::string_view /*option*/, std::string_view text, std::string& value) { value = text; }
template <class T>
void read_value(std::string_view option, std::string_view text, std::optional<T>& value) {
  read_value(option, text, value.emplace());
}

/// Adds an option with one number. `value` is a double, int or std::int64_t, or a std::optional of these, and must
/// outlive the parser.
template <class Number>
CLI::Option* add_number(CLI::App& command, const std::string& option, Number& value, const std::string& help) {
  return command
      .add_option_function<std::string>(
          option, [option, &value](const std::string& text) { read_value(option, text, value); }, help)
      ->type_name("N");
}

/// Adds an option for the number of things, which accepts 100k. `value` must outlive the parser.
template <class Count>
CLI::Option* add_count(CLI::App& command, const std::string& option, Count& value, const std::string& help) {
  return command
      .add_option_function<std::string>(
          option, [option, &value](const std::string& text) { value = parse_count(option, text); }, help)
      ->type_name("N");
}

}  // namespace detp::cli
