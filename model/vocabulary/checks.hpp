#pragma once

#include <string_view>

/// Checks at public doors: always on, one wording for all. Each throws std::invalid_argument with the problem and the
/// offending value: "disc radius must be > 0 and finite (got -1)".
namespace detp {

/// Refuses NaN, infinities, zero and negative numbers.
void require_positive(std::string_view what, double value);

/// Refuses NaN, infinities and negative numbers.
void require_non_negative(std::string_view what, double value);

/// Refuses NaN and infinities.
void require_finite(std::string_view what, double value);

/// Refuses all but 0 < value < 1.
void require_ratio(std::string_view what, double value);

/// Refuses all but whole numbers from least to most, given as a double because counts reach 1e18.
void require_count(std::string_view what, double value, double least, double most);

}  // namespace detp
