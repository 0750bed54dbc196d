#pragma once

#include <span>
#include <string>
#include <string_view>

namespace detp {

/// The edit distance of two words: the smallest number of letters to insert, delete, replace or swap with their
/// neighbour. Each letter is changed at most once.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// For a message about an unknown name: "; did you mean octree?". Empty if no name is near: within a third of the
/// word's letters, and within three letters.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace detp
