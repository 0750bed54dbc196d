#include "sweep.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/validate/base/digest.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/checkpoint/value_json.hpp"

namespace detp::validate {
namespace {

constexpr double cube_side = 2;
constexpr std::array disc_shares{1e-4, 1e-3, 1e-2, 0.05, 0.2};
constexpr std::array ratios{0.3, 0.5, 0.65, 0.8, 0.9};

/// The numbers of sets and lines for a number of samples. There are more sets if they have few samples, because such
/// sets differ more from each other.
struct Amount {
  double samples;
  int sets;
  std::size_t lines;
};

constexpr std::array amounts{Amount{1e7, 2, 1500}, Amount{1e6, 4, 2000}, Amount{1e5, 16, 500}, Amount{1e4, 64, 300},
                             Amount{1e3, 256, 250}};

/// Candidates with more predicted tests, nodes and steps on one set than this are left out. They take too long to
/// count, and are far too slow to be chosen.
constexpr double most_tests = 1e9;

std::vector<Candidate> caches(const SweepPoint& point) {
  std::vector<Candidate> candidates;
  const Workload workload = point.workload();
  for (const double ratio : ratios) {
    const std::int64_t k =
        model::sphere_count(Form::corrected, {ratio}, {workload.disc_radius}, {workload.sphere_radius});
    candidates.push_back({Technique::sphere_cache, SphereCacheParameters{ratio, std::max<std::int64_t>(k, 1)}});
  }
  return candidates;
}

std::vector<Candidate> indices(const SweepPoint& point) {
  std::vector<Candidate> candidates;
  const Workload workload = point.workload();
  const int published = model::published::octree_depth({workload.disc_radius}, scene_side(workload));
  const int depth = std::clamp(published, 1, 7);
  for (const int levels : {depth, depth - 2}) {
    if (levels < 1) break;
    candidates.push_back({Technique::octree, OctreeParameters{levels}});
    candidates.push_back({Technique::grid, GridParameters{1 << levels}});
  }
  return candidates;
}

/// Cell spheres of two depths, and two sphere trees. The larger depth is ⌊log₂(n_P)/D⌋ - 1, but at least 1 and at most
/// 6. The other depth is smaller by 2, but at least 1.
std::vector<Candidate> hierarchies(const SweepPoint& point) {
  const int levels = std::clamp(static_cast<int>(std::log2(point.samples) / point.dimension) - 1, 1, 6);
  return {{Technique::cell_spheres, CellSpheresParameters{levels}},
          {Technique::cell_spheres, CellSpheresParameters{std::max(1, levels - 2)}},
          {Technique::sphere_tree, SphereTreeParameters{4, 4}},
          {Technique::sphere_tree, SphereTreeParameters{8, 16}}};
}

/// A box tree for each leaf size, with one of the fan-outs. The fan-out of a leaf size changes from point to point, so
/// that the points together cover all pairs of fan-out and leaf size.
std::vector<Candidate> sweep_box_trees(const SweepPoint& point) {
  constexpr std::array fan_outs{2, 4, 8, 16};
  constexpr std::array leaves{1, 4, 16, 64, 256};
  const double place = std::log10(point.samples) - 2 * std::log10(point.disc_share) + point.dimension;
  std::vector<Candidate> candidates;
  auto turn = static_cast<std::size_t>(std::lround(place));
  for (const int leaf : leaves)
    candidates.push_back({Technique::box_tree, BoxTreeParameters{fan_outs[turn++ % fan_outs.size()], leaf}});
  return candidates;
}

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

double SweepPoint::disc_radius() const { return disc_share / (1 - disc_share) * std::sqrt(3.0) / 2 * cube_side; }

Workload SweepPoint::workload() const {
  return cube_workload(static_cast<double>(lines), samples, disc_radius(), cube_side, dimension);
}

std::vector<sim::Disc> SweepPoint::discs(std::uint64_t seed, int set, const std::stop_token& stop) const {
  const auto body = dimension == 2 ? sim::Body::cube_faces : sim::Body::cube;
  return sim::uniform_discs(body, cube_side, static_cast<std::size_t>(samples), disc_radius(),
                            seed * 1000003 + static_cast<std::uint64_t>(set), stop);
}

std::string SweepPoint::name() const { return fmt::format("D={} n={:g} d/r0={:g}", dimension, samples, disc_share); }

std::vector<SweepPoint> sweep_points() {
  std::vector<SweepPoint> points;
  for (const Amount& amount : amounts)
    for (const int dimension : {3, 2})
      for (const double share : disc_shares)
        points.push_back({dimension, amount.samples, share, amount.sets, amount.lines});
  return points;
}

std::vector<Candidate> sweep_candidates(const SweepPoint& point) {
  std::vector<Candidate> candidates = caches(point);
  for (const auto& others : {indices(point), hierarchies(point), sweep_box_trees(point)})
    candidates.insert(candidates.end(), others.begin(), others.end());
  std::erase_if(candidates, [&](const Candidate& candidate) {
    const Counts<double> counts = model::predict(point.workload(), candidate, Engine::plain);
    return tests(counts) + counts.nodes + counts.steps > most_tests;
  });
  return candidates;
}

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
