#include "random.hpp"

#include <Random123/philox.h>

namespace detp::sim {

std::array<std::uint64_t, 4> bits4(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint64_t sub_index) {
  const r123::Philox4x64 philox;
  const r123::Philox4x64::ctr_type counter{{index, sub_index, 0, 0}};
  const r123::Philox4x64::key_type key{{seed, static_cast<std::uint64_t>(stream)}};
  const auto words = philox(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

std::array<double, 4> uniform4(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint64_t sub_index) {
  const auto words = bits4(seed, stream, index, sub_index);
  const auto unit = [](std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; };
  return {unit(words[0]), unit(words[1]), unit(words[2]), unit(words[3])};
}

}  // namespace detp::sim
