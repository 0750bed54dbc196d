#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "command.hpp"

namespace detp::cli {

void note(const CommonOptions& common, const std::string& message) {
  if (!common.quiet) fmt::print(stderr, "{}\n", message);
}

ProgressLine::ProgressLine(const CommonOptions& common) : visible_(!common.quiet && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(std::string_view what, double done) const {
  if (visible_) fmt::print(stderr, "\r\033[K{:3.0f} %  {}", 100 * done, what);
}

}  // namespace detp::cli
