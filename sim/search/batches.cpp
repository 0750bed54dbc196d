#include "batches.hpp"

#include <algorithm>
#include <cmath>

namespace detp::sim {

void Batches::add(std::uint64_t batch_rays, double of_batch) {
  ++count;
  rays += batch_rays;
  sum += of_batch;
  squares += of_batch * of_batch / static_cast<double>(batch_rays);
}

Batches& Batches::operator+=(const Batches& other) {
  count += other.count;
  rays += other.rays;
  sum += other.sum;
  squares += other.squares;
  return *this;
}

SumEstimate estimate_sum(const Batches& batches, std::uint64_t all_rays) {
  const auto n = static_cast<double>(batches.rays);
  const auto all = static_cast<double>(all_rays);
  SumEstimate estimate{batches.sum * all / n, std::nullopt};
  if (batches.count < 2) return estimate;
  const double variance =
      std::max(0.0, batches.squares - batches.sum * batches.sum / n) / static_cast<double>(batches.count - 1);
  estimate.standard_error = std::sqrt(all * std::max(0.0, all - n) / n * variance);
  return estimate;
}

}  // namespace detp::sim
