#include "detp/model/vocabulary/quoted.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("known answer") {
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
