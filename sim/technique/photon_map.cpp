#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <nanoflann.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "detp/sim/search/sort_pairs.hpp"
#include "registry.hpp"

namespace detp::sim {
namespace {

/// Where a photon met a surface, at the end of a ray.
struct Photon {
  glm::dvec3 place;
  std::uint32_t ray;
};

std::vector<Photon> photons_of(const Problem& problem, StopCheck& check) {
  std::vector<Photon> photons;
  photons.reserve(problem.rays().size());
  for (std::uint32_t number = 0; number < problem.rays().size(); ++number) {
    const Ray& ray = problem.rays()[number];
    if (const double landing = problem.landing(number); landing < unbounded)
      photons.push_back({ray.origin + landing * ray.direction, number});
    check.after(1);
  }
  return photons;
}

/// The photons in the form that nanoflann requires. Building a tree calls these functions for every photon, so they
/// also check for a stop request, and throw Stopped.
struct PhotonCloud {
  std::vector<Photon> photons;
  StopCheck* building;  ///< null once the tree is built

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return photons.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t photon, std::size_t axis) const {
    if (building != nullptr) building->after(1);
    return photons[photon].place[static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};
using PhotonTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PhotonCloud>, PhotonCloud,
                                                       3, std::uint32_t>;

/// Collects the nearest photons to a disc's centre for nanoflann; with front_facing only photons that arrive in front.
class NearestPhotons {
 public:
  using DistanceType = double;

  NearestPhotons(const Problem& problem, const PhotonCloud& cloud, std::size_t wanted)
      : problem_(problem), cloud_(cloud), indices_(wanted), squares_(wanted), found_(wanted) {}

  void start(const Disc& disc) {
    disc_ = &disc;
    found_.init(indices_.data(), squares_.data());
  }

  // nanoflann calls this for each candidate.
  bool addPoint(double square, std::uint32_t photon) {
    const bool counts =
        !problem_.front_facing() || arrives_in_front(problem_.rays()[cloud_.photons[photon].ray], *disc_);
    return !counts || found_.addPoint(square, photon);
  }
  [[nodiscard]] double worstDist() const { return found_.worstDist(); }
  [[nodiscard]] bool full() const { return found_.full(); }

  /// The rays of all photons found, except the farthest; empty if fewer photons than wanted were found.
  [[nodiscard]] std::vector<std::uint32_t> rays() const {
    std::vector<std::uint32_t> rays;
    for (std::size_t i = 0; full() && i + 1 < indices_.size(); ++i) rays.push_back(cloud_.photons[indices_[i]].ray);
    return rays;
  }

  /// r_k², the square of the farthest photon's distance.
  [[nodiscard]] double square() const { return squares_.back(); }

 private:
  const Problem& problem_;
  const PhotonCloud& cloud_;
  const Disc* disc_ = nullptr;
  std::vector<std::uint32_t> indices_;
  std::vector<double> squares_;
  nanoflann::KNNResultSet<double, std::uint32_t> found_;
};

class PhotonMap {
 public:
  PhotonMap(const Problem& problem, int nearest, const std::stop_token& stop)
      : problem_(problem),
        check_(stop, "building the photon map"),
        cloud_{photons_of(problem, check_), &check_},
        wanted_(static_cast<std::size_t>(nearest)) {
    cloud_.building = nullptr;
    if (cloud_.photons.empty())
      throw std::invalid_argument(
          "photon-map needs photons, where rays met a surface, but no ray met one: give rays with a finite length");
    if (cloud_.photons.size() < wanted_)
      throw std::invalid_argument(fmt::format("photon-map needs the {} nearest photons, but the rays have only {}",
                                              wanted_, cloud_.photons.size()));
  }

  void estimate(const RunOptions& options, Outcome& outcome) const {
    outcome.hits.resize(problem_.discs().size());
    outcome.irradiance.resize(problem_.discs().size());
    NearestPhotons nearest(problem_, cloud_, wanted_);
    std::uint32_t disc = 0;
    for (; disc < problem_.discs().size() && !options.stop.stop_requested(); ++disc) {
      report_share(options, disc, problem_.discs().size());
      find(problem_.discs()[disc], nearest);
      const std::vector<std::uint32_t> rays = nearest.rays();
      double power = 0;
      for (const std::uint32_t ray : rays) {
        power += problem_.rays()[ray].power;
        if (options.pairs) add_pair(outcome.pairs, {ray, disc});
      }
      outcome.hits[disc] = rays.size();
      outcome.total_hits += rays.size();
      if (!rays.empty()) outcome.irradiance[disc] = density(power, nearest.square(), disc);
    }
    finish(disc, options, outcome);
    if (options.count) outcome.counts.references = cloud_.photons.size();
  }

 private:
  /// Fills in the outcome after `done` discs.
  void finish(std::uint32_t done, const RunOptions& options, Outcome& outcome) const {
    outcome.counts.hits = outcome.total_hits;
    outcome.bytes += grown_bytes(outcome.pairs.size(), sizeof(Pair));
    outcome.progress = {problem_.rays().size(), problem_.rays().size()};
    outcome.stopped = done < problem_.discs().size() || !sort_pairs(outcome.pairs, options.stop);
    if (outcome.stopped) outcome.pairs.clear();
    if (done == problem_.discs().size()) return;
    outcome.done_discs.assign(problem_.discs().size(), false);
    std::fill_n(outcome.done_discs.begin(), done, true);
    keep_done_discs(outcome);
  }

  void find(const Disc& disc, NearestPhotons& nearest) const {
    nearest.start(disc);
    const double centre[3]{disc.centre.x, disc.centre.y, disc.centre.z};
    tree_.findNeighbors(nearest, centre, nanoflann::SearchParams());
  }

  double density(double power, double square, std::uint32_t disc) const {
    if (!(square >= 1e-200))
      throw std::invalid_argument(
          fmt::format("{} photons lie at the centre of disc {}, so the density there is infinite: increase the number "
                      "of nearest photons",
                      wanted_, disc));
    return power / (std::numbers::pi * square);
  }

  const Problem& problem_;
  StopCheck check_;
  PhotonCloud cloud_;
  std::size_t wanted_;
  PhotonTree tree_{3, cloud_};
};

/// Bytes of the photons, of the indices by which nanoflann's tree orders them, of the tree's nodes, and of the outcome.
/// A leaf holds at most 10 photons. On average it holds 5 to 6 if repeated halving splits evenly spread photons, and
/// fewer if they are concentrated.
double map_bytes(const Problem& problem) {
  constexpr double in_a_leaf = 5.5;
  constexpr double node = sizeof(PhotonTree::Node);
  double photons = 0;
  for (std::size_t ray = 0; ray < problem.rays().size(); ++ray) photons += problem.landing(ray) < unbounded ? 1 : 0;
  return photons * (sizeof(Photon) + sizeof(std::uint32_t) + 2 * node / in_a_leaf) +
         static_cast<double>(problem.discs().size()) * (sizeof(std::uint64_t) + sizeof(double));
}

/// Another estimator, for comparison: the irradiance at a disc's centre from the k nearest photons. A photon is where a ray
/// met a surface (Problem::landing): without landings, the end of a ray of finite length; lines have none.
///
///     E = (power of the k - 1 nearest) / (π r_k²)        r_k: distance of the k-th nearest
///
/// With k instead of k - 1, the result would be k/(k - 1) times too large for evenly spread photons (García, Ureña,
/// Sbert, CGF 2012; standard deviation and bias of E: model/accuracy/nearest_photons.hpp). The discs' radii and normals
/// do not matter, except that with front_facing only photons that arrive in front count. If fewer than k photons count
/// for a disc, its irradiance is 0.
///
/// Hits and pairs are the k - 1 photons used. Counts are stored photons (references) and hits. It runs on one thread.
class PhotonMapIndex final : public Index {
 public:
  explicit PhotonMapIndex(int nearest) : nearest_(nearest) {}

  /// Throws std::invalid_argument if no ray has a finite length, if there are fewer than k photons, if k of them are
  /// exactly at a disc's centre, and for totals or a standard error, which this estimator does not have.
  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    if (options.totals != nullptr)
      throw std::invalid_argument(
          "photon-map needs all rays at once: the nearest photons of a block of rays are not the nearest of all rays");
    if (options.standard_error)
      throw std::invalid_argument(
          "photon-map has no standard error, because the photons near a disc are not independent samples");
    add_checked_bytes("the photon map", map_bytes(problem), problem, outcome);
    Stopwatch watch;
    const PhotonMap map(problem, nearest_, options.stop);
    outcome.seconds.build = watch.lap();
    map.estimate(options, outcome);
  }

 private:
  int nearest_;
};

}  // namespace

std::unique_ptr<Index> prepare_photon_map(const Problem&, const Parameters& parameters, const RunOptions&) {
  return std::make_unique<PhotonMapIndex>(std::get<PhotonMapParameters>(parameters).nearest);
}

}  // namespace detp::sim
