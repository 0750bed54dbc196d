#pragma once

#include <string>
#include <string_view>

namespace detp::sim {

/// The ending of a file's name that says its format, in lower case: ".ply" for "a/TREE.PLY". Empty if there is none. An ending
/// is a dot after another letter, and 1 to 5 letters or digits that are not all digits: names such as run-0.5, tmp.Q2xJmC7d9k and
/// .out have none.
[[nodiscard]] std::string suffix_of(std::string_view path);

}  // namespace detp::sim
