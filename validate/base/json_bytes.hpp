#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace detp::validate {

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

}  // namespace detp::validate
