#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "number_option.hpp"

/// Options with several values, so that one command line asks for a table of many rows.
namespace detp::cli {

/// The most rows that one command line may ask for.
inline constexpr std::size_t most_rows = 20'000;

/// The values of "1%,2%,4%" and "0.3:0.9:0.05", or of both mixed: a list of values and of ranges start:end:step, whose
/// end is included where a step meets it. A range's values are what a reader would write: 0.35, not
/// 0.35000000000000003. Throws std::invalid_argument, naming the option, for a malformed range and for more than
/// most_rows values.
[[nodiscard]] std::vector<std::string> values_of(std::string_view option, std::string_view text);

/// "0.3,0.5" split at its commas alone.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

/// The text, if it is one of the names. Throws std::invalid_argument with all of them else.
[[nodiscard]] std::string one_of(std::string_view option, const std::string& text,
                                 const std::vector<std::string_view>& names);

/// Throws std::length_error for more rows than most_rows: those of one table times those of another.
void require_rows(std::size_t rows, std::size_t times = 1);

/// Whether a command makes a row for each value of an option, or takes one value alone.
enum class Values { one, many };

/// Options with values that each make a row. All combinations count, the option declared last changing fastest.
class ValueLists {
 public:
  using Set = std::function<void(const std::string& value)>;
  enum class Kind { numbers, words };

  /// `set` puts one value in its place, and throws std::invalid_argument where it cannot: while parsing where the
  /// command takes one value, by `choose_row` else.
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

  /// Combinations; 1 where no option has several values. Throws as values_of does, and std::length_error for more than
  /// most_rows combinations.
  [[nodiscard]] std::size_t rows();

  /// Sets every option to its value in that row.
  void choose_row(std::size_t row);

 private:
  struct Option {
    std::string name;
    Kind kind;
    Set set;
    std::string text;                 ///< as given; empty: not given
    std::vector<std::string> values;  ///< of the text, once asked for
  };
  std::vector<std::unique_ptr<Option>> options_;
};

}  // namespace detp::cli
