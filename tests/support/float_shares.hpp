#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "detp/sim/geometry/predicates.hpp"
#include "float_kernels.hpp"
#include "float_search.hpp"

/// Measures how much of their error bounds the float kernels use.
namespace detp::support {

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
