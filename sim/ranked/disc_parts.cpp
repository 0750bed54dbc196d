#include "disc_parts.hpp"

#include <algorithm>
#include <utility>

namespace detp::sim {

DiscParts::DiscParts(const DiscSource& discs, const DiscCut& cut, std::size_t first, std::size_t count,
                     const std::stop_token& stop)
    : parts_(count) {
  constexpr std::size_t bytes_in_memory = std::size_t{1} << 22;
  const std::size_t at_once = std::clamp<std::size_t>(bytes_in_memory / sizeof(Numbered) / count, 16, 1 << 12);
  const auto add = [&](std::size_t number, const Disc& disc, std::uint64_t disc_number) {
    if (count == 1) {
      single_.numbers.push_back(static_cast<std::uint32_t>(disc_number));
      single_.discs.push_back(disc);
      return;
    }
    Part& part = parts_[number];
    part.last.push_back({disc, disc_number});
    if (part.last.size() == at_once) spill(part);
  };
  if (count == 1) {
    const std::uint64_t expected = cut.expected(first) + cut.expected(first) / 16;
    single_.numbers.reserve(static_cast<std::size_t>(expected));
    single_.discs.reserve(static_cast<std::size_t>(expected));
  }
  std::vector<std::uint32_t> parts;
  for_each_block(discs, stop, [&](std::uint64_t first_disc, std::span<const Disc> block) {
    parts.resize(block.size());
    cut.find_parts(block, first_disc, parts);
    for (std::size_t i = 0; i < block.size(); ++i)
      if (parts[i] >= first && parts[i] < first + count) add(parts[i] - first, block[i], first_disc + i);
  });
}

void DiscParts::spill(Part& part) {
  part.chunks.push_back({file_.size(), part.last.size()});
  file_.append(std::as_bytes(std::span(part.last)));
  part.last.clear();
}

PartOfDiscs DiscParts::take(std::size_t i) {
  if (count() == 1) return std::exchange(single_, {});
  Part& part = parts_[i];
  std::size_t size = part.last.size();
  for (const Chunk& chunk : part.chunks) size += chunk.discs;
  PartOfDiscs taken;
  taken.numbers.reserve(size);
  taken.discs.reserve(size);
  const auto add = [&](std::span<const Numbered> discs) {
    for (const auto& [disc, number] : discs) {
      taken.numbers.push_back(static_cast<std::uint32_t>(number));
      taken.discs.push_back(disc);
    }
  };
  std::vector<Numbered> block;
  for (const Chunk& chunk : part.chunks) {
    block.resize(chunk.discs);
    file_.read(chunk.offset, std::as_writable_bytes(std::span(block)));
    add(block);
  }
  add(part.last);
  return taken;
}

}  // namespace detp::sim
