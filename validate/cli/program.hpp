#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "detp/sim/ranks/ranks.hpp"

namespace detp::cli {

/// The processes that run the same command together.
class World {
 public:
  virtual ~World() = default;

  [[nodiscard]] virtual sim::Ranks& ranks() = 0;
  /// This process's share of its machine's cores.
  [[nodiscard]] virtual int cores() const = 0;
  /// The last call; as sim::MpiRanks::end. Does not return if another process is given up: ends this one with the code.
  virtual void end(const std::string& message, int code) = 0;
};

/// Joins the other processes, if there are any; else returns null. `by_signal`: a stop that a signal requested. `stop`, which may be called on
/// any thread until the world is destroyed, requests the same when another process was stopped.
using JoinWorld =
    std::function<std::unique_ptr<World>(const std::stop_token& by_signal, const std::function<void()>& stop)>;

/// Number of processes that a launcher of MPI started together, by its variables; 1 without one.
[[nodiscard]] int launched_processes();

/// The processes of mpirun, for JoinWorld; null if it started one alone, or none.
[[nodiscard]] std::unique_ptr<World> join_mpi(const std::stop_token& by_signal, const std::function<void()>& stop);

/// The whole program: parses the arguments, runs the command, prints its result or an error. Returns the exit code. `join`: how to find the
/// processes that run it together; without it, a program that a launcher of MPI started several times refuses to run.
int run_program(int argc, char** argv, const JoinWorld& join = {});

}  // namespace detp::cli
