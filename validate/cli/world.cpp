#include "world.hpp"

#include <algorithm>
#include <cstdlib>

namespace detp::cli {

int launched_processes() {
  int most = 1;
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})  // Open MPI; MPICH and Slurm
    if (const char* const value = std::getenv(name)) most = std::max(most, std::atoi(value));
  return most;
}

}  // namespace detp::cli
