#pragma once

#include "world.hpp"

namespace detp::cli {

/// The processes of mpirun, for JoinWorld; null if it started one alone, or none.
[[nodiscard]] std::unique_ptr<World> join_mpi(const std::stop_token& by_signal, const std::function<void()>& stop);

}  // namespace detp::cli
