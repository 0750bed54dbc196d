#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/near/landing_tree.hpp"
#include "detp/sim/near/near_sums.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "detp/sim/search/sort_pairs.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

/// Collects the nearest photons to a disc's centre for nanoflann; with front_facing only photons that arrive in front.
class NearestPhotons {
 public:
  using DistanceType = double;

  NearestPhotons(const Problem& problem, const LandingCloud& cloud, std::size_t wanted, const Disc& disc)
      : problem_(problem), cloud_(cloud), disc_(disc), indices_(wanted), squares_(wanted), found_(wanted) {
    found_.init(indices_.data(), squares_.data());
  }

  // nanoflann calls this for each candidate.
  bool addPoint(double square, std::uint32_t photon) {
    const bool counts =
        !problem_.front_facing() || arrives_in_front(problem_.rays()[cloud_.landings[photon].ray], disc_);
    return !counts || found_.addPoint(square, photon);
  }
  [[nodiscard]] double worstDist() const { return found_.worstDist(); }
  [[nodiscard]] bool full() const { return found_.full(); }

  /// All photons found; the unbiased form without the farthest.
  void take(NearestForm form, Near& near) const {
    const std::size_t count = indices_.size() - (form == NearestForm::unbiased ? 1 : 0);
    for (std::size_t i = 0; i < count; ++i) near.landed.push_back({cloud_.landings[indices_[i]].ray, 1});
  }

  /// r_k², the square of the farthest photon's distance.
  [[nodiscard]] double square() const { return squares_.back(); }

 private:
  const Problem& problem_;
  const LandingCloud& cloud_;
  const Disc& disc_;
  std::vector<std::uint32_t> indices_;
  std::vector<double> squares_;
  nanoflann::KNNResultSet<double, std::uint32_t> found_;
};

class PhotonMap {
 public:
  PhotonMap(const Problem& problem, const PhotonMapParameters& parameters, const std::stop_token& stop)
      : problem_(problem),
        check_(stop, "building the photon map"),
        cloud_{landings_of(problem, check_), &check_},
        wanted_(static_cast<std::size_t>(parameters.nearest)),
        form_(parameters.form) {
    cloud_.building = nullptr;
    if (cloud_.landings.empty())
      throw std::invalid_argument(
          "photon-map needs photons, where rays met a surface, but no ray met one: give rays with a finite length");
    if (cloud_.landings.size() < wanted_)
      throw std::invalid_argument(fmt::format("photon-map needs the {} nearest photons, but the rays have only {}",
                                              wanted_, cloud_.landings.size()));
  }

  [[nodiscard]] std::size_t photons() const { return cloud_.landings.size(); }

  void find(std::uint32_t disc, Near& near) const {
    NearestPhotons nearest(problem_, cloud_, wanted_, problem_.discs()[disc]);
    const glm::dvec3& centre = problem_.discs()[disc].centre;
    const double point[3]{centre.x, centre.y, centre.z};
    tree_.findNeighbors(nearest, point, nanoflann::SearchParams());
    if (!nearest.full()) return;
    if (!(nearest.square() >= 1e-200))
      throw std::invalid_argument(
          fmt::format("{} photons lie at the centre of disc {}, so the density there is infinite: increase the number "
                      "of nearest photons",
                      wanted_, disc));
    nearest.take(form_, near);
    near.area = std::numbers::pi * nearest.square();
  }

 private:
  const Problem& problem_;
  StopCheck check_;
  LandingCloud cloud_;
  std::size_t wanted_;
  NearestForm form_;
  LandingKdTree tree_{3, cloud_};
};

/// Another estimator, for comparison: the irradiance at a disc's centre from the k nearest photons. A photon is where a ray
/// met a surface (Problem::landing): without landings, the end of a ray of finite length; lines have none.
///
///     E = (power of the k - 1 nearest) / (π r_k²)        r_k: distance of the k-th nearest
///
/// With k instead of k - 1 (NearestForm::plain; H. W. Jensen, 1996), the result is k/(k - 1) times too large for evenly spread photons (García, Ureña,
/// Sbert, CGF 2012; standard deviation and bias of E: model/accuracy/nearest_photons.hpp). The discs' radii and normals
/// do not matter, except that with front_facing only photons that arrive in front count. If fewer than k photons count
/// for a disc, its irradiance is 0.
///
/// The standard error is that of the power in a circle of the fixed radius r_k. To first order, r_k does not change it: with
/// N and W the number and the power of the photons within the radius at which k are expected, the estimate is
/// W/(π r²) (1 + (N - k)/k - (N - k)/k), since the circle grows until it holds k. Source: our derivation.
///
/// Hits and pairs are the k - 1 photons used, or all k. Counts are stored photons (references) and hits.
class PhotonMapIndex final : public Index {
 public:
  explicit PhotonMapIndex(const PhotonMapParameters& parameters) : parameters_(parameters) {}

  /// Throws std::invalid_argument if no ray has a finite length, if there are fewer than k photons, if k of them are
  /// exactly at a disc's centre, and for totals.
  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    if (options.totals != nullptr)
      throw std::invalid_argument(
          "photon-map needs all rays at once: the nearest photons of a block of rays are not the nearest of all rays");
    add_checked_bytes("the photon map", landing_tree_bytes(problem) + near_bytes(problem, options), problem, outcome);
    Stopwatch watch;
    const PhotonMap map(problem, parameters_, options.stop);
    outcome.seconds.build = watch.lap();
    if (options.pairs)
      find_pairs(problem, map, options, outcome);
    else
      sum_near(
          problem, options, [&](std::uint32_t disc, Near& near) { map.find(disc, near); }, outcome);
    if (options.count) outcome.counts.references = map.photons();
  }

 private:
  static void find_pairs(const Problem& problem, const PhotonMap& map, const RunOptions& options, Outcome& outcome) {
    RunOptions alone = options;  // one thread writes the pairs
    alone.threads = 1;
    const auto find = [&](std::uint32_t disc, Near& near) {
      map.find(disc, near);
      for (const Landed& one : near.landed) add_pair(outcome.pairs, {one.ray, disc});
    };
    sum_near(problem, alone, find, outcome);
    outcome.bytes += grown_bytes(outcome.pairs.size(), sizeof(Pair));
    outcome.stopped = !sort_pairs(outcome.pairs, options.stop) || outcome.stopped;
    if (outcome.stopped) outcome.pairs.clear();
  }

  PhotonMapParameters parameters_;
};

}  // namespace

std::unique_ptr<Index> prepare_photon_map(const Problem&, const Parameters& parameters, const RunOptions&) {
  return std::make_unique<PhotonMapIndex>(std::get<PhotonMapParameters>(parameters));
}

}  // namespace detp::sim
