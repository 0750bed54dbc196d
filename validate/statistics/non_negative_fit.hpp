#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace detp::validate {

/// The x >= 0 for which |A x - b| is least, by the active set method of Lawson and Hanson (Solving Least Squares
/// Problems, 1974, chapter 23). An unknown enters the fit if a positive value lowers the error. An unknown leaves the
/// fit if the joint fit would make it negative, and may enter again later.
///
///     optimal:   x >= 0,   g = Aᵀ(b - A x) <= 0,   g_j = 0 if x_j > 0
///
///   where  a    A row by row: b.size() rows of `unknowns` numbers;   b  the right side
///
/// Columns may differ in scale by any factor whose square fits a double. If columns are linearly dependent, the
/// unknowns of some of them stay 0. Accuracy: g_j <= 1e-13 |a_j| |b| if x_j = 0, where a_j is column j; the positive
/// x_j have the accuracy of a QR factorisation. Throws std::invalid_argument if a number is not finite or a.size() is
/// not b.size() times `unknowns`.
[[nodiscard]] std::vector<double> non_negative_fit(std::span<const double> a, std::size_t unknowns,
                                                   std::span<const double> b);

}  // namespace detp::validate
