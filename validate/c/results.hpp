#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "detp/sim/search/outcome.hpp"

namespace detp::c {

template <class T>
void copy(const std::vector<T>& values, T* to, std::size_t count) {
  if (to == nullptr) return;
  if (values.size() == count)
    std::copy(values.begin(), values.end(), to);
  else
    std::fill(to, to + count, std::numeric_limits<T>::quiet_NaN());  // of a stopped search, errors are not known
}

/// Into the caller's arrays, those that are not null.
template <class Found>
void copy_results(const sim::Outcome& outcome, std::size_t discs, Found& found) {
  copy(outcome.hits, found.hits, discs);
  copy(outcome.irradiance, found.irradiance, discs);
  copy(outcome.standard_error, found.standard_error, discs);
  copy(outcome.upper_bound, found.upper_bound, discs);
}

}  // namespace detp::c
