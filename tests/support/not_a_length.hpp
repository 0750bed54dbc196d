#pragma once

#include <array>
#include <limits>

/// Numbers that public functions must refuse.
namespace detp::support {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Never a length, a time or a number of things; for quantities that may be zero.
inline constexpr std::array not_a_size{not_a_number, infinity, -infinity, -1.0, -1e-300};

/// Not a positive length.
inline constexpr std::array not_a_length{not_a_number, infinity, -infinity, -1.0, -1e-300, 0.0, -0.0};

/// Not a radius ratio Q.
inline constexpr std::array not_a_ratio{not_a_number, infinity, -infinity, -0.5, 0.0, 1.0, 1.5};

/// Not a number of rays or samples.
inline constexpr std::array not_a_count{not_a_number, infinity, -infinity, -1.0, 0.0, 0.5, 1e6 + 0.5, 1.1e18};

/// Not a dimension of samples.
inline constexpr std::array not_a_dimension{not_a_number, infinity, -infinity, 0.0, 0.999, 3.001, -2.0};

}  // namespace detp::support
