#pragma once

#include "table.hpp"

namespace detp::sim {

/// Reads numbers from CSV: a header, its columns in any order, then rows, each handed on as it is read. Returns their
/// number.
///
/// Fields end at commas; blanks around them, blank lines, any line ends and a byte order mark are accepted; quotes and
/// comments are not. Numbers are read whatever the locale, "inf" and "nan" among them. Throws FileError with the line:
/// a header missing, with unknown columns or one twice; a required column missing; too few or too many fields; a field
/// that is no number; and as TextLines does.
std::size_t read_csv(const std::string& path, const std::vector<TableColumn>& columns, const TableSink& sink,
                     std::stop_token stop = {});

}  // namespace detp::sim
