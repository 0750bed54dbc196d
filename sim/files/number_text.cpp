#include "number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace detp::sim {
namespace {

constexpr std::string_view blanks = " \t\v\f";

template <class Number>
std::errc parse_whole(std::string_view text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return stop == end ? error : std::errc::invalid_argument;
}

/// For a number outside the range of long double: returns true if it is too large, false if it is too near to zero.
/// Adds the exponent to the place of the first non-zero digit relative to the point. The sign of the sum decides.
bool too_large(std::string_view text) {
  const std::size_t e = text.find_first_of("eE");
  const std::string_view mantissa = text.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  std::string_view exponent = e == std::string_view::npos ? std::string_view{} : text.substr(e + 1);
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  double places = 0;
  if (parse_whole(exponent, places) == std::errc::result_out_of_range) return !exponent.starts_with('-');
  return static_cast<double>(point) - static_cast<double>(first) + places > 0;
}

}  // namespace

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0;
  const std::errc error = parse_whole(text, number);
  if (error == std::errc{}) return number;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  // from_chars does not distinguish too large from too near to zero; converting from the wider type does.
  long double wide = 0;
  if (parse_whole(text, wide) == std::errc{}) return static_cast<double>(wide);
  return std::copysign(too_large(text) ? std::numeric_limits<double>::infinity() : 0.0, text.starts_with('-') ? -1 : 1);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view cut_until(std::string_view& text, std::string_view separators) {
  const std::size_t end = text.find_first_of(separators);
  const std::string_view piece = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return piece;
}

std::string_view cut_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace detp::sim
