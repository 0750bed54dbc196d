#include "hit_batches.hpp"

#include <algorithm>
#include <cmath>

namespace detp::sim {

void HitBatches::add(std::uint64_t batch_rays, std::uint64_t batch_hits) {
  const auto h = static_cast<double>(batch_hits);
  ++count;
  rays += batch_rays;
  hits += batch_hits;
  squares += h * h / static_cast<double>(batch_rays);
}

HitBatches& HitBatches::operator+=(const HitBatches& other) {
  count += other.count;
  rays += other.rays;
  hits += other.hits;
  squares += other.squares;
  return *this;
}

HitEstimate estimate_hits(const HitBatches& batches, std::uint64_t all_rays) {
  const auto n = static_cast<double>(batches.rays);
  const auto all = static_cast<double>(all_rays);
  const auto hits = static_cast<double>(batches.hits);
  HitEstimate estimate{hits * all / n, std::nullopt};
  if (batches.count < 2) return estimate;
  const double variance = std::max(0.0, batches.squares - hits * hits / n) / static_cast<double>(batches.count - 1);
  estimate.standard_error = std::sqrt(all * std::max(0.0, all - n) / n * variance);
  return estimate;
}

}  // namespace detp::sim
