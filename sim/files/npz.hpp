#pragma once

#include <stop_token>
#include <string>

#include "table.hpp"

namespace detp::sim {

/// Reads a table from a file of NumPy with several arrays (.npz, of savez or savez_compressed), whole in memory: a column for each array of
/// one dimension, with its name; three for an array of three columns (o: ox, oy, oz), more for one of other widths (power: power_1, power_2, …); the
/// fields of a structured array. Arrays of other kinds are not used.
///
/// Throws FileError for a file that is no ZIP archive or damaged, arrays of different lengths, and as read_table; std::length_error if it
/// would not fit in memory, and Stopped.
std::size_t read_npz(const std::string& path, const ColumnChoice& choice, const TableSink& sink, std::stop_token stop);

}  // namespace detp::sim
