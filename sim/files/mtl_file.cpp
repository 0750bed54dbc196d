#include "mtl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "number_text.hpp"
#include "statements.hpp"

namespace detp::sim {
namespace {

constexpr double shininess_of_mirrors = 1000;
constexpr std::array<int, 2> mirror_models{3, 5};
constexpr std::array<int, 4> glass_models{4, 6, 7, 9};
constexpr std::array<int, 2> matt_models{0, 1};

/// A material as the file has it.
struct Statement {
  std::string name;
  double diffuse = 0.5, specular = 0, emitted = 0, shininess = 1, opacity = 1, index = 1;
  std::optional<int> model;

  [[nodiscard]] bool has_model(std::span<const int> models) const {
    return model && std::ranges::find(models, *model) != models.end();
  }
};

/// The material; adds to `scaled` if its shares had to be scaled.
Material material_of(const Statement& from, std::size_t& scaled) {
  Material to{.name = from.name, .diffuse = from.diffuse, .emitted = from.emitted};
  if (from.shininess >= 1 && !from.has_model(matt_models)) to.specular = from.specular;
  to.shininess = std::max(1.0, from.shininess);
  if (from.shininess >= shininess_of_mirrors || from.has_model(mirror_models))
    to.shininess = std::numeric_limits<double>::infinity();
  if (from.opacity < 1)
    to.glass = 1 - from.opacity;
  else if (from.has_model(glass_models))
    to.glass = 1;
  if (from.index > 0.1 && from.index != 1) to.index = from.index;
  constexpr double vast = 0x1p1000;  // beyond it, the sum may overflow and its inverse be subnormal
  if (std::max(to.diffuse, to.specular) > vast) {
    to.diffuse /= vast;
    to.specular /= vast;
  }
  const double shares = to.diffuse + to.specular;
  if (shares > 1) ++scaled;
  const double scale = (1 - to.glass) / std::max(1.0, shares);
  to.diffuse *= scale;
  to.specular *= scale;
  return to;
}

class MtlReader {
 public:
  MtlReader(const std::string& path, std::stop_token stop) : path_(path), lines_(path, mtl_format, std::move(stop)) {}

  std::vector<Material> read(Notices& notices) {
    std::vector<Material> materials;
    std::optional<Statement> now;
    std::size_t scaled = 0;
    while (lines_.next()) {
      const std::string_view keyword = lines_.keyword();
      if (keyword == "newmtl") {
        if (now) materials.push_back(material_of(*now, scaled));
        now.emplace().name = trimmed(lines_.rest());
      } else if (now) {
        add(*now, keyword);
      } else {
        lines_.fail("comes before the first newmtl");
      }
    }
    lines_.note_unknown(notices);
    if (now) materials.push_back(material_of(*now, scaled));
    const auto note = [&](std::size_t count, const char* what) {
      if (count > 0) notices.push_back(fmt::format("{}: {}: {}", shown_path(path_), what, count));
    };
    note(scaled, "materials that reflect more than all light, scaled down");
    note(textures_, "textures, ignored");
    return materials;
  }

 private:
  void add(Statement& to, std::string_view keyword) {
    if (keyword == "Kd") to.diffuse = luminance();
    if (keyword == "Ks") to.specular = luminance();
    if (keyword == "Ke") to.emitted = radiance();
    if (keyword == "Ns") to.shininess = number();
    if (keyword == "Ni") to.index = number();
    if (keyword == "d") to.opacity = share();
    if (keyword == "Tr") to.opacity = 1 - share();
    if (keyword == "illum") to.model = static_cast<int>(std::min(number(), 100.0));
    if (keyword.starts_with("map_")) ++textures_;
  }

  /// One number is a grey.
  [[nodiscard]] double luminance() const {
    std::string_view words = lines_.rest();
    std::array<double, 3> colour{};
    colour[0] = checked(lines_.number(cut_word(words)));
    colour[1] = colour[2] = colour[0];
    for (std::size_t i = 1; i < 3 && !trimmed(words).empty(); ++i) colour[i] = checked(lines_.number(cut_word(words)));
    const double sum = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
    return std::min(sum, std::numeric_limits<double>::max());  // rounding must not make it infinite
  }

  [[nodiscard]] double radiance() const {
    const double value = luminance();
    if (std::fpclassify(value) == FP_SUBNORMAL)
      lines_.fail(fmt::format("must be 0 or at least {:.4g}, for the luminance of the three numbers (got {:.4g})",
                              std::numeric_limits<double>::min(), value));
    return value;
  }

  [[nodiscard]] double number() const {
    std::string_view words = lines_.rest();
    return checked(lines_.number(cut_word(words)));
  }

  /// The last word, since "d -halo 0.5" has an option.
  [[nodiscard]] double share() const {
    const std::string_view words = trimmed(lines_.rest());
    const std::size_t blank = words.find_last_of(" \t");
    const double value = checked(lines_.number(blank == std::string_view::npos ? words : words.substr(blank + 1)));
    if (value > 1) lines_.fail(fmt::format("must be in [0, 1] (got {})", value));
    return value;
  }

  [[nodiscard]] double checked(double value) const {
    if (!(value >= 0) || std::isinf(value)) lines_.fail(fmt::format("must be >= 0 and finite (got {})", value));
    return value;
  }

  const std::string& path_;
  Statements lines_;
  std::size_t textures_ = 0;
};

}  // namespace

std::string beside(const std::string& path, std::string_view name) {
  std::string relative(name);
  std::ranges::replace(relative, '\\', '/');
  return (std::filesystem::path(path).parent_path() / relative).string();
}

std::vector<Material> read_mtl(const std::string& path, Notices& notices, std::stop_token stop) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    notices.push_back(fmt::format("the material library {} is not there", shown_path(path)));
    return {};
  }
  return MtlReader(path, std::move(stop)).read(notices);
}

}  // namespace detp::sim
