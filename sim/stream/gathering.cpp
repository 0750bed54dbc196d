#include "gathering.hpp"

#include <algorithm>
#include <utility>

namespace detp::sim::stream {
namespace {

/// Sums of the same power added to 0, once, twice, …
class RepeatedSums {
 public:
  explicit RepeatedSums(double power) : power_(power) {}

  /// The sum after `count` more were added to `sum`, one after another.
  [[nodiscard]] double add(double sum, std::uint32_t count) {
    if (sum == 0) return from_zero(count);
    for (std::uint32_t i = 0; i < count; ++i) sum += power_;
    return sum;
  }

 private:
  double from_zero(std::size_t count) {
    while (sums_.size() <= count) sums_.push_back(sums_.back() + power_);
    return sums_[count];
  }

  double power_;
  std::vector<double> sums_{0};
};

}  // namespace

Gathering::Gathering(const Problem& problem, const DiscTree& tree, const RunOptions& options)
    : problem_(problem), tree_(tree), options_(options), totals_(tree.discs.size()), hits_(tree.discs.size()) {
  if (options.totals == nullptr || options.totals->empty()) return;
  for (std::size_t place = 0; place < totals_.size(); ++place) totals_[place] = (*options.totals)[tree.order[place]];
}

BlockSearch Gathering::begin(const Frame& frame, std::size_t first_ray, const RayTraits& traits) {
  const bool only_count = traits.power && !options_.pairs && !problem_.front_facing;
  const std::optional<double> power = only_count ? traits.power : std::nullopt;
  if (power != counted_power_) add_up();
  counted_power_ = power;
  return {.problem = problem_,
          .frame = frame,
          .tree = tree_,
          .first_ray = static_cast<std::uint32_t>(first_ray),
          .segments = traits.segments,
          .pairs = options_.pairs,
          .hits = hits_.data(),
          .totals = only_count ? nullptr : totals_.data(),
          .stop = options_.stop};
}

void Gathering::add_up() {
  std::optional<RepeatedSums> sums;
  if (counted_power_) sums.emplace(*counted_power_);
  for (std::size_t place = 0; place < totals_.size(); ++place)
    for (int k = 0; k < classes; ++k) {
      const std::uint32_t count = std::exchange(hits_[place][static_cast<std::size_t>(k)], 0);
      totals_[place].hits += count;
      found_ += count;
      if (sums) totals_[place].power[k] = sums->add(totals_[place].power[k], count);
    }
}

void Gathering::give_hits(Outcome& outcome) {
  add_up();
  Totals in_order(totals_.size());
  for (std::size_t place = 0; place < totals_.size(); ++place) in_order[tree_.order[place]] = totals_[place];
  std::sort(outcome.pairs.begin(), outcome.pairs.end());
  outcome.total_hits = found_;
  if (!options_.count) outcome.counts = {};
  outcome.counts.hits = found_;
  outcome.stopped = options_.stop.stop_requested();
  if (options_.totals != nullptr)
    *options_.totals = std::move(in_order);
  else
    finish(in_order, problem_.discs, outcome);
}

}  // namespace detp::sim::stream
