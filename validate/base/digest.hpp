#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace detp::validate {

/// Tells whether two inputs are the same, without keeping them: FNV-1a, 64 bits.
class Digest {
 public:
  void add(double value) { add_bytes(&value, sizeof value); }
  void add(std::uint64_t value) { add_bytes(&value, sizeof value); }
  void add(const glm::dvec3& value) {
    for (int axis = 0; axis < 3; ++axis) add(value[axis]);
  }
  void add(std::string_view text) {
    for (const char letter : text) add_bytes(&letter, 1);
  }
  /// 16 hexadecimal digits.
  [[nodiscard]] std::string text() const { return fmt::format("{:016x}", state_); }

 private:
  void add_bytes(const void* data, std::size_t count) {
    std::array<unsigned char, sizeof(double)> bytes{};
    std::memcpy(bytes.data(), data, count);
    for (std::size_t i = 0; i < count; ++i) state_ = (state_ ^ bytes[i]) * 0x100000001b3ULL;
  }

  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace detp::validate
