#pragma once

#include <stdexcept>

namespace detp::sim {

/// Work that was ended by a stop request (Ctrl-C, a time limit) before it had a result. The message says how far it
/// came: "stopped while reading rays.csv after 12000 lines".
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace detp::sim
