#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace detp::cli {
namespace {

constexpr std::size_t gap = 2;

std::string padded(const TextColumn& column, const std::string& text, std::size_t width) {
  const std::string space(width - std::min(width, columns_of(text)), ' ');
  return column.align == Align::left ? text + space : space + text;
}

void trim_end(std::string& line) { line.erase(line.find_last_not_of(' ') + 1); }

std::size_t total_width(const std::vector<std::size_t>& shown, const std::vector<std::size_t>& widths) {
  std::size_t total = 0;
  for (const std::size_t i : shown) total += widths[i] + (total > 0 ? gap : 0);
  return total;
}

}  // namespace

void TextTable::add(std::vector<TextCell> cells) {
  if (cells.size() > columns_.size()) throw std::logic_error("a row has more cells than its table has columns");
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t widest = 0;
    for (const auto& row : rows_) widest = std::max(widest, columns_of(row[i].text));
    widths.push_back(widest == 0 && !rows_.empty() ? 0 : std::max(widest, columns_of(columns_[i].head)));
  }
  return widths;
}

std::string TextTable::group_line(const std::vector<std::size_t>& shown, const std::vector<std::size_t>& widths) const {
  std::string line;
  std::size_t place = 0;
  std::string last;
  for (const std::size_t i : shown) {
    const std::string& group = columns_[i].group;
    if (!group.empty() && group != last) {
      line.resize(std::max(line.size() + (line.empty() ? 0 : 1), place), ' ');
      line += group;
    }
    last = group;
    place += widths[i] + gap;
  }
  return line.empty() ? "" : line + "\n";
}

std::string TextTable::text(const Screen& screen) const {
  const std::vector<std::size_t> widths = this->widths();
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (widths[i] > 0) shown.push_back(i);
  std::vector<std::string> left_out;
  while (screen.width > 0 && total_width(shown, widths) > screen.width) {
    const auto most = std::max_element(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) {
      return columns_[a].spare < columns_[b].spare;
    });
    if (most == shown.end() || columns_[*most].spare == 0) break;
    const TextColumn& column = columns_[*most];
    left_out.push_back(column.group.empty() ? column.head : fmt::format("{} {}", column.group, column.head));
    shown.erase(most);
  }
  std::string text = group_line(shown, widths);
  const auto add_line = [&](const auto& cell_of) {
    std::string line;
    for (const std::size_t i : shown) line += (line.empty() ? "" : std::string(gap, ' ')) + cell_of(i);
    trim_end(line);
    text += line + "\n";
  };
  add_line(
      [&](std::size_t i) { return styled(screen, Style::strong, padded(columns_[i], columns_[i].head, widths[i])); });
  for (const auto& row : rows_)
    add_line([&](std::size_t i) { return styled(screen, row[i].style, padded(columns_[i], row[i].text, widths[i])); });
  if (!left_out.empty())
    text += wrapped(fmt::format("(left out of {} columns: {}; a wider terminal or --format csv shows all)",
                                screen.width, fmt::join(left_out, ", ")),
                    screen.text_width(), 1);
  return text;
}

}  // namespace detp::cli
