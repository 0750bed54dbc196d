#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/closest_point.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/triangle_in_sphere.hpp"
#include "detp/sim/near/landing_tree.hpp"
#include "detp/sim/near/near_sums.hpp"
#include "detp/sim/scene/near_triangles.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "surface.hpp"

namespace detp::sim {
namespace {

constexpr double least_cosine = 0.5;  ///< between the normals of a disc and of a triangle that faces as the disc does

/// Collects the landings of a disc for nanoflann.
template <class Counts>
class LandingsWithin {
 public:
  using DistanceType = double;

  LandingsWithin(double radius, const Counts& counts, const LandingCloud& cloud, Near& near)
      : square_(radius * radius), counts_(counts), cloud_(cloud), near_(near) {}

  bool addPoint(double square, std::uint32_t landing) {
    const std::uint32_t ray = cloud_.landings[landing].ray;
    if (square <= square_ && counts_(ray)) near_.landed.push_back({ray, 1});
    return true;
  }
  [[nodiscard]] double worstDist() const { return square_; }
  [[nodiscard]] bool full() const { return true; }

 private:
  double square_;
  const Counts& counts_;
  const LandingCloud& cloud_;
  Near& near_;
};

/// Areas around some discs: below 0 if the nearest triangle is turned round.
struct Areas {
  std::uint64_t digest = 0;  ///< of the discs
  std::vector<double> of_disc;
};

std::uint64_t digest_of(std::span<const Disc> discs) {
  std::uint64_t digest = discs.size();
  const auto add = [&](double value) {
    digest = (digest ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15ULL;
    digest ^= digest >> 29;
  };
  for (const Disc& disc : discs) {
    for (int axis = 0; axis < 3; ++axis) add(disc.centre[axis]);
    for (int axis = 0; axis < 3; ++axis) add(disc.normal[axis]);
    add(disc.radius);
  }
  return digest;
}

class AreaCorrected {
 public:
  /// `known`: areas of the same discs, or none; then `measured` gets them.
  AreaCorrected(const Problem& problem, const NearTriangles& triangles, const Areas* known, Areas& measured,
                const std::stop_token& stop)
      : problem_(problem),
        triangles_(triangles),
        known_(known),
        measured_(measured),
        check_(stop, "sorting photons"),
        cloud_{landings_of(problem, check_), &check_} {
    cloud_.building = nullptr;
  }

  [[nodiscard]] std::size_t landings() const { return cloud_.landings.size(); }

  void find(std::uint32_t number, Near& near) const {
    const Disc& disc = problem_.discs()[number];
    const double signed_area = known_ != nullptr ? known_->of_disc[number] : measure(disc);
    if (known_ == nullptr) measured_.of_disc[number] = signed_area;
    near.area = std::abs(signed_area);
    const double side = signed_area < 0 ? -1 : 1;
    if (!(near.area > 0)) return;
    const auto counts = [&](std::uint32_t ray) {
      const std::uint32_t triangle = problem_.triangles()[ray];
      if (!triangles_.is_met(triangle) || !faces(triangle, disc, side)) return false;
      return !problem_.front_facing() || arrives_in_front(problem_.rays()[ray], disc);
    };
    LandingsWithin within(disc.radius, counts, cloud_, near);
    const double point[3]{disc.centre.x, disc.centre.y, disc.centre.z};
    tree_.findNeighbors(within, point, nanoflann::SearchParams());
  }

 private:
  [[nodiscard]] bool faces(std::uint32_t triangle, const Disc& disc, double side) const {
    return side * glm::dot(triangles_.facet(triangle).normal, disc.normal) >= least_cosine;
  }

  /// The area, below 0 if the nearest triangle is turned round.
  [[nodiscard]] double measure(const Disc& disc) const {
    double areas[2]{};  // of triangles that face as the disc does, and the other way
    double least = unbounded;
    std::uint32_t nearest = no_triangle;
    bool turned = false;
    triangles_.visit(disc.centre, disc.radius, [&](std::uint32_t triangle) {
      const bool facing = faces(triangle, disc, 1);
      if (!facing && !faces(triangle, disc, -1)) return;
      const Facet& facet = triangles_.facet(triangle);
      const glm::dvec3 a = facet.corner - disc.centre;
      const glm::dvec3 b = a + facet.first;
      const glm::dvec3 c = a + facet.second;
      areas[facing ? 0 : 1] += area_in_sphere(a, b, c, disc.radius);
      const double longest =
          std::sqrt(std::max(glm::dot(facet.first, facet.first), glm::dot(facet.second, facet.second)));
      if (glm::length(a) - longest > (1 + 1e-12) * least) return;  // every point of it is farther away
      const double distance = distance_to_triangle(a, b, c);
      if (distance < least || (distance == least && triangle < nearest)) {
        least = distance;
        nearest = triangle;
        turned = !facing;
      }
    });
    return turned ? -areas[1] : areas[0];
  }

  const Problem& problem_;
  const NearTriangles& triangles_;
  const Areas* known_;
  Areas& measured_;
  StopCheck check_;
  LandingCloud cloud_;
  LandingKdTree tree_{3, cloud_};
};

class AreaCorrectedIndex final : public Index {
 public:
  AreaCorrectedIndex(const Mesh& mesh, const std::stop_token& stop, std::shared_ptr<const NearTriangles> triangles)
      : triangles_(triangles != nullptr ? std::move(triangles) : std::make_shared<const NearTriangles>(mesh, stop)) {
    built_.seconds.build = triangles_->seconds();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const std::size_t discs = problem.discs().size();
    add_checked_bytes(
        "photons near discs",
        landing_tree_bytes(problem) + near_bytes(problem, options) + static_cast<double>(discs * sizeof(double)),
        problem, outcome);
    Stopwatch watch;
    const std::uint64_t digest = digest_of(problem.discs());
    const std::shared_ptr<const Areas> last = last_areas();
    const bool known = last != nullptr && last->digest == digest;
    const auto measured = std::make_shared<Areas>();
    measured->digest = digest;
    if (!known) measured->of_disc.resize(discs);
    const AreaCorrected estimates(problem, *triangles_, known ? last.get() : nullptr, *measured, options.stop);
    outcome.seconds.build = watch.lap();
    sum_near(
        problem, options, [&](std::uint32_t disc, Near& near) { estimates.find(disc, near); }, outcome);
    if (options.count) outcome.counts.references = estimates.landings();
    if (known || outcome.stopped) return;
    const std::lock_guard lock(mutex_);
    last_ = measured;
  }

 private:
  [[nodiscard]] std::shared_ptr<const Areas> last_areas() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }

  std::shared_ptr<const NearTriangles> triangles_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Areas> last_;  ///< of the last search: batches of rays have the same discs
};

}  // namespace

std::unique_ptr<Index> prepare_area_corrected(const Mesh& mesh, const std::stop_token& stop,
                                              std::shared_ptr<const NearTriangles> triangles) {
  return std::make_unique<AreaCorrectedIndex>(mesh, stop, std::move(triangles));
}

}  // namespace detp::sim
