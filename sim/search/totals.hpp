#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "photon_sums.hpp"

/// Sums over rays, in the order that all techniques use.
namespace detp::sim {

class Problem;

/// The sums over the rays that hit one disc.
struct DiscTotals {
  std::uint64_t hits = 0;  ///< of all rays
  glm::dvec3 power{0.0};   ///< of the block under way, by the rays' dominant_axis: three sums, each in ray order
};

/// The sums over rays for each disc, in the order of the discs.
///
/// Floating-point sums depend on their order, so the order is fixed: it depends on the photons' numbers and the number of
/// discs, and not on techniques, threads, or how rays are cut into searches. Within a block of photons, powers are added in ray order, in three sums by dominant axis; the block's power is (x + y) + z. Squares of photons' powers likewise (PhotonSums).
/// Blocks are added pairwise, as the leaves of a binary tree: T(0, b) is block b, T(l + 1, i) = T(l, 2i) + T(l, 2i + 1), and
/// a block without photons counts as 0. So any range of blocks can be summed apart, for instance by another process: as the largest
/// subtrees that it contains.
///
/// A complete block goes into `levels`, which work like the digits of a binary counter: level l holds the latest T(l, ·)
/// that is not part of a larger subtree yet. There are none as long as all photons are in the first block.
///
/// If rays carry powers in several bands, each further band has totals of its own. Numbers of hits are those of band 0.
class Totals {
 public:
  using Memory = std::pmr::memory_resource;

  explicit Totals(std::size_t discs = 0, Memory* memory = std::pmr::new_delete_resource());
  Totals(const Totals& other, Memory* memory);

  [[nodiscard]] bool empty() const { return discs_.empty(); }
  [[nodiscard]] std::size_t size() const { return discs_.size(); }
  void resize(std::size_t discs);
  /// Those for the number of discs, unless others were set.
  [[nodiscard]] PhotonBlocks photon_blocks() const { return blocks_.value_or(PhotonBlocks::for_discs(size())); }
  /// To be called before the first ray, if the discs are a part of all.
  void set_photon_blocks(PhotonBlocks blocks) {
    blocks_ = blocks;
    for (Totals& further : further_) further.set_photon_blocks(blocks);
  }

  DiscTotals& operator[](std::size_t disc) { return discs_[disc]; }
  const DiscTotals& operator[](std::size_t disc) const { return discs_[disc]; }

  /// Also sums what standard errors need. To be called before the first ray.
  void keep_errors();
  [[nodiscard]] bool keeps_errors() const { return keeps_errors_; }
  PhotonSums& photon_sums(std::size_t disc) { return photon_sums_[disc]; }
  const PhotonSums& photon_sums(std::size_t disc) const { return photon_sums_[disc]; }
  [[nodiscard]] std::span<const PhotonSums> photon_sums() const { return photon_sums_; }
  /// To be called before the first search. Without this call, its rays decide.
  void set_bands(std::size_t bands);
  /// To be called before each search: changes the unit of the squares if its rays' powers need that. Throws std::invalid_argument if the rays do not
  /// have as many bands as earlier ones.
  void expect_powers(const Problem& problem);
  [[nodiscard]] std::size_t bands() const { return 1 + further_.size(); }
  /// Those of a band; band 0 is this.
  [[nodiscard]] Totals& band(std::size_t band) { return band == 0 ? *this : further_[band - 1]; }
  [[nodiscard]] const Totals& band(std::size_t band) const { return band == 0 ? *this : further_[band - 1]; }
  /// u, of PhotonSums::squares and `squares`.
  [[nodiscard]] double unit() const { return std::ldexp(1.0, unit_exponent_); }
  [[nodiscard]] int unit_exponent() const { return unit_exponent_; }

  /// Number of the block under way.
  [[nodiscard]] std::uint64_t block() const { return block_; }
  /// Makes room for the levels that blocks up to this one need, for so many discs. To be called before `fold`.
  void make_levels(std::size_t discs, std::uint64_t last_block);
  /// For one disc: block number `from` is complete, and blocks between it and `to` are empty. Moves its sums into the
  /// levels, and empties them. `photons` may be null. Different discs may be folded by several threads.
  void fold(std::size_t disc, std::uint64_t from, std::uint64_t to, DiscTotals& sums, PhotonSums* photons);
  /// Asks for what `fold` of the disc will use.
  void prefetch(std::size_t disc, std::uint64_t from) const;
  /// All discs have been folded up to this block.
  void begin_block(std::uint64_t block) {
    block_ = block;
    for (Totals& further : further_) further.begin_block(block);
  }

  /// Sums of blocks from this one on, a part of all: blocks before it are summed elsewhere. To be called before the first ray, when the
  /// number of discs is known.
  void begin_at(std::uint64_t block);
  /// The first block that is summed here.
  [[nodiscard]] std::uint64_t origin() const { return origin_; }
  /// There are no more photons before this block.
  void complete(std::uint64_t block);
  /// Adds the part that begins at the block under way, of which there must be no photons here. The bits are those of one sum.
  /// Throws std::invalid_argument for parts that do not follow one another.
  void append(const Totals& later);

  /// What a part has, to be sent elsewhere, band by band.
  struct Shape {
    std::uint64_t discs = 0, origin = 0, block = 0, rays = 0, photons = 0, errors = 0;
    double largest_power = 0;
    int unit_exponent = 0;
    PhotonBlocks blocks;
  };
  [[nodiscard]] Shape shape() const;
  /// With arrays of the right sizes, to be filled by for_each_array.
  [[nodiscard]] static Totals of_shape(const Shape& shape);
  /// Of the bands behind this one.
  void set_further(std::vector<Totals> further) { further_ = std::move(further); }
  /// Calls visit(array) for all arrays that a band of a part has, always in the same order.
  template <class Visit>
  void for_each_array(const Visit& visit) {
    visit(discs_);
    visit(photon_sums_);
    for (const Subtree& subtree : subtrees()) {
      visit(level_of(subtree).power);
      visit(level_of(subtree).squares);
    }
  }

  /// Power of all rays that hit the disc, `sums` being those of the block under way.
  [[nodiscard]] double power(std::size_t disc, const DiscTotals& sums) const;
  /// Sum of the squared powers of the photons that hit the disc, times u²; `sums` as above. No photon may be under way.
  [[nodiscard]] double squares(std::size_t disc, const PhotonSums& sums) const;

  /// To be called after each search: its rays, photons and largest power.
  void add_rays(const Problem& problem);
  /// So many photons were emitted, some perhaps after the last that gave a ray. Powers are to be multiplied by `scale` (RaySource).
  void emitted(std::uint64_t photons, double scale = 1) {
    photons_ = std::max(photons_, photons);
    scale_ = scale;
    for (Totals& further : further_) further.emitted(photons, scale);
  }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] std::uint64_t photons() const { return photons_; }
  [[nodiscard]] double largest_power() const { return largest_power_; }
  /// To be called before `finish`, if other discs were met by a photon of this power.
  void set_largest_power(double power) { largest_power_ = power; }

 private:
  /// The same for one band.
  void expect_power(double largest_power);
  void append_band(const Totals& later);
  /// T(l, ·) of each disc.
  struct Level {
    std::pmr::vector<double> power;
    std::pmr::vector<double> squares;  ///< empty unless errors are kept
  };
  using Sums = std::pmr::vector<double> Level::*;
  /// A complete T(level, start / 2^level). Its left neighbour is not summed here: it is in left_, else in levels_.
  struct Subtree {
    std::uint64_t start;
    std::size_t level;
    bool left;
  };

  [[nodiscard]] Level& level_of(const Subtree& subtree) { return (subtree.left ? left_ : levels_)[subtree.level]; }
  /// The largest complete subtrees of the blocks from origin_ to block_ - 1, in their order.
  [[nodiscard]] std::vector<Subtree> subtrees() const;

  void add_subtree(Sums sums, std::size_t disc, std::uint64_t number, std::size_t level, double sum);
  void add_blocks(Sums sums, std::size_t disc, std::uint64_t from, std::uint64_t to, double sum_of_first);
  [[nodiscard]] double total(Sums sums, std::size_t disc, double block_under_way) const;

  std::pmr::vector<DiscTotals>
      discs_;  // 32 bytes each: in an aligned array, as in a Scratch, a hit touches one cache line
  std::pmr::vector<PhotonSums> photon_sums_;
  std::pmr::vector<Level> levels_;
  std::pmr::vector<Level> left_;  ///< subtrees whose left neighbour begins before origin_, by level
  bool keeps_errors_ = false;
  std::vector<Totals> further_;  ///< bands 1, 2, …
  std::optional<PhotonBlocks> blocks_;
  std::uint64_t origin_ = 0;
  std::uint64_t block_ = 0;
  std::uint64_t rays_ = 0;
  std::uint64_t photons_ = 0;
  double largest_power_ = 0;
  double scale_ = 1;
  int unit_exponent_ = 0;
};

}  // namespace detp::sim
