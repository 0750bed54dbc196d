#include "stated_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "detp/validate/statistics/statistics.hpp"

namespace detp::study {

std::string csv_row(const StatedError& one) {
  return fmt::format("{},{},{},{:.9g},{:.6g},{:.9g}\n", one.seed, one.search, one.quantity, one.predicted, one.error,
                     one.found);
}

std::vector<StatedError> read_stated_errors(std::istream& csv) {
  constexpr std::size_t columns = 11;
  constexpr std::size_t of_search = 6;
  std::vector<StatedError> all;
  std::string line;
  std::getline(csv, line);
  if (line + "\n" != stated_errors_header) throw std::invalid_argument("not a table of stated errors: " + line);
  while (std::getline(csv, line)) {
    std::vector<std::string> field;
    std::istringstream fields(line);
    for (std::string text; std::getline(fields, text, ',');) field.push_back(text);
    if (field.size() != columns) throw std::invalid_argument("a row of stated errors has 11 fields: " + line);
    all.push_back({.seed = std::stoull(field[0]),
                   .search = fmt::format("{}", fmt::join(field.begin() + 1, field.begin() + 1 + of_search, ",")),
                   .quantity = field[1 + of_search],
                   .predicted = std::stod(field[2 + of_search]),
                   .error = std::stod(field[3 + of_search]),
                   .found = std::stod(field[4 + of_search])});
  }
  return all;
}

std::string summary(const std::vector<StatedError>& all) {
  std::vector<std::string> quantities;
  for (const StatedError& one : all)
    if (std::find(quantities.begin(), quantities.end(), one.quantity) == quantities.end())
      quantities.push_back(one.quantity);
  std::string text =
      "| | predictions | within two errors | within 10 % | error over value, median | wrong, error 0 |\n|---|---|\n";
  for (const std::string& quantity : quantities) {
    int predictions = 0;
    int inside = 0;
    int close = 0;
    int wrong = 0;
    std::vector<double> relative;
    for (const StatedError& one : all) {
      if (one.quantity != quantity) continue;
      constexpr double rounding = 1e-6;
      const double off = std::abs(one.predicted - one.found);
      ++predictions;
      inside += off <= 2 * one.error + rounding * one.found ? 1 : 0;
      close += off <= 0.1 * one.found ? 1 : 0;
      wrong += one.error == 0 && off > rounding * one.found ? 1 : 0;
      if (one.found > 0) relative.push_back(one.error / one.found);
    }
    const auto percent = [&](int share) { return 100.0 * share / predictions; };
    text += fmt::format("| {} | {} | {:.0f} % | {:.0f} % | {:.0f} % | {} |\n", quantity, predictions, percent(inside),
                        percent(close), relative.empty() ? 0 : 100 * validate::median(relative), wrong);
  }
  return text;
}

}  // namespace detp::study
