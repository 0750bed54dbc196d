#include "detp/validate/map/map_summary.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/map/technique_map.hpp"
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

const Workload workload_in_cell = cube_workload(1000, 1000, 0.02, 1);
constexpr UnitCosts no_costs{.cull_test = 0, .disc_test = 0, .index_test = 0, .step = 0, .node = 0};

const std::string machine = "a <CPU> & \"cache\"";
const std::string program = "detp 0.0.0";

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("edges of cells are the geometric means of neighbours; the outer cells are symmetric") {
    const std::vector<double> edges = cell_edges({1, 100, 1e6});
    REQUIRE(edges.size() == 4);
    CHECK(edges[0] == doctest::Approx(0.1));
    CHECK(edges[1] == doctest::Approx(10));
    CHECK(edges[2] == doctest::Approx(1e4));
    CHECK(edges[3] == doctest::Approx(1e8));
    CHECK(cell_edges({10})[0] * cell_edges({10})[1] == doctest::Approx(100));
    CHECK(cell_edges({10})[1] == doctest::Approx(10 * std::sqrt(10)));
  }

  TEST_CASE("checked axes have each value once, and rays ascend") {
    const MapAxes axes = checked({{1000, 10, 1000}, {{0.04, true}, {0.01, true}, {0.04, true}, {0.04, false}}});
    CHECK(axes.rays == std::vector<double>{10, 1000});
    CHECK(axes.radii == std::vector<Length>{{0.04, true}, {0.01, true}, {0.04, false}});
  }

  TEST_CASE("the default axes span the paper's figure: 1 % to 16 %, and at least 100 to 300 000 rays") {
    CHECK(default_map_rays().front() == 100);
    CHECK(default_map_rays().back() == 300'000);
    CHECK(default_map_radii().size() == 7);
    CHECK(default_map_radii().back() == Length{0.16, true});
    CHECK_NOTHROW(static_cast<void>(checked({default_map_rays(), default_map_radii()})));
  }

  TEST_CASE("a cell agrees if the predicted technique was the fastest; overlapping ranges are within noise") {
    const TechniqueMap map = support::small_map();
    const CellVerdict same = map.rows[0].cells[0].verdict().value();
    CHECK(same.agrees);
    CHECK(same.slower == 0);
    const CellVerdict other = map.rows[0].cells[1].verdict().value();
    CHECK_FALSE(other.agrees);
    CHECK(other.slower == doctest::Approx(3));
    CHECK_FALSE(other.within_noise);
    const CellVerdict noisy = map.rows[1].cells[0].verdict().value();
    CHECK_FALSE(noisy.agrees);
    CHECK(noisy.slower == doctest::Approx(0.1));
    CHECK(noisy.within_noise);
  }

  TEST_CASE("agreement counts measured cells only, and lists the largest loss first") {
    const TechniqueMap map = support::small_map();
    const Agreement agreement = agreement_of(map);
    CHECK(agreement.cells == 3);
    CHECK(agreement.agree == 1);
    CHECK(agreement.share() == doctest::Approx(1.0 / 3));
    CHECK(agreement.within_noise() == 1);
    REQUIRE(agreement.disagreeing.size() == 2);
    CHECK(agreement.disagreeing[0].cell == &map.rows[0].cells[1]);
    CHECK(agreement.disagreeing[1].row == &map.rows[1]);
    CHECK(agreement.worst_slowdown == doctest::Approx(4));
    CHECK(agreement.mean_slowdown == doctest::Approx(std::cbrt(1 * 4 * 1.1)));
  }

  TEST_CASE("without a measured cell there is nothing to agree") {
    CHECK(agreement_of(TechniqueMap{}).cells == 0);
    CHECK(agreement_of(TechniqueMap{}).mean_slowdown == 1);
  }

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

TEST_SUITE("bad input") {
  TEST_CASE("axes out of range are refused") {
    for (const double rays : {0.0, -1.0, 1.5, 1e19, std::numeric_limits<double>::quiet_NaN()})
      CHECK_THROWS_AS(static_cast<void>(checked({{rays}, {}})), std::invalid_argument);
    for (const double radius : {0.0, -1.0, std::numeric_limits<double>::infinity()})
      CHECK_THROWS_AS(static_cast<void>(checked({{}, {{radius}}})), std::invalid_argument);
  }

  TEST_CASE("axes with too many values are refused, and the message says how many fit") {
    std::vector<double> rays;
    for (std::size_t i = 1; i <= most_axis_values; ++i) rays.push_back(static_cast<double>(i));
    CHECK(checked({rays, {}}).rays.size() == most_axis_values);
    rays.push_back(1e6);
    CHECK_THROWS_WITH_AS(static_cast<void>(checked({rays, {}})), doctest::Contains("at most 40"), std::length_error);
  }

  TEST_CASE("costs of 0 and a list that disables everything are refused") {
    CHECK_THROWS_WITH_AS(static_cast<void>(choose_for_cell({.workload = workload_in_cell}, no_costs)),
                         doctest::Contains("0 s"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(static_cast<void>(choose_for_cell(
                             {.workload = workload_in_cell, .disabled = {all_techniques.begin(), all_techniques.end()}},
                             built_in_unit_costs())),
                         doctest::Contains("no technique is left"), std::invalid_argument);
  }

  TEST_CASE("a stop request gives no half ranking") {
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(static_cast<void>(choose_for_cell({.workload = workload_in_cell, .stop = stop.get_token()},
                                                      built_in_unit_costs())),
                    sim::Stopped);
  }

  TEST_CASE("a map without rows is refused") {
    CHECK_THROWS_AS(static_cast<void>(map_svg(TechniqueMap{}, machine, program)), std::invalid_argument);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the estimate is the ranking, without disabled techniques") {
    const auto ranking = model::rank(workload_in_cell, built_in_unit_costs());
    const Choice all = choose_for_cell({.workload = workload_in_cell}, built_in_unit_costs());
    CHECK(all.best().candidate == ranking.front().candidate);
    CHECK(all.candidates.size() == ranking.size());
    const Technique first = ranking.front().candidate.technique;
    const Choice rest = choose_for_cell({.workload = workload_in_cell, .disabled = {first}}, built_in_unit_costs());
    CHECK(rest.candidates.size() == ranking.size() - 1);
    for (const Prediction& one : ranking) {
      const auto best = model::best_of(one.candidate.technique, workload_in_cell, built_in_unit_costs());
      if (one.candidate.technique != first) CHECK(rest.best().time.total() <= 1.01 * best.value().time.total());
    }
  }

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

namespace detp::support {

TEST_SUITE("figures") {
  TEST_CASE("notebooks draw each technique in the colour that maps have") {
    const std::string style = source_text("notebooks-data/style.py");
    for (const Technique technique : exact_techniques)
      check_says(style, fmt::format("\"{}\": (\"{}\",", name(technique), validate::colour_of(technique)));
  }
}

}  // namespace detp::support
