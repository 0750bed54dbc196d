#include "index_mailbox.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/model/vocabulary/checks.hpp"

namespace detp::model {
namespace {

using std::numbers::pi;

constexpr std::array table{
#include "index_mailbox_table.inc"
};
constexpr double first = 1.0 / 16;  ///< x of the first entry; x grows by a factor of √2 from entry to entry

/// R(x), linear in log x; below the table linear in x.
double beyond_one_cell(double x) {
  if (x <= first) return 6 * pi + (table.front() - 6 * pi) * x / first;
  const double place = std::min(2 * std::log2(x / first), static_cast<double>(table.size() - 1));
  const auto entry = std::min(static_cast<std::size_t>(place), table.size() - 2);
  const double share = place - static_cast<double>(entry);
  return (1 - share) * table[entry] + share * table[entry + 1];
}

}  // namespace

double faces_seen(double x, double planes, double lines, Insertion insertion) {
  require_non_negative("disc radius over cell side", x);
  require_non_negative("planes that cross a disc", planes);
  require_non_negative("lines that pierce a disc", lines);
  if (insertion == Insertion::bounding_box) return 6 + 4 * planes + 2 * lines;
  return 6 + beyond_one_cell(x) / (1.5 * pi) * planes + 4.0 / 3 * lines;
}

}  // namespace detp::model
