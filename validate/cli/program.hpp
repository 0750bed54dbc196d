#pragma once

#include "world.hpp"

namespace detp::cli {

/// The whole program: parses the arguments, runs the command, prints its result or an error. Returns the exit code. `join`: how to find the
/// processes that run it together; without it, a program that a launcher of MPI started several times refuses to run.
int run_program(int argc, char** argv, const JoinWorld& join = {});

}  // namespace detp::cli
