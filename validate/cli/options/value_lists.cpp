#include "value_lists.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    parts.emplace_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

/// Digits behind the decimal point of a number: 2 for "0.05" and "5e-2", 0 for "1e3".
int decimals(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = number.substr(0, exponent_at).find('.');
  const auto behind = point == std::string_view::npos ? 0 : static_cast<int>(exponent_at - point - 1);
  int exponent = 0;
  if (exponent_at < number.size()) {
    std::string_view digits = number.substr(exponent_at + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  }
  return std::clamp(behind - exponent, 0, 400);
}

[[noreturn]] void refuse_rows(std::string_view what, double rows) {
  throw std::length_error(
      fmt::format("{} {:.6g} rows; one command makes at most {}: give fewer values", what, rows, most_rows));
}

struct Range {
  double start = 0;
  double end = 0;
  double step = 0;
  int decimals = 0;  ///< number of decimals of the values

  [[nodiscard]] double value(double i) const {
    const std::string text = fmt::format("{:.{}f}", start + i * step, decimals);
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  }
};

[[noreturn]] void refuse_range(std::string_view option, std::string_view item) {
  throw std::invalid_argument(
      fmt::format("a range of {} is start:end:step, as 0.3:0.9:0.05, and comes from its start to its end (got {})",
                  option, detp::quoted(item)));
}

Range range_of(std::string_view option, std::string_view item, std::vector<std::string> parts) {
  if (parts.size() != 3) refuse_range(option, item);
  const Range range{parse_number(option, parts[0]), parse_number(option, parts[1]), parse_number(option, parts[2]),
                    std::max(decimals(parts[0]), decimals(parts[2]))};
  if (range.step == 0 || !((range.end - range.start) / range.step >= 0)) refuse_range(option, item);
  return range;
}

void append_range(std::string_view option, const std::string& item, bool counts, std::vector<std::string>& values) {
  std::vector<std::string> parts = split(item, ':');
  if (counts)
    for (std::string& part : parts) part = without_count_suffix(part);
  const auto signs =
      std::count_if(parts.begin(), parts.end(), [](const std::string& part) { return part.ends_with('%'); });
  const bool percentages = signs > 0;
  if (percentages && signs != std::ssize(parts)) refuse_range(option, item);
  if (percentages)
    for (std::string& part : parts) part.pop_back();
  const Range range = range_of(option, item, parts);
  const double steps = std::round((range.end - range.start) / range.step);
  if (!(static_cast<double>(values.size()) + steps <= most_rows + 1.0))
    refuse_rows(fmt::format("{} asks for", option), steps + 1);
  for (double i = 0; i <= steps; ++i) {
    const double value = range.value(i);
    if (range.step > 0 ? value > range.end : value < range.end) break;
    values.push_back(fmt::format("{}{}", value, percentages ? "%" : ""));
  }
}

/// Ranges A:B of seeds with the step 1.
std::string with_steps(const std::string& text) {
  std::vector<std::string> items = split(text, ',');
  for (std::string& item : items)
    if (std::ranges::count(item, ':') == 1) item += ":1";
  return fmt::format("{}", fmt::join(items, ","));
}

}  // namespace

std::string one_of(std::string_view option, const std::string& text, const std::vector<std::string_view>& names) {
  if (std::find(names.begin(), names.end(), text) == names.end())
    throw std::invalid_argument(fmt::format("{} must be one of {} (got {}){}", option, fmt::join(names, ","),
                                            detp::quoted(text), did_you_mean(text, names)));
  return text;
}

void require_rows(std::size_t rows, std::size_t times) {
  const double all = static_cast<double>(rows) * static_cast<double>(times);
  if (all > most_rows) refuse_rows("all combinations of the values make", all);
}

std::vector<std::string> words_of(std::string_view text) { return split(text, ','); }

std::vector<std::string> values_of(std::string_view option, std::string_view text, bool counts) {
  std::vector<std::string> values;
  for (const std::string& item : split(text, ',')) {
    if (item.find(':') == std::string::npos)
      values.push_back(item);
    else
      append_range(option, item, counts, values);
    if (values.size() > most_rows) refuse_rows(fmt::format("{} asks for", option), static_cast<double>(values.size()));
  }
  return values;
}

CLI::Option* ValueLists::add(CLI::App& command, const std::string& option, Values values, Kind kind, Set set,
                             const std::string& help) {
  const std::string type = kind == Kind::words ? "NAME" : "N";
  if (values == Values::one) return command.add_option_function<std::string>(option, set, help)->type_name(type);
  Option& added = *options_.emplace_back(std::make_unique<Option>(Option{option, kind, std::move(set), {}, {}}));
  return command
      .add_option_function<std::string>(
          option, [&added](const std::string& text) { added.text = text; }, help)
      ->type_name(type + ",...");
}

std::size_t ValueLists::rows() {
  std::size_t rows = 1;
  for (const auto& option : options_) {
    if (option->text.empty()) continue;
    if (option->values.empty())
      option->values =
          option->kind == Kind::words
              ? words_of(option->text)
              : values_of(option->name, option->kind == Kind::seeds ? with_steps(option->text) : option->text,
                          option->kind == Kind::counts);
    require_rows(rows, option->values.size());
    rows *= option->values.size();
  }
  return rows;
}

void ValueLists::choose_row(std::size_t row) {
  for (auto option = options_.rbegin(); option != options_.rend(); ++option) {
    const std::vector<std::string>& values = (*option)->values;
    if (values.empty()) continue;
    (*option)->set(values[row % values.size()]);
    row /= values.size();
  }
}

}  // namespace detp::cli
