#pragma once

#include <span>
#include <string>
#include <string_view>

namespace detp {

/// Least number of letters inserted, left out, replaced or swapped with their neighbour that turns one word into the
/// other, no letter being touched twice.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// For a message on an unknown name: "; did you mean octree?", or nothing where no name is near: within a third of the
/// word's letters, and within three.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace detp
