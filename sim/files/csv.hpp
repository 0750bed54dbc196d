#pragma once

#include "table.hpp"

namespace detp::sim {

/// Reads numbers from CSV: a header with the columns in any order, then rows. Passes each row to `sink` as it is read.
/// Returns the number of rows.
///
/// Fields end at commas, semicolons, tabs or blanks, as the header says, and may be in quotes. Headings may be in upper or lower case; other columns
/// are skipped (ColumnChoice::unused). Lines that begin with # are comments; the last one may have the headings. Blanks around fields, blank
/// lines, any line ends, a byte order mark and a line "sep=;" are accepted.
///
/// Numbers are read independently of the locale, including "inf" and "nan", with exponents of Fortran (1.5D-01), and with decimal commas where
/// fields do not end at commas and no line has a point. Throws FileError with the line if the header is missing, or has a misspelt or a repeated
/// column; if a required column is missing; if a row has too few or too many fields; if a field of a column that is read is not a number; and as TextLines does.
std::size_t read_csv(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                     std::stop_token stop = {});

}  // namespace detp::sim
