#pragma once

#include <string_view>

namespace detp::sim {

/// Bytes that one array or index may take: half of the machine's memory.
[[nodiscard]] double memory_budget();

/// Throws std::length_error, naming the bytes, where `bytes` is more than the budget.
void require_memory(std::string_view what, double bytes);

}  // namespace detp::sim
