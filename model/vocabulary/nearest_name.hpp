#pragma once

#include <span>
#include <string>
#include <string_view>

namespace detp {

/// The edit distance of two words: the smallest number of changes that turn a into b. A change inserts, deletes or
/// replaces a letter, or swaps two neighbouring letters. Each letter is changed at most once.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// For a message about an unknown name: "; did you mean octree?". Empty if the nearest name's edit distance from the
/// word is more than 3, or more than a third of the word's length (rounded up), or if the word has more than 40
/// letters.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace detp
