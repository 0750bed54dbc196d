#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "detp.h"
#include "detp/model/vocabulary/counts.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/views.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/choice/plan.hpp"

/// The types of the C interface: what its handles are; the caller's arrays as views of detp::sim; what is copied to the caller.

struct detp_costs {
  detp::CostTable table;
};

struct detp_plan {
  detp::validate::Plan plan;
  std::size_t discs;
  std::vector<double> weights;  ///< of the discs by area, with sum 1
  std::string technique;
  std::string parameters;
};

struct detp_scratch {
  detp::sim::SearchScratch memory;
  std::size_t discs = 0;
  bool has_pairs = false;  ///< of the last search
};

namespace detp::c {

/// Throws std::invalid_argument for null arrays, unknown types and a bad size of the struct.
[[nodiscard]] sim::RaysView view_of(const detp_rays* rays);
[[nodiscard]] sim::DiscsView view_of(const detp_discs* discs);

[[nodiscard]] inline detp_counts counts_of(const Counts<double>& counts) {
  return {.loaded = counts.loaded,
          .segments = counts.segments,
          .cull_tests = counts.cull_tests,
          .culls = counts.culls,
          .listed = counts.listed,
          .visits = counts.visits,
          .disc_tests = counts.disc_tests,
          .doubtful = counts.doubtful,
          .steps = counts.steps,
          .nodes = counts.nodes,
          .references = counts.references,
          .placements = counts.placements,
          .made = counts.made,
          .sorted = counts.sorted,
          .hits = counts.hits,
          .bytes_touched = counts.bytes_touched};
}

template <class T>
void copy(const std::vector<T>& values, T* to, std::size_t count, std::size_t first = 0, std::size_t stride = 1) {
  if (to == nullptr) return;
  for (std::size_t i = 0; i < count; ++i)  // of a stopped search, errors are not known
    to[first + i * stride] = values.size() == count ? values[i] : std::numeric_limits<T>::quiet_NaN();
}

/// Throws std::invalid_argument unless the rays have so many bands, as `what` says.
inline void require_bands(const char* what, std::size_t bands, const sim::RaysView& rays) {
  if (std::max<std::size_t>(1, bands) != 1 + rays.further_powers.size())
    throw std::invalid_argument(std::string(what) + " is " + std::to_string(bands) + ", but the rays have " +
                                std::to_string(1 + rays.further_powers.size()));
}

/// Into the caller's arrays, those that are not null.
template <class Found>
void copy_results(const sim::Outcome& outcome, std::size_t discs, Found& found) {
  copy(outcome.hits, found.hits, discs);
  for (std::size_t band = 0; band < outcome.bands(); ++band) {
    copy(outcome.band(band).irradiance, found.irradiance, discs, band, outcome.bands());
    copy(outcome.band(band).standard_error, found.standard_error, discs, band, outcome.bands());
    copy(outcome.band(band).upper_bound, found.upper_bound, discs, band, outcome.bands());
  }
}

}  // namespace detp::c
