#pragma once

#include <stop_token>
#include <string>

#include "table.hpp"

namespace detp::sim {

/// Reads particles of an MCPL file (T. Kittelmann et al., "Monte Carlo Particle Lists: MCPL", Computer Physics Communications 218, 2017; format 3),
/// also packed by gzip (.mcpl.gz), as a table: ox, oy, oz (cm), dx, dy, dz, power (the weight), energy (weight times kinetic energy, MeV), ekin, time (ms), pdgcode,
/// and userflags if there are any. `--columns power=energy` takes the energy for the power.
///
/// Throws FileError for other files and versions, a header that contradicts itself, and a file that ends early; as read_table; and Stopped.
std::size_t read_mcpl(const std::string& path, const ColumnChoice& choice, const TableSink& sink, std::stop_token stop);

}  // namespace detp::sim
