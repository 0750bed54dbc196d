#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/closest_point.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/near/near_sums.hpp"
#include "detp/sim/scene/near_triangles.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "surface.hpp"

namespace detp::sim {
namespace {

/// Lists of numbers, one for each key, in one array.
class Lists {
 public:
  /// Calls each(add) twice, where add(key, value) counts and then stores a value.
  template <class Each>
  Lists(std::size_t keys, const Each& each) : starts_(keys + 1) {
    each([&](std::uint32_t key, std::uint32_t) { ++starts_[key + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    values_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    each([&](std::uint32_t key, std::uint32_t value) { values_[next[key]++] = value; });
  }

  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t key) const {
    return std::span(values_).subspan(starts_[key], starts_[key + 1] - starts_[key]);
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> values_;
};

/// The mesh as the estimator sees it: the triangles around each vertex, their area, and those near a disc.
class Patches {
 public:
  Patches(const Mesh& mesh, const NearTriangles& near)
      : mesh_(mesh), near_(near), around_(mesh.positions.size(), [&](const auto& add) {
          for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
            if (near_.is_met(triangle))
              for (const std::uint32_t corner : mesh.triangles[triangle]) add(corner, triangle);
        }) {
    if (const Box box = used_box(mesh); !box.empty()) scale_ = std::max(glm::length(box.size()), 1e-300);
  }

  struct Share {
    std::uint32_t triangle;
    double weight;  ///< 1/area
  };

  /// The triangles whose photons count for a disc. Empty if the mesh has no triangle with area.
  [[nodiscard]] std::vector<Share> shares(const Disc& disc) const {
    std::vector<Share> shares;
    const Nearest at = nearest(disc);
    if (at.triangle == no_triangle) return shares;
    for (int i = 0; i < 3; ++i) {
      if (!(at.weights[i] > 0)) continue;
      const auto around = around_[mesh_.triangles[at.triangle][static_cast<std::size_t>(i)]];
      double area = 0;
      for (const std::uint32_t triangle : around) area += area_of(triangle);
      for (const std::uint32_t triangle : around) shares.push_back({triangle, at.weights[i] / area});
    }
    return joined(std::move(shares));
  }

 private:
  struct Nearest {
    std::uint32_t triangle = no_triangle;
    glm::dvec3 weights{0.0};
    double distance = unbounded;
    double facing = -1;
  };

  [[nodiscard]] double area_of(std::uint32_t triangle) const {
    const Facet& facet = near_.facet(triangle);
    return 0.5 * glm::length(glm::cross(facet.first, facet.second));
  }

  [[nodiscard]] Nearest nearest(const Disc& disc) const {
    constexpr double close = 1e-6;  // of the mesh's size: samples lie on the mesh, but for rounding
    Nearest best;
    const double same = 1e-9 * scale_;  // distances that differ by less are taken for the same
    const auto consider = [&](std::uint32_t triangle) {
      const Facet& facet = near_.facet(triangle);
      const glm::dvec3 a = facet.corner - disc.centre;
      const glm::dvec3 b = a + facet.first;
      const glm::dvec3 c = a + facet.second;
      const glm::dvec3 weights = closest_point_weights(a, b, c);
      const double distance = glm::length(weights.x * a + weights.y * b + weights.z * c);
      const double facing = std::abs(glm::dot(facet.normal, disc.normal));
      const bool as_near = std::abs(distance - best.distance) <= same;
      const bool better =
          as_near ? facing > best.facing + 1e-9 || (std::abs(facing - best.facing) <= 1e-9 && triangle < best.triangle)
                  : distance < best.distance;
      if (better) best = {triangle, weights, distance, facing};
    };
    for (double reach = close * scale_; best.triangle == no_triangle && reach < 1e12 * scale_; reach *= 16) {
      near_.visit(disc.centre, reach, consider);
      if (best.distance > reach) best = {};  // a nearer one may lie outside of the boxes looked at
    }
    return best;
  }

  static std::vector<Share> joined(std::vector<Share> shares) {
    std::ranges::sort(shares, {}, &Share::triangle);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shares.size(); ++i)
      if (kept > 0 && shares[kept - 1].triangle == shares[i].triangle)
        shares[kept - 1].weight += shares[i].weight;
      else
        shares[kept++] = shares[i];
    shares.resize(kept);
    return shares;
  }

  const Mesh& mesh_;
  const NearTriangles& near_;
  Lists around_;  ///< triangles around each vertex
  double scale_ = 1;
};

class TriangleHitsIndex final : public Index {
 public:
  TriangleHitsIndex(const Mesh& mesh, const std::stop_token& stop, std::shared_ptr<const NearTriangles> triangles)
      : near_(triangles != nullptr ? std::move(triangles) : std::make_shared<const NearTriangles>(mesh, stop)),
        triangles_(mesh.triangles.size()),
        patches_(mesh, *near_) {
    built_.seconds.build = near_->seconds() + watch_.seconds();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const auto rays = static_cast<double>(problem.rays().size());
    const double lists = sizeof(std::uint32_t) * rays + 2 * sizeof(std::size_t) * static_cast<double>(triangles_ + 1);
    add_checked_bytes("photons by triangle", lists + near_bytes(problem, options), problem, outcome);
    StopCheck check(options.stop, "sorting photons by triangle");
    Stopwatch watch;
    const Lists met(triangles_, [&](const auto& add) {
      for (std::uint32_t ray = 0; ray < problem.rays().size(); ++ray) {
        if (const std::uint32_t triangle = problem.triangles()[ray]; triangle < triangles_) add(triangle, ray);
        check.after(1);
      }
    });
    outcome.seconds.build = watch.lap();
    const auto find = [&](std::uint32_t number, Near& near) {
      const Disc& disc = problem.discs()[number];
      for (const Patches::Share& share : patches_.shares(disc))
        for (const std::uint32_t ray : met[share.triangle])
          if (!problem.front_facing() || arrives_in_front(problem.rays()[ray], disc))
            near.landed.push_back({ray, share.weight});
      near.area = 1;
    };
    sum_near(problem, options, find, outcome);
    if (options.count) outcome.counts.references = problem.rays().size();
  }

 private:
  std::shared_ptr<const NearTriangles> near_;
  Stopwatch watch_;  ///< after near_
  std::size_t triangles_;
  Patches patches_;
};

}  // namespace

std::unique_ptr<Index> prepare_triangle_hits(const Mesh& mesh, const std::stop_token& stop,
                                             std::shared_ptr<const NearTriangles> triangles) {
  return std::make_unique<TriangleHitsIndex>(mesh, stop, std::move(triangles));
}

}  // namespace detp::sim
