#include "common_options.hpp"

#include <unistd.h>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/cli/text/messages.hpp"

namespace detp::cli {

Screen CommonOptions::screen() const {
  return output ? Screen{.width = 0, .colour = colour == Colour::always} : screen_of(STDOUT_FILENO, colour);
}

void note(const CommonOptions& common, const std::string& message) {
  if (common.quiet) return;
  const Screen screen = screen_of(STDERR_FILENO, common.colour);
  const bool warning = message.starts_with("warning: ");
  const char* const wipe = isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";  // erases the progress line
  std::string text = escaped(message) + "\n";
  if (screen.width > 0) text = wrapped(escaped(message), screen.width, 2);  // a terminal; elsewhere a line stays one
  write_error(wipe + styled(screen, warning ? Style::doubtful : Style::plain, text));
}

}  // namespace detp::cli
