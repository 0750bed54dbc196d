#include "obj_lines.hpp"

#include <algorithm>
#include <utility>

#include "file_error.hpp"
#include "number_text.hpp"

namespace detp::sim {
namespace {

/// All keywords of OBJ. Only v, vn and f matter here.
constexpr std::array<std::string_view, 44> keywords{
    "v",      "vn",         "f",         "vt",     "vp",    "g",    "o",     "s",    "usemtl", "mtllib",   "l",
    "p",      "fo",         "mg",        "cstype", "deg",   "bmat", "step",  "curv", "curv2",  "surf",     "parm",
    "trim",   "hole",       "scrv",      "sp",     "end",   "con",  "bevel", "lod",  "usemap", "c_interp", "d_interp",
    "maplib", "shadow_obj", "trace_obj", "ctech",  "stech", "call", "csh",   "bsp",  "bzp",    "cdc",      "res"};

/// Number of statements with unknown keywords that are accepted in any file.
constexpr std::uint64_t unknown_allowed = 100;

}  // namespace

ObjLines::ObjLines(const std::string& path, std::stop_token stop) : file_(path, std::move(stop)), lines_(file_) {}

bool ObjLines::next() {
  while (lines_.next()) {
    number_ = lines_.number();
    rest_ = trimmed(lines_.line());
    if (rest_.empty() || rest_.front() == '#') continue;
    if (rest_.back() == '\\' && lines_.line().back() == '\\') rest_ = joined();
    keyword_ = cut_word(rest_);
    if (std::find(keywords.begin(), keywords.end(), keyword_) != keywords.end()) {
      ++known_;
      return true;
    }
    if (!keyword_.empty()) count_unknown();
  }
  return false;
}

/// The line and its continuation lines, with a blank in place of each backslash.
std::string_view ObjLines::joined() {
  joined_.clear();
  bool more = true;
  while (more) {
    std::string_view line = lines_.line();
    more = line.ends_with('\\');
    if (more) line.remove_suffix(1);
    joined_.append(line) += ' ';
    if (joined_.size() > TextLines::longest)
      fail("the joined lines are longer than " + std::to_string(TextLines::longest) + " bytes");
    more = more && lines_.next();
  }
  return joined_;
}

void ObjLines::count_unknown() {
  if (++unknown_ == 1) first_unknown_ = quoted(keyword_) + " in line " + std::to_string(number_);
  if (unknown_ > unknown_allowed + known_)
    fail("most lines so far have keywords unknown to OBJ, the first " + first_unknown_ + "; is this an OBJ file?");
}

void ObjLines::fail(const std::string& what) const { throw FileError(file_.path(), number_, what); }

void ObjLines::note_unknown(Notices& notices) const {
  if (unknown_ > 0)
    notices.push_back("lines with keywords unknown to OBJ, skipped: " + std::to_string(unknown_) + ", the first " +
                      first_unknown_);
}

}  // namespace detp::sim
