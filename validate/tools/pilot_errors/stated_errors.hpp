#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace detp::study {

/// What a pilot predicted, with the error that it stated, and what was found.
struct StatedError {
  std::uint64_t seed;
  std::string search;    ///< columns that describe the search, for the reader alone
  std::string quantity;  ///< "hits" and other counts, or "seconds"
  double predicted;
  double error;  ///< standard error
  double found;
};

/// The table of stated errors as CSV.
inline constexpr std::string_view stated_errors_header =
    "seed,kind,field,rays,discs,radius,shape,quantity,predicted,error,found\n";
[[nodiscard]] std::string csv_row(const StatedError& one);
/// Reads what csv_row wrote. Throws std::invalid_argument for anything else.
[[nodiscard]] std::vector<StatedError> read_stated_errors(std::istream& csv);

/// A line for each quantity: how many predictions are within two stated errors and within 10 %, how large the errors are,
/// and how many predictions are wrong, though their stated error is 0.
[[nodiscard]] std::string summary(const std::vector<StatedError>& all);

}  // namespace detp::study
