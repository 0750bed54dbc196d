#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "ray_file.hpp"
#include "table_file.hpp"

namespace detp::sim {

/// The rays of a file, read block by block; only the numbers of the photons before every 2¹⁶ rays are kept in memory. Photons are numbered 0, 1, 2, … in
/// the order of the rays, as read_rays does.
class StoredRays final : public RaySource {
 public:
  /// Null if the rows of the file cannot be read in any order (TableFile::open), or if photons' numbers fall. Reads the whole file once; ranks, if
  /// given, share that. Throws FileError as read_rays does, and Stopped on a stop request.
  [[nodiscard]] static std::unique_ptr<const StoredRays> open(const std::string& path, const std::stop_token& stop = {},
                                                              Ranks* ranks = nullptr, const RayColumns& asked = {},
                                                              std::vector<std::string>* unused = nullptr);
  [[nodiscard]] const std::vector<BandColumn>& band_columns() const { return bands_; }

  [[nodiscard]] std::uint64_t size() const override { return file_.rows(); }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] bool numbered() const override;
  [[nodiscard]] std::size_t bands() const override { return std::max<std::size_t>(1, bands_.size()); }
  [[nodiscard]] std::uint64_t photons() const override { return photons_; }
  [[nodiscard]] std::uint64_t block_end(std::uint64_t first, std::uint64_t most,
                                        const std::stop_token& stop = {}) const override;
  [[nodiscard]] std::uint64_t first_ray_of(std::uint64_t photon) const override;
  void read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;

 private:
  StoredRays(TableFile file, std::vector<BandColumn> bands) : file_(std::move(file)), bands_(std::move(bands)) {}
  /// False if photons' numbers fall.
  [[nodiscard]] bool look_through(const std::stop_token& stop, Ranks* ranks);
  /// Calls visit(ray, number) with the photon's number of the rays first … last - 1.
  template <class Visit>
  void for_each_photon(std::uint64_t first, std::uint64_t last, const Visit& visit) const;
  [[nodiscard]] std::uint64_t photon_of(std::uint64_t ray) const;

  /// Calls visit(place in the block, row) for its rays, on several threads.
  template <class Visit>
  void for_each_row(std::uint64_t first, std::size_t count, const std::stop_token& stop, const Visit& visit) const;

  TableFile file_;
  std::vector<BandColumn> bands_;  ///< empty: one power without a name
  Box origins_;
  std::uint64_t photons_ = 0;
  std::vector<std::uint64_t> before_;  ///< number of the photon of each chunk's first ray
};

}  // namespace detp::sim
