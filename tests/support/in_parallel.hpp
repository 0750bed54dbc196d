#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

namespace detp::support {

/// The vector of one(0) … one(count - 1), computed on all cores.
template <class One>
auto in_parallel(std::size_t count, const One& one) {
  std::vector<decltype(one(count))> results(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { results[i] = one(i); });
  return results;
}

}  // namespace detp::support
