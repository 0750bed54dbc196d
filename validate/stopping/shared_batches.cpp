#include "shared_batches.hpp"

#include <utility>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/json_bytes.hpp"
#include "until_json.hpp"

namespace detp::validate {
namespace {

/// A place, and the number of rays.
struct BatchTask {
  std::uint64_t batch = 0;
  std::uint64_t made = 0;
  std::uint64_t rays = 0;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchTask, batch, made, rays)

}  // namespace

SharedBatches::SharedBatches(const Job& job, JobSearch& search, std::stop_token stop, sim::Ranks* ranks)
    : search_(search), rays_(job, std::move(stop)), work_([this](const std::string& task) { return find(task); }) {
  if (ranks == nullptr) return;
  at_once_ = static_cast<std::size_t>(ranks->count());
  farm_.emplace(*ranks, work_);
}

std::optional<FoundBatch> SharedBatches::next(std::uint64_t rays, std::uint64_t following) {
  if (ahead_.empty()) {
    const auto place = farm_ ? rays_.next_place() : std::nullopt;
    if (!place) return next_here(rays);
    std::vector<std::string> tasks;
    for (std::uint64_t i = 0; i <= following && tasks.size() < at_once_; ++i)
      tasks.push_back(json_bytes(BatchTask{place->batch + i, place->made + i * rays, rays}));
    for (const std::string& found : farm_->all(tasks)) ahead_.push_back(found_batch_of(found));
  }
  FoundBatch batch = std::move(ahead_.front());
  ahead_.pop_front();
  rays_.count(batch.batch.rays);
  return batch;
}

std::optional<FoundBatch> SharedBatches::next_here(std::uint64_t rays) {
  const sim::Stopwatch watch;
  const std::optional<RayBatch> made = rays_.next(rays);
  const double make_seconds = watch.seconds();
  if (!made) return std::nullopt;
  return found_batch(*made, search_(made->rays), make_seconds);
}

void SharedBatches::roll_call() {
  if (farm_) static_cast<void>(farm_->all(std::vector<std::string>(at_once_)));  // one empty task for each
}

std::string SharedBatches::find(const std::string& task) {
  if (task.empty()) return {};
  const BatchTask one = from_json_bytes<BatchTask>(task);
  const sim::Stopwatch watch;
  const RayBatch made = rays_.at({one.batch, one.made}, one.rays);
  const double make_seconds = watch.seconds();
  return bytes_of(found_batch(made, search_(made.rays), make_seconds));
}

}  // namespace detp::validate
