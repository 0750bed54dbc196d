#include "detp/validate/map/map_summary.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <stdexcept>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/picture/labels.hpp"
#include "detp/validate/picture/svg.hpp"
#include "map_support.hpp"
#include "support/pages.hpp"
#include "support/xml.hpp"

using namespace detp;
using namespace detp::validate;
using support::count_of;
using support::is_well_formed;

namespace {

const std::string machine = "a <CPU> & \"cache\"";
const std::string program = "detp 0.0.0";

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the picture has three panels, the agreement, both kinds of marks and unknown cells") {
    const std::string svg = map_svg(support::small_map(), machine, program);
    CHECK(is_well_formed(svg));
    for (const char* part : {">predicted</text>", ">measured</text>", "paper's rule", "in 1 of 3 cells (33 %)",
                             "@small", "detp 0.0.0", "a &lt;CPU&gt; &amp; &quot;cache&quot;", ">1e2</text>",
                             ">1e3</text>", ">1 %</text>", ">4 %</text>", ": unknown</title>"})
      CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
    CHECK(count_of(svg, "fill=\"#000000\" stroke=\"#000000\"/>") == 2);  // a mark, and its sample in the legend
    CHECK(count_of(svg, "fill=\"#ffffff\" stroke=\"#000000\"/>") == 2);
    CHECK(count_of(svg, ": unknown</title>") == 1);
  }

  TEST_CASE("without measured cells, there is no panel and no mark for them") {
    TechniqueMap map = support::small_map();
    for (MapRow& row : map.rows)
      for (MapCell& cell : row.cells) cell.analysis.reset();
    const std::string svg = map_svg(map, machine, program);
    CHECK(is_well_formed(svg));
    CHECK(svg.find(">measured</text>") == std::string::npos);
    CHECK(count_of(svg, "<path") == 0);
  }

  TEST_CASE("a stopped map says so, and a map with a single cell can be drawn") {
    TechniqueMap map = support::small_map();
    map.stopped = {3, 4, "cells measured"};
    CHECK(map_svg(map, machine, program).find("stopped after 3 of 4 cells measured") != std::string::npos);
    map.rays.resize(1);
    map.rows.resize(1);
    map.rows[0].cells.resize(1);
    const std::string svg = map_svg(map, machine, program);
    CHECK(is_well_formed(svg));
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
  }

  TEST_CASE("labels of radii are short; a map is described by its scene") {
    CHECK(radius_label({0.0025, true}) == "0.25 %");
    CHECK(radius_label({0.02, false}) == "0.02");
    CHECK(describe(support::small_map()) == "@small: 50 discs of dimension D = 3.00, isotropic lines");
    TechniqueMap mixed = support::small_map();
    mixed.field = sim::Field::mixed;
    CHECK(describe(mixed) == "@small: 50 discs of dimension D = 3.00, a mixed field");
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the same map gives the same bytes, which refer to nothing outside") {
    const std::string svg = map_svg(support::small_map(), machine, program);
    CHECK(svg == map_svg(support::small_map(), machine, program));
    CHECK(count_of(svg, "http") == 1);  // the name of SVG
    for (const char* part : {"href", "url(", "@import", "<script", "<image"})
      CHECK(svg.find(part) == std::string::npos);
  }

  TEST_CASE("text for XML has no markup and no control characters") {
    CHECK(xml_text("a<b>&\"c\x01\x1b\x7f") == "a&lt;b&gt;&amp;&quot;c\x7f");
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a map without rows is refused") {
    CHECK_THROWS_AS(static_cast<void>(map_svg(TechniqueMap{}, machine, program)), std::invalid_argument);
  }
}

namespace detp::support {

TEST_SUITE("figures") {
  TEST_CASE("notebooks draw each technique in the colour that maps have") {
    const std::string style = source_text("notebooks-data/style.py");
    for (const Technique technique : exact_techniques)
      check_says(style, fmt::format("\"{}\": (\"{}\",", name(technique), validate::colour_of(technique)));
  }
}

}  // namespace detp::support
