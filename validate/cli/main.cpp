#include "program.hpp"

#ifdef DETP_JEMALLOC
// The first touch of a small page took 11 µs on a virtual machine, as long as thousands of tests of rays. So freed memory is kept for 30 s, shared by all
// threads, and in large pages.
extern "C" const char* malloc_conf;
const char* malloc_conf = "thp:always,metadata_thp:auto,narenas:1,dirty_decay_ms:30000";
#endif

int main(int argc, char** argv) {
#ifdef DETP_MPI
  return detp::cli::run_program(argc, argv, detp::cli::join_mpi);
#else
  return detp::cli::run_program(argc, argv);
#endif
}
