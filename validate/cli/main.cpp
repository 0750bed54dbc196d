#include "program.hpp"

int main(int argc, char** argv) { return detp::cli::run_program(argc, argv); }
