#include "detp/sim/files/csv.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "detp/sim/files/number_text.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using detp::sim::suffix_of;
using support::ScratchFolder;

namespace {

const std::vector<TableColumn> columns{{"a", {}, {}}, {"b", {}, {}}, {"c", 5.0, 6.0}};

struct Table {
  std::array<std::vector<double>, 3> values;
  std::vector<std::string> places;
};

/// The row's place, as its error message has it.
std::string place_of(const TableRow& row) {
  return support::file_error_of([&] { row.fail("here"); });
}

Table read_table(const std::string& content) {
  const ScratchFolder folder;
  Table table;
  const std::size_t rows = read_csv(folder.file("t.csv", content), columns, [&](const TableRow& row) {
    for (std::size_t i = 0; i < 3; ++i) table.values[i].push_back(row[i]);
    const std::string place = place_of(row);
    table.places.push_back(place.substr(place.find("t.csv")));
  });
  CHECK(rows == table.places.size());
  return table;
}

std::string table_error(const std::string& content) {
  return support::file_error_of([&] { (void)read_table(content); });
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("columns may be in any order, with blanks, blank lines, CR LF and a byte order mark") {
    const Table table = read_table("\xEF\xBB\xBF\r\n b ,a\r\n\r\n 1.5 , +2 \r\n   \r\n-3e-2,\t0.1\r\n");
    REQUIRE(table.places.size() == 2);
    CHECK(table.values[0] == std::vector<double>{2, 0.1});
    CHECK(table.values[1] == std::vector<double>{1.5, -0.03});
    CHECK(table.places == std::vector<std::string>{"t.csv:4: here", "t.csv:6: here"});
  }

  TEST_CASE("lines may end in CR alone") {
    const Table table = read_table("a,b\r1,2\r\r3,4");
    CHECK(table.values[1] == std::vector<double>{2, 4});
    CHECK(table.places == std::vector<std::string>{"t.csv:2: here", "t.csv:4: here"});
  }

  TEST_CASE("the first bad row is refused before later rows are read") {
    const ScratchFolder folder;
    const std::string path = folder.file("t.csv", "a,b\n1,2\n3,4\n5,x\n");
    std::size_t rows = 0;
    const auto stop_at_second = [&](const TableRow& row) {
      if (++rows == 2) row.fail("enough");
    };
    CHECK(support::file_error_of([&] { read_csv(path, columns, stop_at_second); }) == path + ":3: enough");
  }

  TEST_CASE("an absent column and an empty field have the default values") {
    CHECK(read_table("a,b\n1,2").values[2] == std::vector<double>{5});
    CHECK(read_table("a,b,c\n1,2,\n1,2,3\n").values[2] == std::vector<double>{6, 3});
  }

  TEST_CASE("numbers beyond a double's range become infinite or zero, and special values are read") {
    const Table table = read_table("a,b\n1e400,-1e400\n1e-400,4.9e-324\ninf,-Infinity\nnan,0\n");
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(table.values[0][0] == infinity);
    CHECK(table.values[1][0] == -infinity);
    CHECK(table.values[0][1] == 0);
    CHECK(table.values[1][1] == std::numeric_limits<double>::denorm_min());
    CHECK(table.values[0][2] == infinity);
    CHECK(table.values[1][2] == -infinity);
    CHECK(std::isnan(table.values[0][3]));
  }

  TEST_CASE("a locale with a decimal comma changes nothing") {
    const support::ScratchFolder folder;
    const std::string command =
        "localedef -i de_DE -f ISO-8859-1 " + folder.path("de_DE.ISO-8859-1") + " >/dev/null 2>&1";
    static_cast<void>(std::system(command.c_str()));
    ::setenv("LOCPATH", folder.path(".").c_str(), 1);
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    const bool comma = std::setlocale(LC_NUMERIC, "de_DE.ISO-8859-1") != nullptr;
    ::unsetenv("LOCPATH");
    if (!comma) {
      MESSAGE("skipped: localedef cannot make de_DE.ISO-8859-1 (Debian: locales)");
      return;
    }
    CHECK(*std::localeconv()->decimal_point == ',');
    CHECK(read_table("a,b\n1.5,1e-400\n").values[0][0] == 1.5);
    std::setlocale(LC_NUMERIC, before.c_str());
  }

  TEST_CASE("numbers beyond the range of any type are infinite or zero, in any notation") {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const char* large : {"1e309", "1e5000", "10e404000", "+1E+99999", "0.001e6000", "1e99999999999999999999"})
      CHECK(number_in(large) == infinity);
    CHECK(number_in("-1e5000") == -infinity);
    CHECK(number_in("1" + std::string(6000, '0')) == infinity);
    for (const char* small : {"1e-400", "1e-6000", "1e-404000", "1000e-6000", "1e-99999999999999999999"})
      CHECK(number_in(small) == 0);
    CHECK(number_in("0." + std::string(6000, '0') + "1") == 0);
    CHECK(std::signbit(number_in("-1e-6000").value()));
    CHECK(number_in("0e999999") == 0);
    CHECK_FALSE(number_in("1e5000x").has_value());
  }

  TEST_CASE("a suffix is a short ending behind the last dot of the name") {
    for (const char* path : {"a.ply", "/x/a.PLY", "x.csv/a.Ply", "a.csv.ply", ".hidden.ply", "ä.ply"})
      CHECK(suffix_of(path) == ".ply");
    for (const char* path : {"", "a", "x.ply/a", ".ply", "/x/.ply", "a.", "tmp.Q2xJmC7d9k", "run-0.5", "v1.20", "a.b c",
                             "a.p-y", "a.plyä", "/dev/stdout", "."})
      CHECK(suffix_of(path).empty());
    CHECK(suffix_of("clip.mp4") == ".mp4");
  }
}

TEST_SUITE("files of other programs") {
  TEST_CASE("separators, quotes, comments and headings as other programs write them") {
    const std::vector<double> a{1, 4}, b{0.5, -2};
    for (const std::string content :
         {"a,b\n1,0.5\n4,-2\n", "B,A\n0.5,1\n-2,4\n", "a;b\n1;0.5\n4;-2\n", "a\tb\n1\t0.5\n4\t-2\n",
          "a  b\n  1   0.5\n4 -2\n", "# by hand\n# again\na,b\n1,0.5\n# middle\n4,-2\n", "# a b\n1 0.5\n4 -2\n",
          "#a,b\n1,0.5\n4,-2\n", "sep=;\na;b\n1;0.5\n4;-2\n", "a;b\n1;0,5\n4;-2,0\n",
          "a b\n1,0D+00 5D-1\n4 -2d0\n\x1a\n", "\"a\",\"b\"\n\"1\",\"0.5\"\n4,-2\n",
          "\"\",\"a\",\"b\"\n\"1\",1,0.5\n\"2\",4,-2\n", "name,b,a,\n\"one, \"\"two\"\"\",0.5,1,\nx,-2,4,7\n",
          "\xEF\xBB\xBF a ; b ;note\r\n1;0.5;\r\n4;-2;x y\r\n"}) {
      CAPTURE(content);
      const Table table = read_table(content);
      CHECK(table.values[0] == a);
      CHECK(table.values[1] == b);
    }
  }

  TEST_CASE("columns that are none are named, and misspelt ones refused") {
    const ScratchFolder folder;
    const ColumnChoice choice({{"a", {}, {}}, {"length", 1.0, {}}, {"power", 1.0, {}}});
    const auto read = [&](const std::string& content) {
      return read_csv(folder.file("t.csv", content), choice, [](const TableRow&) {});
    };
    CHECK(read("id,a,Wave length,power\n1,2,3,4\n") == 1);
    CHECK(choice.unused() == std::vector<std::string>{"id", "Wave length"});
    CHECK(unused_notice("t.csv", choice.unused()) == "t.csv: columns \"id\", \"Wave length\" are not used");
    CHECK(unused_notice("t.csv", {"id"}) == "t.csv: column \"id\" is not used");
    CHECK(unused_notice("t.csv", {}).empty());
    CHECK(support::file_error_of([&] {
            read("a,lenght\n1,2\n");
          }).find(":1: unknown column \"lenght\"; did you mean length?") != std::string::npos);
    CHECK(support::file_error_of([&] { read("a,Powr\n1,2\n"); }).find("did you mean power?") != std::string::npos);
    CHECK(read("a,length,lenght\n1,2,3\n") == 1);
  }

  TEST_CASE("a long table with comments and a column that is none is read by several threads") {
    std::string content = "a;name;b\n";
    for (int row = 0; row < 50'000; ++row)
      content +=
          row % 20'000 == 19'999 ? "# here\n" : fmt::format("{};{};{}\n", row, row % 3000 == 0 ? "x" : "7", 2 * row);
    const Table table = read_table(content);
    CHECK(table.values[0].size() == 49'998);
    for (std::size_t i = 0; i < table.values[0].size(); ++i) REQUIRE(table.values[1][i] == 2 * table.values[0][i]);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an error is reported with its line") {
    std::string fifteen;
    for (int i = 0; i < 15; ++i) fifteen += "\\xff";
    support::check_errors(
        {{"", ": is empty; expected a header a,b,c"},
         {"\n \n", ": is empty"},
         {"a,b,a\n", ":1: column a appears twice"},
         {"a,c\n", ":1: the header has no column b; known are a,b,c"},
         {"1,2\n", ":1: the first line has numbers, and no heading is before it; expected a header a,b,c"},
         {"# a\n1,2\n", ":2: the first line has numbers"},
         {"a;b\n1.5;x\n", ":2: b is \"x\", which is not a number"},
         {"a;b\n1.5;2\n1;0,5\n", ":3: some numbers have decimal points, others decimal commas"},
         {"a;b\n1;0,5\n1.5;2\n", ":3: some numbers have decimal points, others decimal commas"},
         {"a;b\n1;1,000,000\n", ":2: b is \"1,000,000\", which is not a number; decimals need a point"},
         {"a\tb\n1 2\n", ":2: 1 fields, but the header has 2 columns, separated by tabs"},
         {"a,b\n1,\"2\n", ":2: a quote has no end"},
         {"a,b\n1,\"2\" 3\n", ":2: there is text between a quote and the next field"},
         {"a,b\n1\n", ":2: 1 fields, but the header has 2 columns"},
         {"a,b\n\n1,2,3\n", ":3: 3 fields, but"},
         {"a,b\n1,2,\n", ":2: 3 fields, but"},
         {"a,b\n1,\n", ":2: b is empty; a number is needed"},
         {"a,b\n1,2x\n", ":2: b is \"2x\", which is not a number"},
         {"a,b\n1,+-2\n", ":2: b is \"+-2\", which"},
         {"a,b\n1,0x10\n", ":2: b is \"0x10\", which"},
         {"a,b\n1,+\n", ":2: b is \"+\", which"},
         {"a,b\n1,\x1b[2J\n", ":2: b is \"\\x1b[2J\", which"},
         {"a,b\n1," + std::string(2'000'000, '7') + "x\n", ":2: b is \"" + std::string(60, '7') + "...\", which"},
         {std::string("\xFF\xFE", 2) + "a,b\n", ": is text in UTF-16"},
         {"a,b\n1,1 2\n", ":2: b is \"1 2\", which"},
         {std::string("a,b\n1,2\0\n", 9), ":2: contains a NUL byte"},
         {"a,b\n1," + std::string(99, '\xff') + "\n", ":2: b is \"" + fifteen + "...\", which"}},
        [&](const std::string& content) { return table_error(content); }, "t.csv");
  }

  TEST_CASE("a damaged file is read or refused, with no other effect") {
    const auto read_any = [](const std::string& path) { read_csv(path, columns, [](const TableRow&) {}); };
    CHECK(support::refused_when_damaged("t.csv", "a,b,c\n1,2.5,-3e-7\r\n4,5,\n7,8,inf\n", 2500, read_any) > 250);
  }
}
