#include "detp/model/vocabulary/checks.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/counts.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Contains;

namespace {

/// Powers of two, so that each sum shows which terms are in it.
template <class T>
Counts<T> powers() {
  Counts<T> counts;
  T value = 1;
  for_each_term(counts, [&](std::string_view, T& term) {
    term = value;
    value *= 2;
  });
  return counts;
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("the message names the quantity, the rule and the value") {
    CHECK_THROWS_WITH_AS(require_positive("disc radius", -1), "disc radius must be > 0 and finite (got -1)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_non_negative("path length", -0.5), "path length must be >= 0 and finite (got -0.5)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_finite("x", support::infinity), "x must be finite (got inf)", std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_ratio("Q", 1), "Q must be between 0 and 1, both excluded (got 1)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_count("rays", 2.5, 1, 1e18), "rays must be a whole number from 1 to 1e+18 (got 2.5)",
                         std::invalid_argument);
  }

  TEST_CASE("each check refuses values out of its range, and NaN") {
    for (const double bad : support::not_a_length) CHECK_THROWS_AS(require_positive("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_size)
      CHECK_THROWS_AS(require_non_negative("it", bad), std::invalid_argument);
    for (const double bad : {support::not_a_number, support::infinity, -support::infinity})
      CHECK_THROWS_AS(require_finite("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_ratio) CHECK_THROWS_AS(require_ratio("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_count)
      CHECK_THROWS_AS(require_count("it", bad, 1, 1e18), std::invalid_argument);
    CHECK_THROWS_AS(require_count("it", 4, 5, 7), std::invalid_argument);
    CHECK_THROWS_AS(require_count("it", 8, 5, 7), std::invalid_argument);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each check accepts values in its range, including the ends") {
    using limits = std::numeric_limits<double>;
    for (const double good : {limits::denorm_min(), 1.0, limits::max()}) {
      CHECK_NOTHROW(require_positive("it", good));
      CHECK_NOTHROW(require_non_negative("it", good));
      CHECK_NOTHROW(require_finite("it", -good));
    }
    CHECK_NOTHROW(require_non_negative("it", 0));
    CHECK_NOTHROW(require_ratio("it", limits::denorm_min()));
    CHECK_NOTHROW(require_ratio("it", 1 - limits::epsilon() / 2));
    for (const double good : {1.0, 2.0, 1e18}) CHECK_NOTHROW(require_count("it", good, 1, 1e18));
  }

  TEST_CASE("tests are tests of spheres, boxes and discs together") {
    CHECK(tests(Counts<std::uint64_t>{.cull_tests = 3, .disc_tests = 4, .steps = 100}) == 7);
  }

  TEST_CASE("plain text, also beyond ASCII, is quoted unchanged") {
    CHECK(detp::quoted("") == "\"\"");
    CHECK(detp::quoted("1.5e3 x\\y") == "\"1.5e3 x\\y\"");
    CHECK(detp::quoted("r₀ = 1 µm, 𝛼") == "\"r₀ = 1 µm, 𝛼\"");
  }

  TEST_CASE("control characters, invalid UTF-8 and marks of writing direction are escaped byte by byte") {
    using namespace std::string_view_literals;
    CHECK(escaped("a\x1b[2J\r\n\t\x7f"sv) == "a\\x1b[2J\\x0d\\x0a\\x09\\x7f");
    CHECK(escaped("a\0b"sv) == "a\\x00b");
    CHECK(escaped("\xc2\x9b"
                  "31m") == "\\xc2\\x9b31m");  // C1 control: some terminals treat it as ESC [
    CHECK(escaped("\xc0\xaf \xed\xa0\x80") == "\\xc0\\xaf \\xed\\xa0\\x80");  // overlong; a surrogate
    CHECK(escaped("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");             // beyond U+10FFFF
    CHECK(escaped("\xe2\x82") == "\\xe2\\x82");                               // truncated
    CHECK(escaped("\xff") == "\\xff");
    CHECK(escaped("a\u202eb\u2028") == "a\\xe2\\x80\\xaeb\\xe2\\x80\\xa8");
    for (const std::string_view text : {"a\x1b\xff\\x"sv, "µ\0"sv}) CHECK(escaped(escaped(text)) == escaped(text));
  }

  TEST_CASE("a quote has at most 60 characters, escapes included") {
    CHECK(detp::quoted(std::string(60, 'x')) == '"' + std::string(60, 'x') + '"');
    CHECK(detp::quoted(std::string(20'000'000, '7')) == '"' + std::string(60, '7') + "...\"");
    CHECK(shortened(std::string(99, '\1')).size() == 60 + 3);
    std::string alphas;
    for (int i = 0; i < 60; ++i) alphas += "α";
    CHECK(shortened(alphas) == alphas);
    CHECK(shortened(alphas + "α") == alphas + "...");
  }

  TEST_CASE("a long path keeps its beginning and its end") {
    CHECK(shown_path("/tmp/\xff.obj") == "/tmp/\\xff.obj");
    CHECK(shown_path(std::string(200, 'p')) == std::string(200, 'p'));
    const std::string shown = shown_path("/begin/" + std::string(4000, 'p') + "/end.ply");
    CHECK(shown.size() == 200);
    CHECK(shown.starts_with("/begin/ppp"));
    CHECK(shown.ends_with("ppp/end.ply"));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("each term is visited once, under its own name, and no term is missing") {
    std::set<std::string_view> names;
    std::vector<double> values;
    for_each_term(powers<double>(), [&](std::string_view name, double term) {
      names.insert(name);
      values.push_back(term);
    });
    CHECK(names.size() == 16);
    CHECK(values.size() == 16);
    CHECK(sizeof(Counts<double>) == 16 * sizeof(double));
    CHECK(values.back() == 32768);
  }

  TEST_CASE("an observation converts to the same numbers") {
    CHECK(as_expected(powers<std::uint64_t>()) == powers<double>());
    CHECK(as_expected(Counts<std::uint64_t>{}) == Counts<double>{});
  }
}

namespace detp {

TEST_SUITE("identities") {
  TEST_CASE("the edit distance counts letters inserted, left out, replaced and swapped") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("octree", "octree") == 0);
    CHECK(edit_distance("", "grid") == 4);
    CHECK(edit_distance("chose", "choose") == 1);
    CHECK(edit_distance("chooose", "choose") == 1);
    CHECK(edit_distance("choise", "choose") == 1);
    CHECK(edit_distance("cohose", "choose") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
  }

  TEST_CASE("the edit distance is the same in both directions") {
    CHECK(edit_distance("octree", "tree-box") == edit_distance("tree-box", "octree"));
    CHECK(edit_distance("a", "grid") == edit_distance("grid", "a"));
  }

  TEST_CASE("the nearest name is suggested where it is near, and nothing else") {
    constexpr std::array<std::string_view, 4> names{"octree", "box-tree", "grid", "sphere-tree"};
    CHECK(did_you_mean("octre", names) == "; did you mean octree?");
    CHECK(did_you_mean("boxtree", names) == "; did you mean box-tree?");
    CHECK(did_you_mean("gird", names) == "; did you mean grid?");
    CHECK(did_you_mean("quadtree", names).empty());
    CHECK(did_you_mean("", names).empty());
    CHECK(did_you_mean("x", names).empty());
    CHECK(did_you_mean("octree", {}).empty());
    CHECK(did_you_mean(std::string(100'000, 'o'), names).empty());
  }
}

}  // namespace detp
