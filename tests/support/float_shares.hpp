#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"

/// Measures how much of their error bounds the float kernels use.
namespace detp::support {

// A second implementation of the float kernels (sim/lists/simd/kernels-inl.hpp), for one ray and any number type:
// floats, with and without fused operations, and long double as the reference.

/// A ray and a disc in the coordinates of the ray's class.
template <class Real>
struct KernelCase {
  Real a, b, p, q, from, to;
  Real centre[3];
  Real normal[3];
  Real radius;
};

template <class Real, bool fused>
struct Kernel {
  static Real mul_add(Real a, Real b, Real c) {
    if constexpr (fused)
      return std::fma(a, b, c);
    else
      return a * b + c;
  }

  /// The values that decide whether the ray hits the disc. sim/lists/simd/floats.md explains the symbols.
  struct Disc {
    Real rim;      ///< |V| - d|φ|: <= 0 for hits
    Real facing;   ///< φ
    Real after;    ///< >= 0: crosses above the segment's lower end
    Real before;   ///< >= 0: crosses below the segment's upper end
    Real beside;   ///< |w|
    Real highest;  ///< the larger distance in z from the centre to an end of the segment
  };

  explicit Kernel(const KernelCase<Real>& of) : ray(of) {
    P = mul_add(ray.a, ray.centre[2], ray.p) - ray.centre[0];
    Q = mul_add(ray.b, ray.centre[2], ray.q) - ray.centre[1];
  }

  [[nodiscard]] Disc disc() const {
    const Real* n = ray.normal;
    const Real facing = mul_add(n[0], ray.a, mul_add(n[1], ray.b, n[2]));
    const Real height = mul_add(n[0], P, n[1] * Q);
    const Real X = mul_add(-ray.a, height, P * facing);
    const Real Y = mul_add(-ray.b, height, Q * facing);
    const Real square = mul_add(X, X, mul_add(Y, Y, height * height));
    const Real size = std::abs(facing);
    const Real along = std::signbit(facing) ? height : -height;
    return {.rim = std::sqrt(square) - ray.radius * size,
            .facing = facing,
            .after = mul_add(-(ray.from - ray.centre[2]), size, along),
            .before = mul_add(ray.to - ray.centre[2], size, -along),
            .beside = std::sqrt(P * P + Q * Q),
            .highest = std::max(std::abs(ray.from - ray.centre[2]), std::abs(ray.to - ray.centre[2]))};
  }

  /// The ray's distance from the centre.
  [[nodiscard]] double distance() const {
    const Real turn = mul_add(P, ray.b, -(Q * ray.a));
    const Real moment = mul_add(P, P, mul_add(Q, Q, turn * turn));
    const Real stretch = mul_add(ray.a, ray.a, mul_add(ray.b, ray.b, Real{1}));
    return static_cast<double>(std::sqrt(static_cast<long double>(moment) / static_cast<long double>(stretch)));
  }

  /// By how much a box around `centre` must grow for the ray to be listed.
  [[nodiscard]] Real beyond_box(const Real (&half)[3], bool segment) const {
    const Real x = mul_add(-std::abs(ray.a), half[2], std::abs(P)) - half[0];
    const Real y = mul_add(-std::abs(ray.b), half[2], std::abs(Q)) - half[1];
    Real beyond = std::max(x / (1 + std::abs(ray.a)), y / (1 + std::abs(ray.b)));
    if (segment) beyond = std::max({beyond, ray.from - (ray.centre[2] + half[2]), (ray.centre[2] - half[2]) - ray.to});
    return beyond;
  }

  KernelCase<Real> ray;
  Real P, Q;
};

// Calls the float kernels directly, so that tests may narrow their bands and margins.

/// A problem's rays and discs in the form that the kernels use.
struct Floats {
  explicit Floats(const sim::Problem& of) : problem(of), frame(of) {
    std::vector<std::uint32_t> order(problem.discs().size());
    std::iota(order.begin(), order.end(), 0U);
    discs = sim::stream::discs_in_order(problem, frame, {order.begin(), order.end()});
    for (sim::stream::RayList& list : lists) list = arena.allocate(problem.rays().size(), true);
    traits = load_rays(problem.rays(), frame, lists);
  }

  const sim::Problem& problem;
  sim::stream::Frame frame;
  sim::stream::DiscTree discs;  ///< the discs only; no tree
  sim::stream::ListArena arena;
  sim::stream::RayLists lists;
  sim::stream::RayTraits traits;
};

/// Hits of each disc, found by `search(block, worker)`.
template <class Search>
std::vector<std::uint64_t> count_hits(const Floats& floats, const sim::stream::Frame& frame,
                                      const sim::stream::DiscTree& discs, const Search& search) {
  std::vector<sim::stream::ClassCounts> hits(discs.discs.size());
  const sim::stream::BlockSearch block{.problem = floats.problem,
                                       .frame = frame,
                                       .tree = discs,
                                       .first_ray = 0,
                                       .segments = floats.traits.segments,
                                       .pairs = false,
                                       .vectors = false,
                                       .hits = hits.data(),
                                       .totals = nullptr};
  sim::stream::Worker worker;
  search(block, worker);
  std::vector<std::uint64_t> sums(hits.size());
  for (std::size_t place = 0; place < hits.size(); ++place)
    for (const std::uint32_t of_class : hits[place]) sums[discs.order[place]] += of_class;
  return sums;
}

/// Tests every ray against every disc, with bands `times` as wide.
inline std::vector<std::uint64_t> hits_with_band(const Floats& floats, float times) {
  sim::stream::DiscTree discs = floats.discs;
  for (sim::stream::FloatDisc& disc : discs.discs) disc.band *= times;
  return count_hits(floats, floats.frame, discs, [&](const auto& block, auto& worker) {
    for (int k = 0; k < sim::stream::classes; ++k)
      test_discs(block, k, 0, static_cast<std::uint32_t>(discs.discs.size()), floats.lists[static_cast<std::size_t>(k)],
                 worker);
  });
}

/// Searches a binary tree of boxes with one disc a leaf, with margins `times` as wide.
inline std::vector<std::uint64_t> hits_in_boxes(const Floats& floats, float times) {
  sim::stream::Frame frame = floats.frame;
  frame.margin *= times;
  const sim::stream::DiscTree tree = make_disc_tree(floats.problem, frame, {2, 1});
  return count_hits(floats, frame, tree, [&](const auto& block, auto& worker) {
    search_below(block, tree.nodes.front(), floats.lists, worker);
  });
}

/// Tests each disc with the rays that meet the sphere around it, with margins `times` as wide.
inline std::vector<std::uint64_t> hits_in_spheres(const Floats& floats, float times) {
  return count_hits(floats, floats.frame, floats.discs, [&](const auto& block, auto& worker) {
    for (std::uint32_t place = 0; place < floats.discs.discs.size(); ++place) {
      const sim::Disc& disc = floats.problem.discs()[place];
      sim::stream::FloatSphere sphere = floats.frame(sim::Sphere{disc.centre, disc.radius});
      sphere.radius += (times - 1) * floats.frame.margin;
      for (int k = 0; k < sim::stream::classes; ++k) {
        const sim::stream::RayList& around = floats.lists[static_cast<std::size_t>(k)];
        const sim::stream::ArenaScope scope(worker.lists);
        sim::stream::RayList inside = worker.lists.allocate(around.size, true);
        cull_sphere(block, k, sphere, around, inside, worker);
        test_discs(block, k, place, 1, inside, worker);
      }
    }
  });
}

/// The kernels' largest errors, as shares of the bounds in frame.hpp.
struct Shares {
  double rim = 0;     ///< error of |V| - d|φ|, as a share of the band
  double ends = 0;    ///< error at a segment's end, as a share of half the band
  double box = 0;     ///< growth of the discs' boxes that was needed to list all hits, as a share of the margin
  double sphere = 0;  ///< the same for spheres that a ray just touches
  std::uint64_t decisions = 0;
  std::uint64_t hits = 0;
  std::uint64_t wrong = 0;  ///< decisions in which floats alone differ from the canonical predicate
  /// among those, the largest distance from the rim (share of the band) or from an end (share of half the band)
  double widest = 0;
  std::uint64_t outside = 0;  ///< wrong decisions that are not within the band
};

/// A ray and a disc in long double, which is practically exact compared with a float kernel.
inline KernelCase<long double> exact_case(const sim::stream::Frame& frame, const sim::Ray& ray, const sim::Disc& disc,
                                          int k) {
  const auto axes = sim::stream::axes_of_class(k);
  const auto place = [&](const glm::dvec3& point, int i) {
    const int axis = axes[static_cast<std::size_t>(i)];
    return (static_cast<long double>(point[axis]) - frame.centre[axis]) * frame.scale;
  };
  const auto along = [&](int i) { return static_cast<long double>(ray.direction[axes[static_cast<std::size_t>(i)]]); };
  KernelCase<long double> exact{};
  exact.a = along(0) / along(2);
  exact.b = along(1) / along(2);
  exact.p = place(ray.origin, 0) - exact.a * place(ray.origin, 2);
  exact.q = place(ray.origin, 1) - exact.b * place(ray.origin, 2);
  const long double start = place(ray.origin, 2);
  const long double end = ray.is_line() ? start : start + static_cast<long double>(ray.length) * frame.scale * along(2);
  exact.from = ray.is_line() ? -4 : std::min(start, end);
  exact.to = ray.is_line() ? 4 : std::max(start, end);
  for (int i = 0; i < 3; ++i) exact.centre[i] = place(disc.centre, i);
  for (int i = 0; i < 3; ++i) exact.normal[i] = disc.normal[axes[static_cast<std::size_t>(i)]];
  exact.radius = static_cast<long double>(disc.radius) * frame.scale;
  return exact;
}

inline KernelCase<float> as_listed(const sim::stream::RayList& list, std::size_t i, const sim::stream::FloatDisc& disc,
                                   int k) {
  const auto axes = sim::stream::axes_of_class(k);
  KernelCase<float> floats{.a = list.a[i],
                           .b = list.b[i],
                           .p = list.p[i],
                           .q = list.q[i],
                           .from = list.from[i],
                           .to = list.to[i],
                           .centre = {},
                           .normal = {},
                           .radius = disc.radius};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    floats.centre[axis] = disc.centre[axes[axis]];
    floats.normal[axis] = disc.normal[axes[axis]];
  }
  return floats;
}

/// For each disc, by its number in the problem, the tree's leaf that contains it.
inline std::vector<sim::stream::TreeNode> boxes_of(const Floats& floats) {
  const sim::stream::DiscTree tree = make_disc_tree(floats.problem, floats.frame, {2, 1});
  std::vector<sim::stream::TreeNode> boxes(tree.order.size());
  for (const sim::stream::TreeNode& node : tree.nodes)
    for (std::uint32_t i = 0; node.leaf && i < node.count; ++i) boxes[tree.order[node.first + i]] = node;
  return boxes;
}

template <bool fused>
class Measure {
 public:
  Measure(const Floats& floats, Shares& shares) : floats_(floats), boxes_(boxes_of(floats)), shares_(shares) {}

  void all() {
    for (int k = 0; k < sim::stream::classes; ++k)
      for (std::size_t i = 0; i < floats_.lists[static_cast<std::size_t>(k)].size; ++i)
        for (std::size_t disc = 0; disc < floats_.discs.discs.size(); ++disc) one(k, i, disc);
  }

 private:
  void one(int k, std::size_t i, std::size_t number) {
    const sim::stream::RayList& list = floats_.lists[static_cast<std::size_t>(k)];
    const sim::Ray& ray = floats_.problem.rays()[list.id[i] & ~sim::stream::falling];
    const sim::Disc& disc = floats_.problem.discs()[number];
    const KernelCase<float> listed = as_listed(list, i, floats_.discs.discs[number], k);
    const Kernel<float, fused> kernel(listed);
    const Kernel<long double, false> truth(exact_case(floats_.frame, ray, disc, k));
    const bool hit = sim::hits(ray, disc);
    decision(kernel.disc(), truth.disc(), truth.ray.radius, floats_.discs.discs[number].band, ray.is_line(), hit);
    sphere(kernel, truth);
    if (hit) box(listed, boxes_[number], k, !ray.is_line());
  }

  using InFloats = typename Kernel<float, fused>::Disc;
  using InTruth = Kernel<long double, false>::Disc;

  void decision(const InFloats& floats, const InTruth& truth, long double radius, double band, bool line, bool hit) {
    const bool near = truth.beside <= 4 * radius;
    if (near) shares_.rim = std::max(shares_.rim, difference(floats.rim, truth.rim) / band);
    if (near && !line && truth.highest <= 2 * radius)
      shares_.ends = std::max(
          shares_.ends,
          std::max(difference(floats.after, truth.after), difference(floats.before, truth.before)) / (band / 2));
    const double rim = std::abs(floats.rim) / band;
    const double end = line ? 0 : -std::min(floats.after, floats.before) / (band / 2);
    const bool decided = floats.rim <= 0 && end <= 0;
    ++shares_.decisions;
    shares_.hits += hit ? 1 : 0;
    if (decided == hit) return;
    // Distance from where the decision would change: the nearest boundary for a false hit, the farthest for a false
    // miss.
    const double bands = hit ? std::max(floats.rim > 0 ? rim : 0, end) : (line ? rim : std::min(rim, -end));
    ++shares_.wrong;
    shares_.outside += bands <= 1 ? 0 : 1;
    shares_.widest = std::max(shares_.widest, bands);
  }

  /// Tests the sphere around the disc's centre that the ray just touches.
  void sphere(const Kernel<float, fused>& floats, const Kernel<long double, false>& truth) {
    const double distance = truth.distance();
    if (distance > 1) return;
    const auto radius = static_cast<float>(distance);
    const double beyond = floats.distance() - std::sqrt(static_cast<double>(radius * radius));
    shares_.sphere = std::max(shares_.sphere, beyond / floats_.frame.margin);
  }

  void box(KernelCase<float> ray, const sim::stream::TreeNode& node, int k, bool segment) {
    const auto axes = sim::stream::axes_of_class(k);
    float half[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.centre[axis] = node.centre[axes[axis]];
      half[axis] = node.half[axes[axis]];
    }
    const double beyond = Kernel<float, fused>(ray).beyond_box(half, segment);
    shares_.box = std::max(shares_.box, beyond / floats_.frame.margin);
  }

  static double difference(float floats, long double truth) { return static_cast<double>(std::abs(floats - truth)); }

  const Floats& floats_;
  std::vector<sim::stream::TreeNode> boxes_;
  Shares& shares_;
};

}  // namespace detp::support
