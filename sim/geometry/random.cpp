#include "random.hpp"

#include <algorithm>

#include <Random123/philox.h>

namespace detp::sim {

namespace {

using Words = std::array<std::uint64_t, 4>;

Words words_at(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint64_t sub_index) {
  const r123::Philox4x64 philox;
  const r123::Philox4x64::ctr_type counter{{index, sub_index, 0, 0}};
  const r123::Philox4x64::key_type key{{seed, static_cast<std::uint64_t>(stream)}};
  const auto words = philox(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

double unit(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }

}  // namespace

std::array<std::uint64_t, 4> bits4(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint64_t sub_index) {
  return words_at(seed, stream, index, sub_index);
}

std::array<double, 4> uniform4(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint64_t sub_index) {
  const Words words = words_at(seed, stream, index, sub_index);
  return {unit(words[0]), unit(words[1]), unit(words[2]), unit(words[3])};
}

void uniform4(std::uint64_t seed, Stream stream, std::uint64_t first, std::size_t count,
              const std::array<double*, 4>& columns) {
  const auto [one, two, three, four] = columns;
  for (std::size_t i = 0; i < count; ++i) {
    const Words words = words_at(seed, stream, first + i, 0);
    one[i] = unit(words[0]);
    two[i] = unit(words[1]);
    three[i] = unit(words[2]);
    four[i] = unit(words[3]);
  }
}

std::vector<std::size_t> stratified_sample(std::size_t size, std::size_t count, std::uint64_t seed, Stream stream) {
  count = std::min(count, size);
  std::vector<std::size_t> sample(count);
  std::array<double, 4> random{};
  const auto start = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<double>(i) / static_cast<double>(count) * static_cast<double>(size));
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 4 == 0) random = uniform4(seed, stream, i);
    const std::size_t first = start(i);
    const std::size_t end = i + 1 == count ? size : start(i + 1);
    const auto offset = static_cast<std::size_t>(random[i % 4] * static_cast<double>(end - first));
    sample[i] = size == count ? i : first + offset;
  }
  return sample;
}

double van_der_corput(std::uint64_t number) {
  std::uint64_t bits = number;
  bits = ((bits >> 1) & 0x5555555555555555U) | ((bits & 0x5555555555555555U) << 1);
  bits = ((bits >> 2) & 0x3333333333333333U) | ((bits & 0x3333333333333333U) << 2);
  bits = ((bits >> 4) & 0x0F0F0F0F0F0F0F0FU) | ((bits & 0x0F0F0F0F0F0F0F0FU) << 4);
  return 0x1p-53 * static_cast<double>(__builtin_bswap64(bits) >> 11);
}

}  // namespace detp::sim
