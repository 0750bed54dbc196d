#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace detp::validate {

/// The x >= 0 for which |A x - b| is least, by the active set method of Lawson and Hanson (Solving Least Squares
/// Problems, 1974, chapter 23): unknowns enter one by one where a positive value helps, and leave where a joint fit
/// would make them negative; one that has left may enter again.
///
///     optimal:   x >= 0,   g = Aᵀ(b - A x) <= 0,   g_j = 0 where x_j > 0
///
///   where  a    A row by row: b.size() rows of `unknowns` numbers;   b  the right side
///
/// Columns may differ in scale by any factor that squares within a double; of columns that depend on each other some
/// stay 0. Accuracy   g <= 1e-13 |a_j| |b| for each column a_j that is 0 in x; else that of a QR factorisation.
/// Throws     std::invalid_argument where the numbers are not finite or a.size() is not b.size() times `unknowns`.
[[nodiscard]] std::vector<double> non_negative_fit(std::span<const double> a, std::size_t unknowns,
                                                   std::span<const double> b);

}  // namespace detp::validate
