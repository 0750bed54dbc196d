#include "text_blocks.hpp"

#include <algorithm>

namespace detp::cli {
namespace {

constexpr std::size_t between_blocks = 2;

bool fits(std::size_t width, const Screen& screen) { return screen.width == 0 || width <= screen.width; }

std::string strip(const std::vector<const TextBlock*>& blocks) {
  std::string text;
  for (std::size_t i = 0; i < blocks.front()->lines.size(); ++i) {
    std::string line;
    for (const TextBlock* block : blocks) {
      const std::string& part = block->lines[i];
      line += (block == blocks.front() ? "" : std::string(between_blocks, ' ')) + part;
      line += std::string(block->width() - columns_of(part), ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text + "\n";
}

}  // namespace

std::size_t TextBlock::width() const {
  std::size_t widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, columns_of(line));
  return widest;
}

std::string side_by_side(const std::vector<TextBlock>& blocks, const Screen& screen) {
  std::string text;
  for (std::size_t next = 1; next < blocks.size();) {
    std::vector<const TextBlock*> shown{&blocks.front()};
    std::size_t width = blocks.front().width();
    do {
      width += between_blocks + blocks[next].width();
      shown.push_back(&blocks[next++]);
    } while (next < blocks.size() && fits(width + between_blocks + blocks[next].width(), screen));
    text += strip(shown);
  }
  return text;
}

bool is_too_wide(const std::vector<TextBlock>& blocks, const Screen& screen) {
  return std::any_of(blocks.begin() + 1, blocks.end(), [&](const TextBlock& block) {
    return !fits(blocks.front().width() + between_blocks + block.width(), screen);
  });
}

}  // namespace detp::cli
