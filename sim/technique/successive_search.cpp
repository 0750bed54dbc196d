#include "successive_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/search/soundness.hpp"

namespace detp::sim {

SuccessiveSearch::SuccessiveSearch(const Index& index, Problem problem, const RunOptions& options, std::uint64_t first,
                                   std::uint64_t last, double kept_bytes, Outcome& sum)
    : index_(index),
      problem_(std::move(problem)),
      options_(options),
      run_(options),
      own_(0, options.memory),
      first_(first),
      last_(last),
      next_(first),
      kept_bytes_(kept_bytes),
      sum_(sum) {
  check_options(options, problem_);
  if (options.pairs && last >= UINT32_MAX)
    throw std::length_error(fmt::format("{} rays are too many for pairs; the maximum is {}", last, UINT32_MAX - 1));
  if (options.totals == nullptr) {
    if (options.standard_error) own_.keep_errors();
    own_.resize(problem_.discs().size());
    run_.totals = &own_;
  }
  run_.standard_error = false;  // of a piece
  if (options.progress)
    run_.progress = [this](double share) {
      const double done = static_cast<double>(next_ - first_) + share * static_cast<double>(problem_.rays().size());
      options_.progress(done / static_cast<double>(last_ - first_));
    };
  sum_.progress.of = last - first;
  sum_.bytes = kept_bytes;
}

void SuccessiveSearch::add(const PathRays& rays) {
  Stopwatch watch;
  if (!rays.photons.empty())
    require_rising(next_, rays.photons.front(), std::exchange(last_photon_, rays.photons.back()));
  set_rays(problem_, rays, options_.threads, next_);
  sum_.seconds.prepare += watch.lap();
  sim::search(index_, problem_, run_, part_);
  add_pairs();
  add_block(part_, sum_);
  sum_.progress.done += part_.stopped ? part_.progress.done : rays.rays.size();
  next_ += rays.rays.size();
}

void SuccessiveSearch::add_pairs() {
  const std::size_t pairs = sum_.pairs.size() + part_.pairs.size();
  const double bytes = kept_bytes_ + part_.bytes + grown_bytes(pairs, sizeof(Pair));
  sum_.bytes = std::max(sum_.bytes, bytes);
  if (pairs == 0) return;
  require_memory("the pairs", bytes);
  sum_.pairs.reserve(std::max(sum_.pairs.capacity(), std::bit_ceil(pairs)));
  const auto first = static_cast<std::uint32_t>(next_);
  for (const Pair& pair : part_.pairs) sum_.pairs.push_back({pair.ray + first, pair.disc});
}

void SuccessiveSearch::finish(std::uint64_t photons) {
  if (sum_.stopped) sum_.pairs.clear();
  run_.totals->emitted(photons);
  if (options_.totals == nullptr) sim::finish(own_, problem_.discs(), sum_);
  if (sum_.stopped) sum_.standard_error.clear();
  if (sum_.stopped) sum_.upper_bound.clear();
}

}  // namespace detp::sim
