#pragma once

namespace detp::cli {

/// The whole program: parses the arguments, runs the command, prints its result or an error. Returns the exit code.
int run_program(int argc, char** argv);

}  // namespace detp::cli
