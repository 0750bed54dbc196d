#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "number_option.hpp"

/// Options with several values: one command line then makes a table with many rows.
namespace detp::cli {

/// The maximum number of rows of one command line.
inline constexpr std::size_t most_rows = 20'000;

/// The values of "1%,2%,4%" and "0.3:0.9:0.05", or of a mixture: a list of values and of ranges start:end:step, whose
/// end is included if a step meets it. A range's values are those that a reader would write: 0.35, not
/// 0.35000000000000003. Throws std::invalid_argument, naming the option, for a malformed range and for more than
/// most_rows values.
[[nodiscard]] std::vector<std::string> values_of(std::string_view option, std::string_view text);

/// "0.3,0.5" split at its commas.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

/// Returns the text if it is one of the names. Otherwise throws std::invalid_argument with all of them.
[[nodiscard]] std::string one_of(std::string_view option, const std::string& text,
                                 const std::vector<std::string_view>& names);

/// Throws std::length_error for more rows than most_rows: the rows of one table times those of another.
void require_rows(std::size_t rows, std::size_t times = 1);

/// Whether a command makes a row for each value of an option, or accepts only one value.
enum class Values { one, many };

/// Options whose values each make a row. All combinations are used; the option declared last changes fastest.
class ValueLists {
 public:
  using Set = std::function<void(const std::string& value)>;
  enum class Kind { numbers, words };

  /// `set` stores one value; it throws std::invalid_argument for an invalid one. It is called during parsing if the
  /// command accepts one value, else by `choose_row`.
  CLI::Option* add(CLI::App& command, const std::string& option, Values values, Kind kind, Set set,
                   const std::string& help);

  /// An option with numbers, and ranges of them.
  template <class Number>
  CLI::Option* add(CLI::App& command, const std::string& option, Values values, Number& number,
                   const std::string& help) {
    return add(
        command, option, values, Kind::numbers,
        [option, &number](const std::string& value) { read_value(option, value, number); }, help);
  }

  /// An option with one of some names.
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

  /// Sets every option to its value in that row.
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
