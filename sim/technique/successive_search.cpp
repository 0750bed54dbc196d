#include "successive_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/parallel.hpp"
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
      beside_rays_bytes_(problem_.kept_bytes()),
      sum_(sum) {
  check_options(options, problem_);
  require_pairs(last);
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

void SuccessiveSearch::require_pairs(std::uint64_t last) const {
  if (options_.pairs && last >= UINT32_MAX)
    throw std::length_error(fmt::format("{} rays are too many for pairs; the maximum is {}", last, UINT32_MAX - 1));
}

void SuccessiveSearch::add(const PathRays& rays) {
  require_pairs(next_ + rays.rays.size());
  Stopwatch watch;
  if (!rays.photons.empty())
    require_rising(next_, rays.photons.front(), std::exchange(last_photon_, rays.photons.back()));
  set_rays(problem_, rays, options_.threads, next_);
  const auto bytes = static_cast<double>(rays.rays.size() * bytes_of_ray_in(problem_.bands()));
  longest_bytes_ = std::max(longest_bytes_, bytes);  // a shorter piece does not make its arrays shorter
  problem_.set_kept_bytes(beside_rays_bytes_ + longest_bytes_ - bytes);
  sum_.seconds.prepare += watch.lap();
  sim::search(index_, problem_, run_, part_);
  add_pairs();
  add_block(part_, sum_);
  const std::uint64_t done = part_.stopped ? part_.progress.done : rays.rays.size();
  done_ += done;
  sum_.progress.done += done;
  next_ += rays.rays.size();
}

void SuccessiveSearch::add_batch() {
  constexpr double least_growth = 0.2;
  const std::uint64_t done = next_ - first_;
  const std::uint64_t rays = done - sum_.irradiance_batches.rays;
  const std::span<const Disc> discs = problem_.discs();
  if (sum_.stopped || options_.totals != nullptr || rays < discs.size() / 4 ||
      static_cast<double>(rays) < least_growth * static_cast<double>(done))
    return;
  constexpr std::size_t at_once = std::size_t{1} << 14;
  irradiance_.resize(own_.bands());
  sum_.further.resize(own_.bands() - 1);
  for (std::size_t band = 0; band < own_.bands(); ++band) {
    const Totals& own = own_.band(band);
    std::vector<double> parts((discs.size() + at_once - 1) / at_once);
    sim::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
      for (std::size_t i = part * at_once; i < std::min(discs.size(), (part + 1) * at_once); ++i)
        parts[part] += own.power(i, own[i]) / (discs[i].radius * discs[i].radius);
    });
    const double irradiance = std::accumulate(parts.begin(), parts.end(), 0.0) / std::numbers::pi;
    sum_.band(band).irradiance_batches.add(rays, irradiance - std::exchange(irradiance_[band], irradiance));
  }
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

void SuccessiveSearch::finish(std::uint64_t photons, double scale) {
  if (sum_.stopped) sum_.pairs.clear();
  sum_.progress.of = std::max(sum_.progress.of, sum_.progress.done);
  run_.totals->emitted(photons, scale);
  if (options_.totals == nullptr) sim::finish(own_, problem_.discs(), sum_);
}

}  // namespace detp::sim
