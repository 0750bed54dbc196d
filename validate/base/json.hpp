#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "digest.hpp"

/// JSON and names of columns: what answers are written with.
namespace detp::validate {

using Json = nlohmann::ordered_json;

/// The names of a table's columns, in order.
using Columns = std::vector<std::string>;
[[nodiscard]] inline Columns operator+(Columns left, const Columns& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// Both, each name once.
[[nodiscard]] inline Columns united(Columns left, const Columns& right) {
  for (const std::string& one : right)
    if (std::find(left.begin(), left.end(), one) == left.end()) left.push_back(one);
  return left;
}

/// The number, or null if it is not finite. A relative error, for instance, is not finite if all observations are zero.
[[nodiscard]] inline Json known(double number) { return std::isfinite(number) ? Json(number) : Json(); }

/// A value as JSON: null for an optional that is empty, and for a number that is not finite.
template <class T>
[[nodiscard]] Json json_value(const T& value) {
  if constexpr (std::is_floating_point_v<T>)
    return known(value);
  else
    return Json(value);
}
template <class T>
[[nodiscard]] Json json_value(const std::optional<T>& value) {
  return value ? json_value(*value) : Json();
}

/// A word of a command that an answer names, as a POSIX shell takes it: as it is, or in single quotes if a character of it could mean something
/// else.
[[nodiscard]] inline std::string shell_word(std::string_view word) {
  constexpr std::string_view harmless = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./@%:,=+-";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/// JSON in binary (CBOR), to be sent to another process: exact and short, and other than text it has infinite numbers.
[[nodiscard]] inline std::string json_bytes(const nlohmann::json& json) {
  std::string bytes;
  nlohmann::json::to_cbor(json, bytes);
  return bytes;
}

/// Throws nlohmann::json::exception unless the bytes are those of json_bytes.
template <class T>
[[nodiscard]] T from_json_bytes(const std::string& bytes) {
  return nlohmann::json::from_cbor(bytes).get<T>();
}

/// 16 hexadecimal digits of the contents: of their names and values, not of their layout or the order of names.
template <class... Contents>
[[nodiscard]] std::string checksum(const Contents&... contents) {
  Digest digest;
  const auto add = [&](const nlohmann::json& content) {
    digest.add(std::string_view(content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
  };
  (add(contents), ...);
  return digest.text();
}

}  // namespace detp::validate
