#include "mtl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
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
constexpr int first_glass_model = 3;  // that Tr 1 may mean glass with
constexpr std::array<int, 2> matt_models{0, 1};

/// Albedo that a material has at most if its diffuse and specular shares contradict each other.
constexpr double most_reflected = 0.98;

/// A material as the file has it.
struct Statement {
  std::string name;
  double diffuse = 0.5, specular = 0, emitted = 0, shininess = 1, index = 1;
  glm::dvec3 diffuse_colour{0.5}, specular_colour{0.0}, emitted_colour{0.0}, filter{1.0};
  std::optional<double> opacity;       ///< d
  std::optional<double> transparency;  ///< Tr
  std::optional<int> model;

  [[nodiscard]] bool has_model(std::span<const int> models) const {
    return model && std::ranges::find(models, *model) != models.end();
  }
};

/// Names of materials to which a rule of mtl_file.hpp applied.
struct Noted {
  std::vector<std::string> opaque, contradictory, overfull, lossless;
};

/// 1 - the share of glass.
double opacity_of(const Statement& from, Noted& noted) {
  if (from.opacity && from.transparency && std::abs(*from.opacity - (1 - *from.transparency)) > 1e-6)
    noted.contradictory.push_back(from.name);
  const bool none =
      from.opacity ? *from.opacity == 0 : from.transparency == 1.0 && from.model.value_or(0) < first_glass_model;
  if (none) noted.opaque.push_back(from.name);
  if (none) return 1;
  return from.opacity ? *from.opacity : 1 - from.transparency.value_or(0);
}

bool is_coloured(const Statement& from) {
  const auto is_grey = [](const glm::dvec3& one) { return one.r == one.g && one.g == one.b; };
  return !is_grey(from.diffuse_colour) || !is_grey(from.specular_colour) || !is_grey(from.emitted_colour) ||
         from.filter != glm::dvec3(1.0);
}

/// The shares of `to` in each band. A colour is brighter or darker in it as it is than its luminance; no band reflects more than comes.
Colours colours_of(const Statement& from, const Material& to) {
  const auto tinted = [](double share, const glm::dvec3& colour, double luminance) {
    return luminance > 0 ? share / luminance * colour : glm::dvec3(0.0);
  };
  Colours colours{tinted(to.diffuse, from.diffuse_colour, from.diffuse),
                  tinted(to.specular, from.specular_colour, from.specular), to.glass * from.filter,
                  from.emitted_colour};
  for (int band = 0; band < 3; ++band) {
    const double rest = 1 - to.glass;
    const double sum = colours.diffuse[band] + colours.specular[band];
    if (sum <= rest) continue;
    colours.diffuse[band] *= rest / sum;
    colours.specular[band] *= rest / sum;
  }
  return colours;
}

Material material_of(const Statement& from, Noted& noted) {
  Material to{.name = from.name, .diffuse = from.diffuse, .emitted = from.emitted};
  if (from.shininess >= 1 && !from.has_model(matt_models)) to.specular = from.specular;
  to.shininess = std::max(1.0, from.shininess);
  if (from.shininess >= shininess_of_mirrors || from.has_model(mirror_models))
    to.shininess = std::numeric_limits<double>::infinity();
  if (from.index > 0.1 && from.index != 1) to.index = from.index;
  const double glass = 1 - opacity_of(from, noted);
  const bool one_share = to.diffuse == 0 || to.specular == 0;
  if (to.diffuse + to.specular > 1 || (to.diffuse + to.specular == 1 && !one_share)) {
    noted.overfull.push_back(from.name);
    to.diffuse = std::min(to.diffuse, most_reflected);
    to.specular = std::min(to.specular, one_share ? most_reflected : (most_reflected - to.diffuse) / 2);
  } else if (to.diffuse + to.specular == 1 || glass == 1) {
    noted.lossless.push_back(from.name);
  }
  to.glass = glass;
  to.diffuse *= 1 - glass;
  to.specular *= 1 - glass;
  if (is_coloured(from)) to.colours = colours_of(from, to);
  return to;
}

class MtlReader {
 public:
  MtlReader(const std::string& path, std::stop_token stop) : path_(path), lines_(path, mtl_format, std::move(stop)) {}

  std::vector<Material> read(Notices& notices) {
    std::vector<Material> materials;
    std::optional<Statement> now;
    while (lines_.next()) {
      const std::string_view keyword = lines_.keyword();
      if (keyword == "newmtl") {
        if (now) materials.push_back(material_of(*now, noted_));
        now.emplace().name = lines_.name();
      } else if (now) {
        add(*now, keyword);
      } else {
        ++before_first_;
      }
    }
    lines_.note_unknown(notices);
    if (now) materials.push_back(material_of(*now, noted_));
    const auto note = [&](std::size_t count, const std::string& what) {
      if (count > 0) notices.push_back(fmt::format("{}: {}: {}", shown_path(path_), what, count));
    };
    const auto name = [&](const std::vector<std::string>& names, const char* what) {
      note(names.size(), names.empty() ? "" : fmt::format("{} ({})", what, listed(names)));
    };
    name(noted_.opaque, "materials with d 0 or Tr 1, taken as opaque");
    name(noted_.contradictory, "materials whose d and Tr contradict each other, taken by d");
    name(noted_.overfull, "materials with Kd and Ks of 1 or more together, lowered");
    name(noted_.lossless, "materials that absorb nothing");
    note(before_first_, "statements before the first newmtl, ignored");
    note(out_of_range_, "values of Ns, Ni, illum, d or Tr out of range, brought into it");
    note(other_colours_, "colours as spectra or in CIE XYZ, ignored");
    note(textures_, "textures, ignored");
    return materials;
  }

 private:
  static std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t most = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
      text += (i > 0 ? ", " : "") + shortened(names[i], 40);
    return names.size() > most ? text + ", ..." : text;
  }

  void add(Statement& to, std::string_view keyword) {
    if (keyword.starts_with("map_")) ++textures_;
    if (keyword == "Kd" || keyword == "Ks" || keyword == "Ke") {
      std::string_view words = lines_.rest();
      if (const std::string_view first = cut_word(words); first == "spectral" || first == "xyz")
        ++other_colours_;
      else if (keyword == "Kd")
        to.diffuse = luminance(to.diffuse_colour = colour());
      else if (keyword == "Ks")
        to.specular = luminance(to.specular_colour = colour());
      else
        to.emitted = radiance(to.emitted_colour = colour());
    }
    if (keyword == "Tf") {
      std::string_view words = lines_.rest();
      if (const std::string_view first = cut_word(words); first != "spectral" && first != "xyz")
        to.filter = glm::min(colour(), glm::dvec3(1.0));
    }
    if (keyword == "Ns") to.shininess = number();
    if (keyword == "Ni") to.index = number();
    if (keyword == "d") to.opacity = share();
    if (keyword == "Tr") to.transparency = share();
    if (keyword == "illum") {
      const std::size_t before = out_of_range_;
      const double model = std::min(number(), 100.0);
      if (out_of_range_ == before) to.model = static_cast<int>(model);
    }
  }

  /// One number is a grey.
  [[nodiscard]] glm::dvec3 colour() const {
    std::string_view words = lines_.rest();
    glm::dvec3 colour(checked(lines_.number(cut_word(words))));
    for (int i = 1; i < 3 && !trimmed(words).empty(); ++i) colour[i] = checked(lines_.number(cut_word(words)));
    return colour;
  }

  [[nodiscard]] static double luminance(const glm::dvec3& colour) {
    if (colour[0] == colour[1] && colour[1] == colour[2]) return colour[0];  // without rounding: 1 stays 1
    const double sum = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
    return std::min(sum, std::numeric_limits<double>::max());  // rounding must not make it infinite
  }

  [[nodiscard]] double radiance(const glm::dvec3& colour) const {
    const double value = luminance(colour);
    if (std::fpclassify(value) == FP_SUBNORMAL)
      lines_.fail(fmt::format("must be 0 or at least {:.4g}, for the luminance of the three numbers (got {:.4g})",
                              std::numeric_limits<double>::min(), value));
    return value;
  }

  /// At least 0.
  [[nodiscard]] double number() {
    std::string_view words = lines_.rest();
    return in_range(lines_.number(cut_word(words)), std::numeric_limits<double>::max());
  }

  /// The last word, since "d -halo 0.5" has an option.
  [[nodiscard]] double share() {
    const std::string_view words = trimmed(lines_.rest());
    const std::size_t blank = words.find_last_of(" \t");
    return in_range(lines_.number(blank == std::string_view::npos ? words : words.substr(blank + 1)), 1);
  }

  [[nodiscard]] double in_range(double value, double most) {
    if (std::isnan(value)) lines_.fail("must be a number (got nan)");
    if (value < 0 || value > most) ++out_of_range_;
    return std::clamp(value, 0.0, most);
  }

  [[nodiscard]] double checked(double value) const {
    if (!(value >= 0) || std::isinf(value)) lines_.fail(fmt::format("must be >= 0 and finite (got {})", value));
    return value;
  }

  const std::string& path_;
  Statements lines_;
  Noted noted_;
  std::size_t before_first_ = 0;
  std::size_t out_of_range_ = 0;
  std::size_t other_colours_ = 0;
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
