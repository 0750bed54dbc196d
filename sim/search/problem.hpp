#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "photon_sums.hpp"

namespace detp::sim {

/// The radii of a problem's discs.
struct DiscRadii {
  double smallest = unbounded;
  double largest = 0;
  double rms = 0;  ///< root mean square; exactly the radius if all are equal
};

/// Rays and discs that have been checked: a problem that exists is valid. It refers to the caller's rays and discs,
/// which must outlive every use of the problem. They are copied only to be normalised.
class Problem {
 public:
  [[nodiscard]] std::span<const Ray> rays() const { return rays_; }
  /// Rays have the numbers of their photons. If not, each ray is a photon of its own.
  [[nodiscard]] bool numbered() const { return !paths_.photons.empty(); }
  [[nodiscard]] std::span<const std::uint64_t> photons() const { return paths_.photons; }
  /// Number of a ray's photon. Without numbers, the photon of ray 0 has the number `first`.
  [[nodiscard]] std::uint64_t photon(std::size_t ray, std::uint64_t first = 0) const {
    return numbered() ? paths_.photons[ray] : first + ray;
  }
  /// One more than the largest photon number, also of photons without rays.
  [[nodiscard]] std::uint64_t photons_to() const {
    return numbered() ? std::max(paths_.photon_count, paths_.photons.back() + 1) : rays_.size();
  }
  /// The end of the rays from ray `first` on, at most `end`, whose photons are in the same block.
  [[nodiscard]] std::size_t end_of_block(std::size_t first, std::size_t end, std::uint64_t first_photon,
                                         PhotonBlocks blocks) const;
  /// Place where the ray's photon met a surface, as a distance from its origin; not finite if it met none.
  [[nodiscard]] double landing(std::size_t ray) const {
    return paths_.landings.empty() ? rays_[ray].length : paths_.landings[ray];
  }
  /// Of the rays' powers in the irradiance.
  [[nodiscard]] double scale() const { return paths_.scale; }
  /// Number of the triangle that each ray's photon met (PathRays::triangles); empty: not known.
  [[nodiscard]] std::span<const std::uint32_t> triangles() const { return paths_.triangles; }
  /// The rays as they were given, with unit directions.
  [[nodiscard]] PathRays paths() const {
    PathRays all = paths_;
    all.rays = rays_;
    return all;
  }
  /// Number of powers that each ray carries.
  [[nodiscard]] std::size_t bands() const { return 1 + paths_.further.bands; }
  /// The powers of bands 1, 2, …
  [[nodiscard]] const FurtherPowers& further() const { return paths_.further; }
  [[nodiscard]] double power(std::size_t ray, std::size_t band) const {
    return band == 0 ? rays_[ray].power : paths_.further.of(ray)[band - 1];
  }
  [[nodiscard]] std::span<const Disc> discs() const { return discs_; }
  /// S₀: contains every disc completely; rays may start or pass outside it.
  [[nodiscard]] const Sphere& enclosing() const { return enclosing_; }
  /// The smallest box around the discs' centres.
  [[nodiscard]] const Box& centres() const { return centres_; }
  [[nodiscard]] const DiscRadii& radii() const { return radii_; }
  /// Count only rays that arrive at a disc's front.
  [[nodiscard]] bool front_facing() const { return front_facing_; }
  /// Length by which culls are enlarged. A ray that hits comes nearer to its disc than this length (make_problem).
  [[nodiscard]] double slack() const { return slack_; }
  /// Upper bound on the distance of a ray's origin from the centre of S₀.
  [[nodiscard]] double farthest() const { return farthest_; }
  /// Upper bound on a ray's power, so that no sum and no irradiance overflows.
  [[nodiscard]] double most_power() const { return most_power_; }
  /// Largest power of a ray in a band.
  [[nodiscard]] double largest_power(std::size_t band = 0) const {
    return band == 0 ? largest_power_ : largest_further_[band - 1];
  }
  /// All rays carry the same powers.
  [[nodiscard]] bool one_power() const { return one_power_; }
  /// At least one ray is a segment.
  [[nodiscard]] bool segments() const { return segments_; }
  /// Bytes that the caller keeps besides rays and discs, and that count against the memory budget (run_memory.hpp).
  [[nodiscard]] double kept_bytes() const { return kept_bytes_; }
  void set_kept_bytes(double bytes) { kept_bytes_ = bytes; }

 private:
  friend Problem make_problem(const PathRays&, std::span<const Disc>, bool, int, const std::stop_token&);
  friend Problem make_problem_without_rays(std::span<const Disc>, double, bool, const std::stop_token&);
  friend void set_rays(Problem&, const PathRays&, int, std::uint64_t);

  /// Checks and stores the discs. Leaves the rays empty.
  Problem(std::span<const Disc> discs, bool front_facing, int threads, const std::stop_token& stop);
  /// Checks and stores the rays. Returns the distance of the farthest origin from the centre of S₀.
  double store_rays(const PathRays& rays, int threads, std::uint64_t first, const std::stop_token& stop);
  /// Sets the distance of the farthest origin, and computes the slack from it.
  void set_farthest(double farthest);

  std::span<const Ray> rays_;
  PathRays paths_;  ///< the rays as they were given
  std::span<const Disc> discs_;
  Sphere enclosing_{};
  Box centres_;
  DiscRadii radii_;
  bool front_facing_ = false;
  double slack_ = 0;
  double farthest_ = 0;
  double most_power_ = 0;
  double largest_power_ = 0;
  std::vector<double> largest_further_;  ///< powers of bands 1, 2, …
  bool one_power_ = false;
  bool segments_ = false;
  double kept_bytes_ = 0;
  /// The data to which rays_ or discs_ refer if directions or normals had to be normalised; otherwise null.
  std::shared_ptr<const std::vector<Ray>> own_rays_;
  std::shared_ptr<const std::vector<Disc>> own_discs_;
};

/// The smallest sphere around the box of the discs' centres, enlarged by the largest disc radius. Throws
/// std::invalid_argument if there are no discs, and as make_problem does if a disc is malformed; Stopped on a stop request.
[[nodiscard]] Sphere enclosing_sphere(std::span<const Disc> discs, const std::stop_token& stop = {});

/// Makes a problem with its S₀. Checks rays and discs, and normalises directions and normals.
///
/// Directions and normals may have any length except 0. If all have unit length to within 1e-12, the problem refers to
/// the caller's data. Otherwise the problem holds a copy of the rays (64 bytes each) or of the discs (56 bytes each)
/// with unit vectors, so every technique finds the same hits. (Normalise in doubles to avoid the copy: a direction
/// normalised in floats has an error of about 1e-7.) A ray's length does not change: it is in scene units, not a
/// multiple of the direction's length.
///
/// Throws std::invalid_argument for `threads` out of range, if there is no ray or no disc, if rays start farther than
/// 1e100 from the discs, or if a ray or disc is malformed; the message has its number, as in "ray 17: direction must be
/// non-zero (got 0 0 0)". Malformed are: a number that is not finite (except a length of +infinity: the whole line), a
/// coordinate or radius above 1e100, a radius below 1e-100, a direction or normal of length 0, a length <= 0, a power
/// < 0 or above most_power (9.6e288 for radii of at least 1; larger powers could overflow), a photon number below the
/// one before it, a landing < 0, arrays of other lengths than that of the rays, and more than 64 bands. Throws std::length_error
/// for more than 2³² - 2 rays or discs, and Stopped on a stop request.
///
/// The slack is 16e-12 E + ∛(2d κ²) + 1e-15 M. In spite of rounding, a ray that counts as a hit comes nearer to the
/// disc than the slack, with a margin for the rounding of the culls (proof: sim/geometry/proofs.md). E is the distance
/// of the farthest ray origin from the farthest point of S₀, d the largest disc radius, κ = 2e-15 E the rounding error
/// of a predicate, M the largest coordinate of the centre of S₀. The first term covers directions and normals that have
/// unit length only to within 1e-12. The second term covers rays that graze a disc near its rim, where rounding moves
/// the crossing farthest. The third term covers cells far from the origin.
[[nodiscard]] Problem make_problem(const PathRays& rays, std::span<const Disc> discs, bool front_facing = false,
                                   int threads = 1, const std::stop_token& stop = {});

/// Makes a problem whose rays come later, in blocks (set_rays). Their origins may be at most `farthest` from the centre
/// of S₀; the slack is computed from this distance. Throws as make_problem does.
[[nodiscard]] Problem make_problem_without_rays(std::span<const Disc> discs, double farthest, bool front_facing = false,
                                                const std::stop_token& stop = {});

/// Replaces a problem's rays; copies them only to normalise them. Throws as make_problem does, and
/// std::invalid_argument if a ray starts farther than Problem::farthest from the centre of S₀. The first ray is number
/// `first` in messages. If this throws, the problem is unchanged.
void set_rays(Problem& problem, const PathRays& rays, int threads = 1, std::uint64_t first = 0);

}  // namespace detp::sim
