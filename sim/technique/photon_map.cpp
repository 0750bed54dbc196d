#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <nanoflann.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/predicates.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

/// Where a ray ends.
struct Photon {
  glm::dvec3 place;
  std::uint32_t ray;
};

std::vector<Photon> photons_of(std::span<const Ray> rays) {
  std::vector<Photon> photons;
  photons.reserve(rays.size());
  for (std::uint32_t ray = 0; ray < rays.size(); ++ray)
    if (!rays[ray].is_line()) photons.push_back({rays[ray].origin + rays[ray].length * rays[ray].direction, ray});
  return photons;
}

/// The photons as nanoflann wants to see them.
struct Cloud {
  std::vector<Photon> photons;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return photons.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t photon, std::size_t axis) const {
    return photons[photon].place[static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

/// Takes in the nearest photons to a disc's centre, nanoflann's way; only those that arrive in front, if that is asked.
class Nearest {
 public:
  using DistanceType = double;

  Nearest(const Problem& problem, const Cloud& cloud, std::size_t wanted)
      : problem_(problem), cloud_(cloud), indices_(wanted), squares_(wanted), found_(wanted) {}

  void start(const Disc& disc) {
    disc_ = &disc;
    found_.init(indices_.data(), squares_.data());
  }

  // What nanoflann asks.
  bool addPoint(double square, std::uint32_t photon) {
    const bool counts = !problem_.front_facing || arrives_in_front(problem_.rays[cloud_.photons[photon].ray], *disc_);
    return !counts || found_.addPoint(square, photon);
  }
  [[nodiscard]] double worstDist() const { return found_.worstDist(); }
  [[nodiscard]] bool full() const { return found_.full(); }

  /// The rays of the photons nearer than the farthest; none where fewer than wanted were found.
  [[nodiscard]] std::vector<std::uint32_t> rays() const {
    std::vector<std::uint32_t> rays;
    for (std::size_t i = 0; full() && i + 1 < indices_.size(); ++i) rays.push_back(cloud_.photons[indices_[i]].ray);
    return rays;
  }

  /// r_k², of the farthest.
  [[nodiscard]] double square() const { return squares_.back(); }

 private:
  const Problem& problem_;
  const Cloud& cloud_;
  const Disc* disc_ = nullptr;
  std::vector<std::uint32_t> indices_;
  std::vector<double> squares_;
  nanoflann::KNNResultSet<double, std::uint32_t> found_;
};

class PhotonMap {
 public:
  PhotonMap(const Problem& problem, int nearest)
      : problem_(problem), cloud_{photons_of(problem.rays)}, wanted_(static_cast<std::size_t>(nearest)) {
    if (cloud_.photons.empty())
      throw std::invalid_argument("no ray is a segment, so that there is no photon; give the rays lengths");
    if (cloud_.photons.size() < wanted_)
      throw std::invalid_argument(
          fmt::format("there are {} photons, fewer than the {} nearest asked for", cloud_.photons.size(), wanted_));
  }

  void estimate(const RunOptions& options, Outcome& outcome) const {
    outcome.hits.resize(problem_.discs.size());
    outcome.irradiance.resize(problem_.discs.size());
    Nearest nearest(problem_, cloud_, wanted_);
    for (std::uint32_t disc = 0; disc < problem_.discs.size() && !outcome.stopped; ++disc) {
      find(problem_.discs[disc], nearest);
      const std::vector<std::uint32_t> rays = nearest.rays();
      double power = 0;
      for (const std::uint32_t ray : rays) {
        power += problem_.rays[ray].power;
        if (options.pairs) outcome.pairs.push_back({ray, disc});
      }
      outcome.hits[disc] = rays.size();
      outcome.total_hits += rays.size();
      if (!rays.empty()) outcome.irradiance[disc] = density(power, nearest.square(), disc);
      outcome.stopped = options.stop.stop_requested();
    }
    std::sort(outcome.pairs.begin(), outcome.pairs.end());
    outcome.counts.hits = outcome.total_hits;
    if (options.count) outcome.counts.references = cloud_.photons.size();
  }

 private:
  void find(const Disc& disc, Nearest& nearest) const {
    nearest.start(disc);
    const double centre[3]{disc.centre.x, disc.centre.y, disc.centre.z};
    tree_.findNeighbors(nearest, centre, nanoflann::SearchParams());
  }

  double density(double power, double square, std::uint32_t disc) const {
    if (!(square >= 1e-200))
      throw std::invalid_argument(fmt::format(
          "{} photons lie at the centre of disc {}, where their density has no bound; ask for more", wanted_, disc));
    return power / (std::numbers::pi * square);
  }

  const Problem& problem_;
  Cloud cloud_;
  std::size_t wanted_;
  Tree tree_{3, cloud_};
};

}  // namespace

void run_photon_map(const Problem& problem, const PhotonMapParameters& parameters, const RunOptions& options,
                    Outcome& outcome) {
  if (options.totals != nullptr)
    throw std::invalid_argument("photon-map needs all rays at once: the nearest of each block are not those of all");
  Stopwatch watch;
  constexpr double node = 40 / 8.0;  // of nanoflann's tree, whose leaves hold 5 to 10 photons
  need_memory("the photon map",
              static_cast<double>(problem.rays.size()) * (1.5 * sizeof(Photon) + sizeof(std::uint32_t) + node) +
                  static_cast<double>(problem.discs.size()) * (sizeof(std::uint64_t) + sizeof(double)),
              problem, outcome);
  const PhotonMap map(problem, parameters.nearest);
  outcome.seconds.build = watch.lap();
  map.estimate(options, outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
