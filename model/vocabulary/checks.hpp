#pragma once

#include <string_view>

/// Checks of the arguments of public functions, always on, with one wording for all. Each throws std::invalid_argument,
/// whose message names the problem and the value: "disc radius must be > 0 and finite (got -1)".
namespace detp {

/// Refuses NaN, infinities, zero and negative numbers.
void require_positive(std::string_view what, double value);

/// Refuses NaN, infinities and negative numbers.
void require_non_negative(std::string_view what, double value);

/// Refuses NaN and infinities.
void require_finite(std::string_view what, double value);

/// Accepts only 0 < value < 1.
void require_ratio(std::string_view what, double value);

/// Accepts only 0 <= value <= 1.
void require_share(std::string_view what, double value);

/// Accepts only whole numbers from least to most. The value is a double because counts reach 1e18.
void require_count(std::string_view what, double value, double least, double most);

}  // namespace detp
