#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "number_option.hpp"

/// Options with several values: one command line then makes a table with many rows.
namespace detp::cli {

inline constexpr std::size_t most_rows = 20'000;

/// The values of a list of numbers and ranges start:end:step: "1%,2%,4%", "0.3:0.9:0.05" or a mixture. The end of a
/// range is included if a step meets it. Values of a range are rounded to the decimals of start and step: 0.35,
/// not 0.35000000000000003. If `counts`, numbers may have the suffix k, M or G, as 100k:1M:100k. Throws
/// std::invalid_argument, naming the option, for a malformed range, and std::length_error for more than most_rows
/// values.
[[nodiscard]] std::vector<std::string> values_of(std::string_view option, std::string_view text, bool counts = false);

/// "0.3,0.5" split at its commas.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

/// Returns the text if it is one of the names. Otherwise throws std::invalid_argument, listing the names.
[[nodiscard]] std::string one_of(std::string_view option, const std::string& text,
                                 const std::vector<std::string_view>& names);

/// Throws std::length_error if rows × times exceeds most_rows.
void require_rows(std::size_t rows, std::size_t times = 1);

/// The number of values of an option that a command accepts. With `many`, the command makes a row for each value.
enum class Values { one, many };

/// Options that may have several values. Each combination of values makes one row; the option declared last changes
/// fastest.
class ValueLists {
 public:
  using Set = std::function<void(const std::string& value)>;
  enum class Kind {
    numbers,
    counts,  ///< numbers that may have the suffix k, M or G
    seeds,   ///< whole numbers, and ranges A:B
    words
  };

  /// Adds an option. `set` stores one value, or throws std::invalid_argument if the value is invalid. `set` is called
  /// during parsing if the command accepts one value, else by `choose_row`.
  CLI::Option* add(CLI::App& command, const std::string& option, Values values, Kind kind, Set set,
                   const std::string& help);

  template <class Number>
  CLI::Option* add(CLI::App& command, const std::string& option, Values values, Number& number,
                   const std::string& help) {
    return add(
        command, option, values, Kind::numbers,
        [option, &number](const std::string& value) { read_value(option, value, number); }, help);
  }

  /// As cli::add_count.
  CLI::Option* add_count(CLI::App& command, const std::string& option, Values values, std::optional<double>& count,
                         const std::string& help) {
    return add(
        command, option, values, Kind::counts,
        [option, &count](const std::string& value) { count = parse_count(option, value); }, help);
  }

  template <class Text>
  CLI::Option* add_word(CLI::App& command, const std::string& option, Values values, Text& word,
                        std::vector<std::string_view> names, const std::string& help) {
    return add(
        command, option, values, Kind::words,
        [option, &word, names = std::move(names)](const std::string& text) { word = one_of(option, text, names); },
        help);
  }

  /// Number of combinations; 1 if no option has several values. Throws as values_of does, and std::length_error for
  /// more than most_rows combinations.
  [[nodiscard]] std::size_t rows();

  void choose_row(std::size_t row);

 private:
  struct Option {
    std::string name;
    Kind kind;
    Set set;
    std::string text;                 ///< from the command line; empty if absent
    std::vector<std::string> values;  ///< of the text, parsed on first use
  };
  std::vector<std::unique_ptr<Option>> options_;
};

}  // namespace detp::cli
