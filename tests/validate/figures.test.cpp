#include "support/figures.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "support/pages.hpp"

namespace detp::support {
namespace {

const Rows& small_table() {
  static const Rows rows =
      csv_rows("scene,engine,x,ratio\na,simd,1,0.5\na,simd,3,2\nb,simd,2,8\nb,plain,4,1.5\nb,plain,1,\n");
  return rows;
}

std::vector<Figure> figures_in(const std::string& page) {
  return figures_of(page, [](const std::string&) { return small_table(); });
}

/// What the marker's statistics are, as figures with so many decimals as in `shown`.
std::string computed(const std::string& marker, const std::string& shown) {
  std::string all;
  for (const Figure& figure : figures_in("<!-- figures t.csv " + marker + " -->" + shown)) all += figure.computed + " ";
  return all;
}

std::vector<std::string> pages() {
  std::vector<std::string> all;
  const std::filesystem::path top = DETP_SOURCE;
  for (const char* folder : {"model", "sim", "validate", "notebooks-data", "tests"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / folder))
      if (entry.path().extension() == ".md") all.push_back(std::filesystem::relative(entry.path(), top).string());
  all.push_back("README.md");
  return all;
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("every figure with a marker is what notebooks-data has") {
    for (const std::string& page : pages()) {
      const std::string text = source_text(page);
      if (text.find("<!-- figures ") == std::string::npos) continue;
      for (const Figure& figure : figures_of(text, published)) {
        INFO("page ", page, ", figure.statistic ", figure.statistic);
        CHECK(figure.shown == figure.computed);
      }
    }
  }

  TEST_CASE("every value of notebooks-data has the type that datapackage.json gives, as a Frictionless table has it") {
    const Json package = Json::parse(source_text("notebooks-data/datapackage.json"));
    static const std::regex name("[-a-z0-9._/]+");
    static const std::map<std::string, std::regex> types{
        {"string", std::regex("[^\\x00]*")},
        {"number", std::regex("[-+]?[0-9]+(\\.[0-9]*)?([eE][-+]?[0-9]+)?")},
        {"integer", std::regex("[-+]?[0-9]+")},
        {"boolean", std::regex("true|false")}};
    CHECK(std::regex_match(package.at("name").get<std::string>(), name));
    for (const Json& resource : package.at("resources")) {
      CHECK(std::regex_match(resource.at("name").get<std::string>(), name));
      const std::string path = resource.at("path");
      CAPTURE(path);
      const Rows rows = published(path);
      CHECK_FALSE(rows.empty());
      for (const Json& field : resource.at("schema").at("fields")) {
        const std::string column = field.at("name");
        CAPTURE(column);
        const std::regex& type = types.at(field.at("type"));
        std::string wrong;
        for (const CsvRow& row : rows)
          if (const std::string& value = row.at(column); !value.empty() && !std::regex_match(value, type))
            wrong = value;
        CHECK(wrong == "");
      }
    }
  }

  TEST_CASE("statements.md counts its verdicts") {
    const std::string page = source_text(
        "notebooks-data"
        "/statements.md");
    int all = 0;
    int hold = 0;
    int do_not = 0;
    for (const std::string& line : figures::split(page, '\n')) {
      const std::vector<std::string> cells = figures::cells_of(line);
      if (cells.size() < 5 || std::isdigit(static_cast<unsigned char>(cells[0][1])) == 0) continue;
      ++all;
      hold += cells[3] == " holds " ? 1 : 0;
      for (const std::string verdict : {" does not hold", " refuted", " undecided"})
        do_not += cells[3].starts_with(verdict) ? 1 : 0;
    }
    check_says(page, fmt::format("Of {} statements, {} hold, {} hold in part, and {} do not.", all, hold,
                                 all - hold - do_not, do_not));
  }

  TEST_CASE("statistics of the selected rows, rounded as the page shows them") {
    CHECK(computed("where engine=simd: count", "3 rows") == "3 ");
    CHECK(computed("where engine=simd x<=2: count max(ratio)", "2 rows, at most 8.00") == "2 8.00 ");
    CHECK(computed("where engine!=plain: geomean(ratio) median(ratio) mean(ratio)", "0.00, 0, 0.0") == "2.00 2 3.5 ");
    CHECK(computed("where engine=simd: share(ratio>1)", "66.7 %") == "66.7 ");
    CHECK(computed("where engine=simd: geomean(ratio)-1", "12 % longer") == "100 ");
    CHECK(computed("where engine=simd: p50(ratio)", "2.0") == "2.0 ");
    // Geometric means of the scenes: 1 and 8; Student's t of one degree of freedom is 12.706.
    CHECK(computed("where engine=simd: low(ratio,scene)", "0.0000000") ==
          fmt::format("{:.7f} ", std::exp(std::log(8) / 2 * (1 - 12.7062047))));
  }

  TEST_CASE("figures of a table are found by row and column") {
    const std::string page =
        "Text 9.\n\n<!-- figures t.csv where x<5\ncolumns ; count ; max(ratio) min(ratio) ;\nrows engine=simd ; "
        "scene=a "
        "engine=simd\nrows scene=b engine=simd\n-->\n\n| 7 | n | range | note |\n|---|---|---|---|\n| 5 | 3 | 8 (0.5) "
        "| 6 |\n"
        "| 5 | 2 | 2 (0.5) | 6 |\n| 5 | 1 | 8 (8) | 6 |\n\nMore 4.";
    const auto found = figures_in(page);
    REQUIRE(found.size() == 9);
    for (const Figure& figure : found) CHECK(figure.shown == figure.computed);
    // A column with conditions of its own.
    const auto sides = figures_in(
        "<!-- figures t.csv where x>1\ncolumns ; @engine=simd count ; @engine=plain max(ratio)\nrows scene=b\n-->\n| | "
        "n | m |\n|-|-|-|\n| b | 1 | 1.5 |\n");
    REQUIRE(sides.size() == 2);
    for (const Figure& figure : sides) CHECK(figure.shown == figure.computed);
    CHECK(figures_in("<!-- figures t.csv where engine=simd: max(ratio) -->8.1").front().computed == "8.0");
  }

  TEST_CASE("a marker that cannot be checked is refused") {
    for (const std::string bad :
         {"where engine=gpu: count", "where motor=simd: count", "where engine=simd: middle(ratio)", "where engine=simd",
          "engine=simd: count", "where engine=plain: max(ratio)", "where engine: count"})
      CHECK_THROWS_AS((void)figures_in("<!-- figures t.csv " + bad + " -->1"), std::invalid_argument);
    CHECK_THROWS_AS((void)figures_in("<!-- figures t.csv where engine=simd: count -->none"), std::invalid_argument);
    CHECK_THROWS_AS(
        (void)figures_in("<!-- figures t.csv where x<5\ncolumns count\nrows x<2\n-->\n|a|\n|-|\n|1|\n|1|\n\n"),
        std::invalid_argument);
  }
}

}  // namespace detp::support
