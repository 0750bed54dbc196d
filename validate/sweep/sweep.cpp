#include "sweep.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <map>
#include <mutex>
#include <utility>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/validate/base/digest.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/checkpoint/value_json.hpp"

namespace detp::validate {
namespace {

/// Of the points, of their numbers of sets and lines, and of the value of every formula on them.
std::string digest_of_points(std::span<const SweepPoint> points) {
  Digest digest;
  for (const SweepPoint& point : points) {
    for (const double part :
         {double(point.dimension), point.samples, point.disc_share, double(point.sets), double(point.lines)})
      digest.add(part);
    for (const Candidate& candidate : sweep_candidates(point))
      for_each_term(model::predict(point.workload(), candidate, Engine::plain),
                    [&](std::string_view, double value) { digest.add(value); });
  }
  return digest.text();
}

/// In units of sim::StopCheck.
double predicted_work(const SweepPoint& point) {
  double work = 0;
  for (const Candidate& candidate : sweep_candidates(point))
    work += search_work(model::predict(point.workload(), candidate, Engine::plain), Engine::plain);
  return work * point.sets;
}

std::optional<CheckpointFile> checkpoint_of(std::span<const SweepPoint> points, const SweepOptions& options) {
  if (!options.checkpoint) return std::nullopt;
  return CheckpointFile(*options.checkpoint, "validate --effort thorough",
                        {{"seed", options.seed}, {"digest of formulas and workloads", digest_of_points(points)}});
}

class MeasurementCollector {
 public:
  MeasurementCollector(std::span<const SweepPoint> points, const SweepOptions& options)
      : points_(points), options_(options), checkpoint_(checkpoint_of(points, options)) {
    if (checkpoint_ && options.resume) measured_ = read_points(*checkpoint_);
    resumed_ = measured_.size();
    if (!options.progress) return;
    double work = 0;
    for (const SweepPoint& point : points)
      if (!measured_.contains(point.name())) work += predicted_work(point);
    options.progress({fmt::format("{} workloads", points.size() - resumed_), 0, 1, work});
  }

  /// The next point to measure, in their order; null if none is left or a stop was requested.
  [[nodiscard]] const SweepPoint* next_point() {
    const std::scoped_lock lock(mutex_);
    while (next_ < points_.size() && measured_.contains(points_[next_].name())) ++next_;
    return next_ < points_.size() && !options_.stop.stop_requested() ? &points_[next_++] : nullptr;
  }

  void add(const SweepPoint& point, std::vector<Deviation> deviations) {
    const std::scoped_lock lock(mutex_);
    measured_[point.name()] = std::move(deviations);
    if (checkpoint_) write_points(*checkpoint_, measured_);
  }

  [[nodiscard]] SweepResult finish() && {
    SweepResult result{.deviations = {}, .points = points_.size(), .measured = measured_.size(), .resumed = resumed_};
    for (const SweepPoint& point : points_)
      for (Deviation& deviation : measured_[point.name()]) result.deviations.push_back(std::move(deviation));
    return result;
  }

 private:
  std::span<const SweepPoint> points_;
  const SweepOptions& options_;
  std::optional<CheckpointFile> checkpoint_;
  std::mutex mutex_;
  MeasuredPoints measured_;
  std::size_t next_ = 0;
  std::size_t resumed_ = 0;
};

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Deviation, dimension, samples, disc_share, technique, parameters, quantity, sphere,
                                   form, predicted, observed)

MeasuredPoints read_points(const CheckpointFile& file, std::stop_token stop) {
  const auto state = file.read(std::move(stop));
  try {
    return state ? state->get<MeasuredPoints>() : MeasuredPoints{};
  } catch (const nlohmann::json::exception& error) {
    throw file.damaged(error.what());
  }
}

void write_points(CheckpointFile& file, const MeasuredPoints& points) { file.write(points); }

void check_checkpoint(std::span<const SweepPoint> points, const SweepOptions& options) {
  if (const auto file = checkpoint_of(points, options); file && options.resume)
    static_cast<void>(read_points(*file, options.stop));
}

SweepResult run_sweep(std::span<const SweepPoint> points, const SweepOptions& options) {
  MeasurementCollector collector(points, options);
  sim::parallel_for(0, tbb::this_task_arena::max_concurrency(), [&](int) {
    while (const SweepPoint* point = collector.next_point()) {
      auto deviations = measure_point(*point, options.seed, options.stop);
      if (!deviations.empty()) collector.add(*point, std::move(deviations));
    }
  });
  return std::move(collector).finish();
}

}  // namespace detp::validate
