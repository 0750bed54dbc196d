#include "program.hpp"
#ifdef DETP_MPI
#include "mpi_world.hpp"
#endif

int main(int argc, char** argv) {
#ifdef DETP_MPI
  return detp::cli::run_program(argc, argv, detp::cli::join_mpi);
#else
  return detp::cli::run_program(argc, argv);
#endif
}
