#include "text_lines.hpp"

#include <algorithm>

#include "file_error.hpp"

namespace detp::sim {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

}  // namespace

TextLines::TextLines(InputFile& file) : file_(file) {
  (void)file.fetch(byte_order_mark.size());
  const std::string_view front = file.buffered();
  if (front.starts_with("\xFF\xFE") || front.starts_with("\xFE\xFF") || front.starts_with("\0\0\xFE"sv))
    throw FileError(file.path(), "is text in UTF-16 or UTF-32; UTF-8 or ASCII is needed");
  if (front.starts_with(byte_order_mark)) file.skip(byte_order_mark.size());
}

void TextLines::finish_line() {
  file_.skip(size_ + end_size_);
  size_ = end_size_ = 0;
}

bool TextLines::next() {
  finish_line();
  if (!file_.fetch(1)) return false;
  ++number_;
  find_end();
  return true;
}

void TextLines::find_end() {
  do {
    const std::string_view text = file_.buffered();
    const std::size_t searched = size_;
    size_ = std::min(text.find('\n', searched), text.size());
    const std::string_view line = text.substr(searched, size_ - searched);
    size_ = searched + std::min({line.find('\r'), line.find('\0'), line.size()});
    if (size_ > longest) fail("the line is longer than " + std::to_string(longest) + " bytes");
  } while (size_ == file_.buffered().size() && file_.fetch(size_ + 1));
  if (size_ == file_.buffered().size()) return;
  if (file_.buffered()[size_] == '\0') fail("contains a NUL byte; is the file binary or damaged?");
  const bool cr = file_.buffered()[size_] == '\r';
  end_size_ = cr && file_.fetch(size_ + 2) && file_.buffered()[size_ + 1] == '\n' ? 2 : 1;
  cr_alone_ = cr && end_size_ == 1;
}

void TextLines::fail(const std::string& what) const { throw FileError(file_.path(), number_, what); }

}  // namespace detp::sim
