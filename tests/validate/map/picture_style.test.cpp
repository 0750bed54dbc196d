#include <doctest/doctest.h>
#include <fmt/format.h>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/picture/labels.hpp"
#include "support/pages.hpp"

namespace detp::support {

TEST_SUITE("figures") {
  TEST_CASE("notebooks draw each technique in the colour that maps have") {
    const std::string style = source_text("notebooks-data/style.py");
    for (const Technique technique : exact_techniques)
      check_says(style, fmt::format("\"{}\": (\"{}\",", name(technique), validate::colour_of(technique)));
  }
}

}  // namespace detp::support
