#pragma once

#include <string_view>

/// page.css and page.js, and their SHA-256 in hexadecimal digits; CMake makes the definitions of the files.
namespace detp::validate {

extern const std::string_view page_css;
extern const std::string_view page_css_digest;
extern const std::string_view page_js;
extern const std::string_view page_js_digest;

}  // namespace detp::validate
