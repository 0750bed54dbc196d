#pragma once

#include <string>

#include "parts.hpp"

/// The page of `detp report`.
namespace detp::validate {

/// The JSON answer of `detp report` as HTML: complete, with nothing outside of it. All text of the answer is escaped, and a content security
/// policy allows only the page's own style and script. The same answer gives the same bytes. Throws std::invalid_argument if the answer
/// has numbers where a chart needs others (not finite).
[[nodiscard]] std::string page_html(const ReportJson& report);

}  // namespace detp::validate
