#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "digest.hpp"

/// Tells whether a file that detp keeps was altered.
namespace detp::validate {

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
