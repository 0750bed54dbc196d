#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "detp/sim/ranks/ranks.hpp"
#include "detp/validate/cli/text/screen.hpp"

namespace detp::cli {

/// The options of every command.
struct CommonOptions {
  std::string format = "text";
  Colour colour = Colour::automatic;
  std::optional<std::string> output;
  bool quiet = false;
  std::uint64_t seed = 1;
  int threads = 0;        ///< 0: all cores
  double time_limit = 0;  ///< seconds; 0: none
  std::optional<std::string> memory_limit;
  sim::Ranks* ranks = nullptr;  ///< the processes that run this command together; null: this one alone

  [[nodiscard]] Screen screen() const;
  /// This process is the one that answers: it prints, and writes files.
  [[nodiscard]] bool answers() const { return ranks == nullptr || ranks->rank() == 0; }
};

/// Writes a line to stderr, unless --quiet is set. A message that begins with "warning: " is coloured.
void note(const CommonOptions& common, const std::string& message);

}  // namespace detp::cli
