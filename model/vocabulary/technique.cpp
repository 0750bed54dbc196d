#include "technique.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "checks.hpp"

namespace detp {
namespace {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;  // clang 14 does not deduce aggregates

std::string_view words_for(SampleOrder order) {
  if (order == SampleOrder::lebesgue) return "";
  return order == SampleOrder::none ? ", unsorted" : ", Hilbert order";
}

}  // namespace

std::string_view name(Technique technique) {
  switch (technique) {
    case Technique::brute_force:
      return "brute-force";
    case Technique::sphere_cache:
      return "sphere-cache";
    case Technique::sphere_cache_published:
      return "sphere-cache-published";
    case Technique::cell_spheres:
      return "cell-spheres";
    case Technique::sphere_tree:
      return "sphere-tree";
    case Technique::octree:
      return "octree";
    case Technique::grid:
      return "grid";
    case Technique::bvh:
      return "bvh";
    case Technique::photon_map:
      return "photon-map";
    case Technique::bsp:
      return "bsp";
  }
  throw std::logic_error("a technique without a name");
}

std::optional<Technique> technique_named(std::string_view wanted) {
  for (const auto technique : all_techniques)
    if (name(technique) == wanted) return technique;
  return std::nullopt;
}

std::string_view name(SampleOrder order) {
  switch (order) {
    case SampleOrder::lebesgue:
      return "lebesgue";
    case SampleOrder::hilbert:
      return "hilbert";
    case SampleOrder::none:
      return "none";
  }
  throw std::logic_error("an order without a name");
}

std::optional<SampleOrder> order_named(std::string_view wanted) {
  for (const auto order : {SampleOrder::lebesgue, SampleOrder::hilbert, SampleOrder::none})
    if (name(order) == wanted) return order;
  return std::nullopt;
}

std::string_view name(BuildQuality quality) { return quality == BuildQuality::low ? "low" : "medium"; }

std::optional<BuildQuality> quality_named(std::string_view wanted) {
  for (const auto quality : {BuildQuality::low, BuildQuality::medium})
    if (name(quality) == wanted) return quality;
  return std::nullopt;
}

std::string_view name(Bounds bounds) { return bounds == Bounds::spheres ? "spheres" : "boxes"; }

std::optional<Bounds> bounds_named(std::string_view wanted) {
  for (const auto bounds : {Bounds::spheres, Bounds::boxes})
    if (name(bounds) == wanted) return bounds;
  return std::nullopt;
}

std::string describe(const Parameters& parameters) {
  return std::visit(Overload{[](const BruteForceParameters&) { return std::string{}; },
                             [](const SphereCacheParameters& p) {
                               if (p.spheres == 0) return fmt::format("no sphere{}", words_for(p.order));
                               return fmt::format("Q {:.4g}, k {}{}", p.ratio, p.spheres, words_for(p.order));
                             },
                             [](const CellSpheresParameters& p) { return fmt::format("depth {}", p.depth); },
                             [](const SphereTreeParameters& p) {
                               return fmt::format("{} a node, {} a leaf{}", p.fan_out, p.leaf,
                                                  p.bounds == Bounds::boxes ? ", boxes" : "");
                             },
                             [](const OctreeParameters& p) {
                               return fmt::format("depth {}{}{}", p.depth,
                                                  p.traversal == Traversal::top_down ? "" : ", ",
                                                  p.traversal == Traversal::top_down ? "" : name(p.traversal));
                             },
                             [](const GridParameters& p) { return fmt::format("{} cells a side", p.cells); },
                             [](const BspParameters& p) { return fmt::format("depth {}, {} a leaf", p.depth, p.leaf); },
                             [](const BvhParameters& p) { return fmt::format("{} quality", name(p.quality)); },
                             [](const PhotonMapParameters& p) { return fmt::format("{} nearest photons", p.nearest); }},
                    parameters);
}

void check(const Candidate& candidate) {
  const auto want = [&]<class P>(const P*) {
    if (!std::holds_alternative<P>(candidate.parameters))
      throw std::invalid_argument(fmt::format("the parameters are not those of {}", name(candidate.technique)));
    return std::get<P>(candidate.parameters);
  };
  switch (candidate.technique) {
    case Technique::brute_force:
      want(static_cast<const BruteForceParameters*>(nullptr));
      break;
    case Technique::sphere_cache:
    case Technique::sphere_cache_published: {
      const auto p = want(static_cast<const SphereCacheParameters*>(nullptr));
      require_ratio("radius ratio Q", p.ratio);
      require_count("number of spheres", static_cast<double>(p.spheres), 0, 9e18);
      break;
    }
    case Technique::cell_spheres:
      require_count("depth", want(static_cast<const CellSpheresParameters*>(nullptr)).depth, 0, 16);
      break;
    case Technique::sphere_tree: {
      const auto p = want(static_cast<const SphereTreeParameters*>(nullptr));
      require_count("fan-out", p.fan_out, 2, 1048576);
      require_count("samples in a leaf", p.leaf, 1, 1048576);
      break;
    }
    case Technique::octree:
      require_count("depth", want(static_cast<const OctreeParameters*>(nullptr)).depth, 0, 20);
      break;
    case Technique::grid:
      require_count("cells a side", want(static_cast<const GridParameters*>(nullptr)).cells, 1, 1048576);
      break;
    case Technique::bvh:
      want(static_cast<const BvhParameters*>(nullptr));
      break;
    case Technique::photon_map:
      require_count("number of nearest photons", want(static_cast<const PhotonMapParameters*>(nullptr)).nearest, 3,
                    1e9);
      break;
    case Technique::bsp: {
      const auto p = want(static_cast<const BspParameters*>(nullptr));
      require_count("depth", p.depth, 0, 64);
      require_count("discs in a leaf", p.leaf, 1, 1048576);
      break;
    }
  }
}

}  // namespace detp
