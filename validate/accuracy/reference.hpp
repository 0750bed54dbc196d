#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/search/index.hpp"
#include "error_split.hpp"
#include "judged_samples.hpp"

/// The irradiance that estimates are judged by, and files that keep it.
namespace detp::validate {

enum class ReferenceKind {
  known,     ///< a closed form
  backward,  ///< by backward paths, which blur nothing (sim/reference)
  both       ///< by backward paths, and by photons the light that they miss
};

[[nodiscard]] std::string_view name(ReferenceKind kind);

struct Reference {
  std::string scene;
  ReferenceKind kind = ReferenceKind::known;
  JudgedSamples judged;
  std::vector<double> irradiance;
  std::vector<double> variance;
  std::uint64_t paths = 0;    ///< backward paths of each sample, on each side
  std::uint64_t photons = 0;  ///< for the light that backward paths miss
  double seconds = 0;
  bool stopped = false;           ///< by a stop request, or the time limit: the error is larger than asked for
  Estimate missed_squared = {};   ///< mean square of the light that backward paths miss, relative to B²
  double missed_mean = 0;         ///< mean of it, relative to the mean irradiance
  double casts_per_path = 0;      ///< rays that a path casts, with those of the other side
  double path_noise_squared = 0;  ///< noise² of one backward path for each sample, on each side, relative to B²

  [[nodiscard]] ReferenceValues values() const {
    const auto samples = static_cast<double>(judged.samples.size());
    return {irradiance, variance, judged.weights, samples / static_cast<double>(judged.population)};
  }
  /// Mean square irradiance B².
  [[nodiscard]] double mean_square() const;
  /// Root mean square standard error, relative to B.
  [[nodiscard]] double error() const;
};

struct ReferenceOptions {
  std::size_t samples = 2000;  ///< at most so many of the scene's, a random subset
  std::uint64_t seed = 1;
  double error = 0.01;      ///< stops at this Reference::error
  double seconds = 60;      ///< or after this time
  double patch_radius = 0;  ///< of the photons that count; 0: an eighth of the mean edge of the triangles
  bool front_facing = false;
  int threads = 0;  ///< 0: all cores
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

/// Makes a reference bit by bit. The light that backward paths miss is that of photons on the surfaces within r of a sample, and 2r with
/// the same photons, extrapolated to no radius as if the blur grew in proportion: 2 E(r) - E(2r). Blur that both radii share is not seen.
class ReferenceMaker {
 public:
  /// At these samples of the scene, which must outlive this. Throws as sim::BackwardPaths.
  ReferenceMaker(const sim::Scene& scene, JudgedSamples judged, const ReferenceOptions& options,
                 std::shared_ptr<const sim::RayCaster> caster = {});

  /// Adds paths until each sample has so many. Throws sim::Stopped if a stop request came before each sample has some.
  void add_paths(std::uint64_t paths);
  /// If backward paths miss light: adds batches of so many photons, at least four of them before the reference is complete; in place of
  /// those before if these are larger. Throws sim::Stopped.
  void add_photons(std::uint64_t photons, int batches);
  [[nodiscard]] bool misses_light() const { return misses_light_; }

  /// With all that was added.
  [[nodiscard]] const Reference& reference();

 private:
  /// The missed light of one batch at the samples.
  [[nodiscard]] std::vector<double> missed_by_photons(std::uint64_t photons);
  [[nodiscard]] std::vector<double> within(const sim::Paths& missed, double radius);

  const sim::Scene& scene_;
  ReferenceOptions options_;
  std::shared_ptr<const sim::RayCaster> caster_;
  sim::BackwardPaths walk_;
  bool misses_light_;
  std::vector<sim::PathSums> sums_;
  std::vector<std::vector<double>> missed_;  ///< by each batch
  std::uint64_t photons_of_batch_ = 0;
  std::uint64_t batches_made_ = 0;
  std::unique_ptr<const sim::Index> surfaces_;
  double missed_bound_ = 0;  ///< of missed_share: one-sided, of all light
  Reference reference_;
};

/// A scene's known irradiance, or what ReferenceMaker finds until the error is small enough. Throws std::invalid_argument for a scene without
/// triangles or lights, and options out of range; sim::Stopped if a stop request came before each sample had a value.
[[nodiscard]] Reference make_reference(const sim::Scene& scene, const ReferenceOptions& options = {});

/// References take minutes, so they are kept in files. What a reference depends on: a file is only used where all of this is the same.
struct ReferenceKey {
  std::string scene;          ///< a digest of mesh, materials and lights, 16 hexadecimal digits
  bool front_facing = false;  ///< light that arrives from behind does not count
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  int version = 0;  ///< of the methods of make_reference

  bool operator==(const ReferenceKey&) const = default;
};

[[nodiscard]] ReferenceKey reference_key(const sim::Scene& scene, const ReferenceOptions& options);

/// Throws sim::FileError.
void write_reference(const std::string& path, const Reference& reference, const ReferenceKey& key);

/// Throws sim::FileError for a file that cannot be read, is malformed, or is of another scene or other options; it says what differs.
[[nodiscard]] Reference read_reference(const std::string& path, const sim::Scene& scene,
                                       const ReferenceOptions& options);

/// Reads the file. If there is none, makes the reference and writes the file; a reference that a stop request cut short is not
/// written, one that reached its time limit is. Throws as read_reference and make_reference.
[[nodiscard]] Reference kept_reference(const std::string& path, const sim::Scene& scene,
                                       const ReferenceOptions& options = {});

}  // namespace detp::validate
