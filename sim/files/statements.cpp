#include "statements.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "file_error.hpp"
#include "number_text.hpp"

namespace detp::sim {
namespace {

/// All keywords of OBJ. Only v, vn, f, fo, g, o, mtllib and usemtl matter here.
constexpr std::array<std::string_view, 44> obj_keywords{
    "v",      "vn",         "f",         "vt",     "vp",    "g",    "o",     "s",    "usemtl", "mtllib",   "l",
    "p",      "fo",         "mg",        "cstype", "deg",   "bmat", "step",  "curv", "curv2",  "surf",     "parm",
    "trim",   "hole",       "scrv",      "sp",     "end",   "con",  "bevel", "lod",  "usemap", "c_interp", "d_interp",
    "maplib", "shadow_obj", "trace_obj", "ctech",  "stech", "call", "csh",   "bsp",  "bzp",    "cdc",      "res"};

/// All keywords of MTL, with those of the physically based extension.
constexpr std::array<std::string_view, 37> mtl_keywords{
    "newmtl",   "Ka",        "Kd",     "Ks",     "Ke",      "Ns",     "Ni",     "d",     "Tr",   "Tf",
    "illum",    "sharpness", "map_Ka", "map_Kd", "map_Ks",  "map_Ke", "map_Ns", "map_d", "bump", "map_bump",
    "map_Bump", "disp",      "decal",  "refl",   "map_aat", "Pr",     "Pm",     "Ps",    "Pc",   "Pcr",
    "aniso",    "anisor",    "norm",   "map_Pr", "map_Pm",  "map_Ps", "map_Tr"};

/// Number of statements with unknown keywords that are accepted in any file.
constexpr std::uint64_t unknown_allowed = 100;

}  // namespace

const StatementFormat obj_format{"OBJ", obj_keywords};
const StatementFormat mtl_format{"MTL", mtl_keywords, true};

std::string_view without_comment(std::string_view text) {
  for (std::size_t at = 0; (at = text.find('#', at)) != std::string_view::npos; ++at)
    if (at == 0 || trimmed(text.substr(at - 1, 1)).empty()) return trimmed(text.substr(0, at));
  return text;
}

Statements::Statements(const std::string& path, const StatementFormat& format, std::stop_token stop)
    : format_(format), file_(path, std::move(stop)), lines_(file_) {}

bool Statements::next() {
  while (lines_.next()) {
    number_ = lines_.number();
    rest_ = trimmed(lines_.line());
    if (rest_.empty() || rest_.front() == '#') continue;
    if (rest_.back() == '\\' && lines_.line().back() == '\\') rest_ = joined();
    keyword_ = cut_word(rest_);
    if (const std::string_view known = known_keyword(); !known.empty()) {
      keyword_ = known;
      ++known_;
      return true;
    }
    if (!keyword_.empty()) count_unknown();
  }
  return false;
}

/// The format's spelling of the keyword, which may have other capitals if the format allows it; empty for an unknown one.
std::string_view Statements::known_keyword() const {
  const auto lower = [](char one) { return one >= 'A' && one <= 'Z' ? static_cast<char>(one - 'A' + 'a') : one; };
  const auto exact = std::ranges::find(format_.keywords, keyword_);
  if (exact != format_.keywords.end()) return *exact;
  if (!format_.any_capitals) return {};
  const auto other = std::ranges::find_if(
      format_.keywords, [&](std::string_view known) { return std::ranges::equal(known, keyword_, {}, lower, lower); });
  return other != format_.keywords.end() ? *other : std::string_view{};
}

/// The line and its continuation lines, with a blank in place of each backslash.
std::string_view Statements::joined() {
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

void Statements::count_unknown() {
  if (++unknown_ == 1) first_unknown_ = detp::quoted(keyword_) + " in line " + std::to_string(number_);
  if (unknown_ > unknown_allowed + known_)
    fail(fmt::format("most lines so far have keywords unknown to {0}, the first {1}; is this an {0} file?",
                     format_.name, first_unknown_));
}

std::string_view Statements::name() const {
  constexpr std::string_view no_break_space = "\u00a0";
  std::string_view name = trimmed(rest_);
  while (name.ends_with(no_break_space)) name = trimmed(name.substr(0, name.size() - no_break_space.size()));
  return name;
}

void Statements::fail(const std::string& what) const { throw FileError(file_.path(), number_, what); }

void Statements::note_unknown(Notices& notices) const {
  if (unknown_ > 0)
    notices.push_back(fmt::format("lines with keywords unknown to {}, skipped: {}, the first {}", format_.name,
                                  unknown_, first_unknown_));
}

double Statements::number(std::string_view word) const {
  if (const auto value = number_in(word)) return *value;
  if (word.find("1.#") != std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
  if (word.empty()) fail("has too few numbers, 3 are needed");
  fail(detp::quoted(word) + " is not a number");
}

}  // namespace detp::sim
