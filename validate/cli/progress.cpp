#include <fmt/format.h>
#include <unistd.h>

#include "command.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "messages.hpp"

namespace detp::cli {

void note(const CommonOptions& common, const std::string& message) {
  if (!common.quiet) write_error(escaped(message) + "\n");
}

ProgressLine::ProgressLine(const CommonOptions& common) : visible_(!common.quiet && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (visible_) write_error("\r\033[K");
}

void ProgressLine::show(std::string_view what, double done) const {
  if (visible_) write_error(fmt::format("\r\033[K{:3.0f} %  {}", 100 * done, what));
}

}  // namespace detp::cli
