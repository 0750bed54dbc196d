#include "detp/validate/picture/chart.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "detp/validate/picture/labels.hpp"
#include "support/xml.hpp"

using namespace detp;
using namespace detp::validate;
using support::count_of;
using support::is_well_formed;

namespace {

Chart small_chart() {
  return {.description = "error & \"time\"",
          .x = {.title = "seconds", .label = seconds_label},
          .y = {.title = "error", .label = percent_label},
          .series = {{"disc", {"#332288", "disc"}, Mark::circle, true}, {"nearest", {"#ddcc77"}, Mark::cross}},
          .points = {{.series = 0, .x = 0.01, .y = 0.5, .value = "1st <point>", .y_interval = Interval{0.4, 0.6}},
                     {.series = 0, .x = 10, .y = 0.005, .value = "2nd", .marked = true},
                     {.series = 1, .x = 1, .y = 0.05, .value = "3rd"},
                     {.series = 1, .x = 2, .y = 0.05}}};
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a chart has its values in their order; a point without value belongs to the one before") {
    const std::string svg = chart_svg(small_chart());
    CHECK(is_well_formed(svg));
    CHECK(count_of(svg, "data-value=") == 3);
    CHECK(svg.find("1st &lt;point&gt;") < svg.find("2nd"));
    CHECK(svg.find("2nd") < svg.find("3rd"));
    for (const char* part : {"aria-label=\"error &amp; &quot;time&quot;\"", ">100 ms<", ">10 %<", ">seconds<", ">disc<",
                             "class=\"disc\"", "role=\"img\""})
      CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
  }

  TEST_CASE("ticks of an axis of less than a decade are numbers in it") {
    Chart chart = small_chart();
    chart.x.label = nullptr;
    chart.points = {{.x = 0.62, .y = 1, .value = "a"}, {.x = 1.1, .y = 2, .value = "b"}};
    const std::string svg = chart_svg(chart);
    for (const char* part : {">0.6<", ">0.8<", ">1<"}) CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
    chart.points = {{.x = 1, .y = 1, .value = "a"}, {.x = 3, .y = 2, .value = "b"}};
    const std::string halves = chart_svg(chart);
    for (const char* part : {">1.5<", ">2<", ">2.5<"}) CHECK_MESSAGE(halves.find(part) != std::string::npos, part);
  }

  TEST_CASE("names take the place of numbers on an axis, the first above") {
    Chart chart = small_chart();
    chart.y = {.title = "", .categories = {"octree", "grid"}};
    for (ChartPoint& point : chart.points) point.y = point.series == 0 ? 0 : 1;
    const std::string svg = chart_svg(chart);
    CHECK(is_well_formed(svg));
    CHECK(svg.find(">octree<") < svg.find(">grid<"));
  }

  TEST_CASE("labels are short, and round correctly") {
    CHECK(rays_label(1) == "1");
    CHECK(rays_label(50) == "50");
    CHECK(rays_label(100) == "1e2");
    CHECK(rays_label(300'000) == "3e5");
    CHECK(rays_label(12'345) == "1.23e4");
    CHECK(rays_label(99'999) == "1e5");
    CHECK(rays_label(1e18) == "1e18");
    CHECK(seconds_label(8.4e-4) == "0.84 ms");
    CHECK(seconds_label(0.1234) == "123 ms");
    CHECK(seconds_label(0.9994) == "999 ms");
    CHECK(seconds_label(0.9996) == "1 s");
    CHECK(seconds_label(12.34) == "12 s");
    CHECK(percent_label(0.0499) == "5 %");
    CHECK(percent_label(1.234) == "123 %");
    CHECK(percent_label(0.00034) == "0.034 %");
  }

  TEST_CASE("codes are initials or the first two letters") {
    CHECK(code_of(Technique::box_tree) == "bt");
    CHECK(code_of(Technique::octree) == "oc");
    CHECK(code_of(Technique::sphere_cache_published) == "scp");
  }

  TEST_CASE("text is white on dark colours and black on light ones") {
    CHECK(colour_of(Technique::sphere_cache) == "#332288");
    CHECK(text_colour_on(Technique::sphere_cache) == "#ffffff");
    CHECK(text_colour_on(Technique::brute_force) == "#000000");
  }
}

TEST_SUITE("hard-case") {
  TEST_CASE("values that a logarithmic axis cannot show, equal values and extremes stay inside") {
    Chart chart = small_chart();
    chart.points = {{.x = 0, .y = -1, .value = "a"},
                    {.x = 1e-300, .y = 1e300, .value = "b", .y_interval = Interval{0, 1e300}}};
    for (int i = 0; i < 2; ++i) {
      const std::string svg = chart_svg(chart);
      CHECK(is_well_formed(svg));
      for (const char* part : {"nan", "inf\""}) CHECK(svg.find(part) == std::string::npos);
      CHECK(svg.size() < 50'000);
      chart.points = {{.x = 3, .y = 3, .value = "a"}, {.x = 3, .y = 3, .value = "b"}};
      chart.x.logarithmic = false;
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a chart without points, of points that are not finite, or of no series is refused") {
    Chart chart = small_chart();
    chart.points[0].x = std::nan("");
    CHECK_THROWS_AS(static_cast<void>(chart_svg(chart)), std::invalid_argument);
    chart.points[0] = {.series = 2, .x = 1, .y = 1};
    CHECK_THROWS_AS(static_cast<void>(chart_svg(chart)), std::invalid_argument);
    chart.points.clear();
    CHECK_THROWS_AS(static_cast<void>(chart_svg(chart)), std::invalid_argument);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("each technique has a code of its own, each exact one also a colour of its own") {
    std::set<std::string> codes;
    std::set<std::string_view> colours;
    std::size_t exact = 0;
    for (const TechniqueRecord& record : technique_records) {
      codes.insert(code_of(record.technique));
      if (!record.exact) continue;
      colours.insert(colour_of(record.technique));
      ++exact;
    }
    CHECK(codes.size() == technique_records.size());
    CHECK(colours.size() == exact);
  }
}
