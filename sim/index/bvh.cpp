#include <array>
#include <cmath>
#include <exception>
#include <numeric>
#include <optional>
#include <type_traits>

#include "detp/sim/base/embree.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/ray_search.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "vector_tests.hpp"

namespace detp::sim {
namespace {

/// Several times the rounding error of single precision, in units of EmbreeFrame: sim/geometry/proofs.md, "The culls".
constexpr double margin = 0x1p-18;
/// More than the radius of S₀ plus the slack, in units of EmbreeFrame.
constexpr double half_length = 1.5;

/// Peak memory of Embree's build for each disc, counted in used pages; 60 to 84 bytes were measured for 2·10⁵ discs.
constexpr double bytes_per_disc = 95;

/// Coordinates in which S₀, the sphere around all discs, has its centre at the origin and, grown by the slack, a radius
/// of 0.5 … 1. Embree uses them in single precision. The unit is a power of two, so that scaling is exact.
class EmbreeFrame {
 public:
  explicit EmbreeFrame(const Problem& problem)
      : centre_(problem.enclosing().centre),
        unit_(std::exp2(std::ilogb(problem.enclosing().radius + problem.slack()) + 1)),
        growth_(problem.slack() / unit_ + margin) {}

  /// A box that contains the disc and every point within the slack of it, with a margin for the errors of single
  /// precision.
  [[nodiscard]] Box box(const Disc& disc) const {
    return bounds({(disc.centre - centre_) / unit_, disc.normal, disc.radius / unit_}, growth_);
  }

  /// The part of the ray near S₀, made slightly longer so that rounding cuts off no end; nullopt if there is none. The
  /// part starts near S₀ even if the ray starts far away, and its start is computed in double precision.
  [[nodiscard]] std::optional<RTCRay> clipped_ray(const Ray& ray) const {
    const glm::dvec3 origin = (ray.origin - centre_) / unit_;
    const double abreast = -glm::dot(origin, ray.direction);
    const glm::dvec3 nearest = origin + abreast * ray.direction;
    if (!(glm::dot(nearest, nearest) <= 1)) return std::nullopt;
    double from = -half_length;
    double to = half_length;
    if (!ray.is_line()) {
      from = std::max(from, -abreast);
      to = std::min(to, ray.length / unit_ - abreast);
    }
    if (from > to) return std::nullopt;
    const glm::vec3 start(nearest + (from - margin) * ray.direction);
    const glm::vec3 heading(ray.direction);
    const auto length = static_cast<float>(to - from + 2 * margin);
    return RTCRay{start.x, start.y, start.z, 0, heading.x, heading.y, heading.z, 0, length, 0xFFFFFFFFU, 0, 0};
  }

 private:
  glm::dvec3 centre_;
  double unit_;
  double growth_;
};

/// Receives the discs whose box the traced ray meets.
class DiscTest {
 public:
  /// Returns false to end the traversal.
  virtual bool test(std::uint32_t disc) noexcept = 0;

 protected:
  ~DiscTest() = default;
};

/// Data that Embree passes to our callback with each disc. Embree's own context must come first.
struct Query {
  embree::Context context;
  DiscTest* discs;
};
static_assert(std::is_standard_layout_v<Query>);

/// Embree's tree over the boxes of the discs.
class Bvh {
 public:
  Bvh(const Problem& problem, BuildQuality quality, int threads, const std::stop_token& stop)
      : discs_(problem.discs()), frame_(problem) {
    require_memory("the BVH", bytes_per_disc * static_cast<double>(problem.discs().size()));
    embree::require_no_error(device_.get());
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    const auto effort = quality == BuildQuality::low ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    rtcSetSceneBuildQuality(scene_.get(), effort);
    const embree::Owned<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryBuildQuality(geometry.get(), effort);
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(problem.discs().size()));
    rtcSetGeometryUserData(geometry.get(), this);
    rtcSetGeometryBoundsFunction(geometry.get(), report_bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry.get(), show_disc);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene_.get(), geometry.get());
    // (A device created with "threads=1" would limit the whole process to one thread.)
    on_threads(thread_count(threads), [&] { embree::commit(device_.get(), scene_.get(), stop, "building the BVH"); });
  }

  /// Passes every disc whose box the ray meets to the query.
  void trace(const Ray& ray, Query& query) const {
    if (std::optional<RTCRay> clipped_ray = frame_.clipped_ray(ray))
      embree::occluded1(scene_.get(), query.context, *clipped_ray);
  }

 private:
  static void report_bounds(const RTCBoundsFunctionArguments* arguments) {
    const Bvh& bvh = *static_cast<const Bvh*>(arguments->geometryUserPtr);
    const Box box = bvh.frame_.box(bvh.discs_[arguments->primID]);
    const glm::vec3 low(box.low);
    const glm::vec3 high(box.high);
    *arguments->bounds_o = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
  }

  /// Ends the traversal if DiscTest::test returns false; otherwise reports no hit, so that Embree continues.
  static void show_disc(const RTCOccludedFunctionNArguments* arguments) {
    if (arguments->valid[0] != 0 && !reinterpret_cast<Query*>(arguments->context)->discs->test(arguments->primID))
      RTCRayN_tfar(arguments->ray, arguments->N, 0) = -INFINITY;
  }

  std::span<const Disc> discs_;
  EmbreeFrame frame_;
  embree::Owned<RTCDevice> device_{rtcNewDevice(nullptr)};
  embree::Owned<RTCScene> scene_;
};

/// Discs that Embree reported for a ray, to be tested together.
class ReportedDiscs {
 public:
  void add(std::uint32_t disc, const stream::FloatDisc& floats) {
    numbers_[count_] = disc;
    floats_[count_++] = floats;
  }
  [[nodiscard]] bool full() const { return count_ == numbers_.size(); }
  void clear() { count_ = 0; }
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return {numbers_.data(), count_}; }
  [[nodiscard]] const stream::FloatDisc* floats() const { return floats_.data(); }

 private:
  std::size_t count_ = 0;
  std::array<std::uint32_t, 16> numbers_ = {};
  std::array<stream::FloatDisc, 16 + CellDiscs::padding> floats_ = {};
};

/// The search of the simd engine: tests several reported discs at once.
template <bool counting>
class VectorBvhSearch final : public RaySearch, private DiscTest {
 public:
  VectorBvhSearch(const Bvh& bvh, const CellDiscs& discs, const Problem& problem, const RunOptions& options)
      : bvh_(bvh), discs_(discs.discs()), problem_(problem), tests_(problem, discs.frame(), options) {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    Query query{.context = {}, .discs = this};
    embree::init(query.context);
    tests_.load(first, last, hits);
    for (std::uint32_t ray = first; ray < last; ++ray) {
      tests_.begin(ray);
      bvh_.trace(problem_.rays()[ray], query);
      if (failure_) std::rethrow_exception(failure_);
      test_reported();
    }
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tests_.counts(); }

 private:
  void test_reported() {
    tests_.test(reported_.numbers(), reported_.floats());
    reported_.clear();
  }

  bool test(std::uint32_t disc) noexcept override {
    reported_.add(disc, discs_[disc]);
    if (!reported_.full()) return true;
    try {  // no exception must pass through Embree
      test_reported();
    } catch (...) {
      failure_ = std::current_exception();
    }
    return failure_ == nullptr;
  }

  const Bvh& bvh_;
  const stream::FloatDisc* discs_;
  const Problem& problem_;
  VectorTests<counting> tests_;
  ReportedDiscs reported_;
  std::exception_ptr failure_;
};

template <bool counting>
class BvhSearch final : public RaySearch, private DiscTest {
 public:
  BvhSearch(const Bvh& bvh, const Problem& problem, const std::stop_token& stop)
      : bvh_(bvh), problem_(problem), check_(stop, "searching") {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    Query query{.context = {}, .discs = this};
    embree::init(query.context);
    hits_ = &hits;
    for (ray_ = first; ray_ < last; ++ray_) {
      bvh_.trace(problem_.rays()[ray_], query);
      if (failure_) std::rethrow_exception(failure_);
      check_.after(1);
    }
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tally_.counts(); }

 private:
  bool test(std::uint32_t disc) noexcept override {
    tally_.add(&Counts<std::uint64_t>::disc_tests);
    try {  // no exception must pass through Embree
      check_.after(1);
      if (counts_as_hit(problem_, problem_.rays()[ray_], problem_.discs()[disc])) hits_->push_back({ray_, disc});
    } catch (...) {
      failure_ = std::current_exception();
    }
    return failure_ == nullptr;
  }

  const Bvh& bvh_;
  const Problem& problem_;
  StopCheck check_;
  Tally<counting> tally_;
  std::uint32_t ray_ = 0;
  FoundPairs* hits_ = nullptr;
  std::exception_ptr failure_;
};

/// Embree's bounding volume hierarchy over the discs. Embree reports each disc whose box a ray meets (and other discs
/// of the same leaf if there are few discs). Each reported disc is tested in double precision. No hit is missed:
/// sim/geometry/proofs.md, "The culls". Embree does not report the nodes it visits. Embree advises flushing tiny
/// numbers to zero; this is not done, because the decision in double precision needs them.
///
/// The boxes are a user geometry, whose callback makes the decision. The other rows of the table are Embree's own point
/// geometries, with enlarged radius and the same decision in a filter. Columns: build + search, in ms of processor
/// time; tests per hit (one thread, minimum of 11 runs):
///
///                                @uniform, 100 000 discs, 50 000 lines    @tree, 85 967 discs, 100 000 paths
///     boxes, low quality         11 + 103; 2.3                            9 + 93; 3.0
///     boxes, medium quality      44 + 97;  2.3                            34 + 87; 3.0
///     oriented discs             33 + 89;  1.0                            29 + 94; 2.0     loses grazing rays
///     discs facing the ray       32 + 124; 2.0                            28 + 108; 3.4
///     spheres                    33 + 140; 4.0                            28 + 129; 6.4    reports each disc twice
///
/// Embree's point geometries get the same tree at low quality as at medium. For boxes, low quality is the default: with
/// 10³ … 3·10⁵ rays on four scenes it took 0.3 to 1.1 times as long as medium quality.
class BvhIndex final : public Index {
 public:
  BvhIndex(const Problem& problem, BuildQuality quality, const RunOptions& options)
      : bvh_(problem, quality, options.threads, options.stop) {
    built_.bytes = bytes_per_disc * static_cast<double>(problem.discs().size());
    if (options.engine == Engine::simd && stream::can_search(problem)) {
      std::vector<std::uint32_t> numbers(problem.discs().size());
      std::iota(numbers.begin(), numbers.end(), 0U);
      built_.bytes += CellDiscs::bytes(numbers.size());
      require_memory("the BVH", built_.bytes);
      discs_.emplace(problem, numbers, options.stop);
    }
    built_.seconds.build = watch_.lap();
    built_.counts.placements = built_.counts.references = problem.discs().size();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes("the BVH", built_.bytes + found_bytes(problem, options), problem, outcome);
    options.count ? search_all<true>(problem, options, outcome) : search_all<false>(problem, options, outcome);
  }

 private:
  template <bool counting>
  void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome) const {
    std::pmr::memory_resource& memory = *options.memory;
    if (discs_)
      return search_rays(
          problem, options,
          [&] { return make_in<RaySearch, VectorBvhSearch<counting>>(memory, bvh_, *discs_, problem, options); },
          outcome);
    search_rays(
        problem, options, [&] { return make_in<RaySearch, BvhSearch<counting>>(memory, bvh_, problem, options.stop); },
        outcome);
  }

  Stopwatch watch_;
  Bvh bvh_;
  std::optional<CellDiscs> discs_;  ///< of the simd engine
};

}  // namespace

/// Throws std::runtime_error if Embree fails.
std::unique_ptr<Index> prepare_bvh(const Problem& problem, const Parameters& parameters, const RunOptions& options) {
  return std::make_unique<BvhIndex>(problem, std::get<BvhParameters>(parameters).quality, options);
}

}  // namespace detp::sim
