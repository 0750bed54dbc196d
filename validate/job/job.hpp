#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/geometry/disc_source.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/rays/mixed_field.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/search/disc_summary.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/digest.hpp"

/// Makes rays, discs and their workload from what a user specifies: numbers, a scene, or files.
namespace detp::validate {

/// A length in scene units, or a share of the scene's longest side.
struct Length {
  double value = 0;
  bool relative = false;  ///< value is a share of the scene's longest side: "4%" is 0.04
  bool operator==(const Length&) const = default;
};

/// Reads "0.02" or "4%". Throws std::invalid_argument for anything else, and unless the length is > 0 and finite.
[[nodiscard]] Length parse_length(std::string_view text);

inline constexpr double rays_by_default = 100'000;

/// Number of rays of a stream on which its workload is measured. The evidence for effects looks at some of them (EvidenceEffort).
inline constexpr std::uint64_t rays_of_workload = std::uint64_t{1} << 16;

/// The user's request. Values that are not set get the default below; the job has all values.
struct JobRequest {
  std::optional<std::string> scene;      ///< built-in name or mesh file
  std::optional<std::string> disc_file;  ///< instead of a scene's samples
  std::optional<std::string> ray_file;   ///< instead of photon paths or isotropic lines
  std::vector<sim::BandColumn>
      bands;  ///< of powers, and their columns in the ray file; default: power_NAME, if there are such columns
  std::vector<sim::ColumnName> columns;  ///< other names in the ray file and the disc file
  bool landed = false;                   ///< the ray file has where photons landed in the scene (sim::make_pieces)
  /// rays of a file get the triangles of the scene on which their photons landed (sim::land)
  bool landings = false;
  bool rgb = false;  ///< photon paths carry red, green and blue, by the colours of materials
  /// default 100 000; of photon paths at least so many, to the end of the last photon's path
  std::optional<double> rays;
  std::optional<double> samples;        ///< default: one for each vertex of the scene; required without a scene
  std::optional<Length> disc_radius;    ///< default: half the distance between samples; required without a scene
  std::optional<double> sphere_radius;  ///< r₀, without a scene; either this or scene_side is required
  std::optional<double> scene_side;     ///< s, without a scene
  std::optional<double> dimension;      ///< default: measured; without a scene: 3
  std::optional<double> sample_extent;
  std::optional<sim::Field> field;
  sim::FieldShares shares = {1.0 / 3, 1.0 / 3, 1.0 / 3};  ///< of a mixed field
  std::vector<sim::LightKind> lights;  ///< default: the scene's own; in a mesh file without lights an area light
  std::optional<double> crease;        ///< degrees, of a scene: sim::SceneRequest::crease
  std::optional<sim::Up> up;           ///< default: y in built-in scenes, found from the shape in mesh files
  bool front_facing = false;
  /// photon paths go on to the second surface that they meet, as in the paper (§2.1)
  bool second_intersection = false;
  sim::EffectSelection effects;  ///< that the workload has, and that photon paths are made with
  std::uint64_t seed = 1;
  /// True if only the workload is needed. If there are more rays than a block (sim::default_block), then only the first
  /// rays_of_workload are made, and the workload is measured on these. Has no effect on rays from a file.
  bool workload_only = false;
  /// The rays are for a search for pairs. Photon paths come with their photons' powers and a scale. If the rays are not from a file, and fill more than a block, do not fit in memory beside the discs and an index, or are
  /// shared by ranks (more than rays_of_workload), they are not kept in memory
  bool stream = false;
  /// discs of a file that do not fit in memory stay there if they can be read in any order, and the rays are a stream
  bool store_discs = false;
  /// discs in a scene alone, for estimators that trace no photons: options that make or change rays are refused
  bool without_rays = false;
  bool keep_scene = false;  ///< the job keeps the scene: for estimators that look at triangles, and for more_rays
  bool in_batches = false;  ///< its photon paths are the first of many batches, with those of more_rays
  int threads = 1;          ///< for checking rays and discs; 0: all cores
  /// that make the same job together, counting the photons of a stream; null: this process alone
  sim::Ranks* ranks = nullptr;

  /// True if the request has neither a scene nor a file, only the numbers of a workload.
  [[nodiscard]] bool numbers_alone() const { return !scene && !disc_file && !ray_file; }
};

/// The workload of a request without scene and files. r₀ and s follow from each other: r₀ = s√3/2 + d. Throws
/// std::invalid_argument if a number is missing or out of range.
[[nodiscard]] Workload workload_of_numbers(const JobRequest& request);

/// Samples of a workload without a scene are on the faces of a cube, not in its volume.
[[nodiscard]] bool on_faces(const Workload& workload);

/// The name of a workload without a scene: "uniform samples in a cube", or "… on the faces of a cube".
[[nodiscard]] std::string_view name_of_numbers(const Workload& workload);

/// How a job's workload is measured.
struct Measuring {
  sim::EffectSelection effects = {};
  sim::EvidenceEffort effort = {};
  std::optional<double> dimension = {};  ///< instead of the measured one
  std::optional<double> sample_extent = {};
  int threads = 1;  ///< for checking the first rays of a stream
  std::stop_token stop = {};
};

struct Job {
  std::string name;                                     ///< "@tree", a file, or "uniform samples in a cube"
  std::vector<sim::Disc> discs;                         ///< if they are stored: every k-th
  std::unique_ptr<const sim::DiscSource> stored_discs;  ///< all discs; null if they are in memory
  sim::DiscSummary stored_summary = {};                 ///< of all
  std::vector<std::uint32_t> vertices;  ///< of the scene's file, one for each disc; empty: discs are not at vertices
  std::vector<sim::Ray> rays;           ///< all rays; empty if they are a stream; see workload_only
  std::vector<std::uint64_t> photons;   ///< numbers of the rays' photons, as in sim::PathRays
  std::vector<double> landings;         ///< where the photons met a surface, as in sim::PathRays
  std::vector<std::uint32_t> triangles_met = {};     ///< as sim::PathRays::triangles
  std::vector<double> further = {};                  ///< powers in bands 1, 2, …, as in sim::FurtherPowers
  std::vector<std::string> bands = {};               ///< names of all bands; empty: one power without a name
  std::uint64_t photon_count = 0;                    ///< photons emitted; 0: one for each ray
  double power_scale = 1;                            ///< PathRays::scale of the rays
  std::vector<std::uint32_t> file_order;             ///< as sim::RayFile::order
  std::unique_ptr<const sim::RaySource> stream;      ///< makes ray number i for any i; null if all rays are in memory
  const sim::PhotonSource* photon_stream = nullptr;  ///< the same, if it traces photons, perhaps as they are read
  sim::Field field = sim::Field::isotropic;
  sim::FieldShares shares = {};  ///< of a mixed field
  std::uint64_t seed = 1;
  std::size_t triangles = 0;
  std::shared_ptr<sim::Scene> scene = {};             ///< if it was to be kept
  std::shared_ptr<const sim::RayCaster> caster = {};  ///< of photon paths, if the scene was to be kept
  std::vector<sim::Light> lights;                     ///< of the scene
  bool lights_placed = false;                         ///< not the scene's own
  sim::Up up;                                         ///< by which they were placed
  Workload given;             ///< without effects: numbers of rays and discs, sizes; known without measuring
  sim::SurfaceFacts surface;  ///< of the scene's mesh
  std::optional<sim::LightLedger> light = {};  ///< of photon paths that were traced; of a stream, before it is read
  sim::PolygonCounts polygons = {};            ///< of the scene's mesh
  std::uint64_t normals_made = 0;              ///< Mesh::normals_made
  std::uint64_t coincident = 0;                ///< Mesh::coincident
  std::optional<Workload> numbers =
      {};  ///< of a workload in numbers: S₀ and box are its own, not those around the discs
  sim::Notices notices;
  /// warnings about light that is lost (sim/photons/light_ledger.hpp; of a stream, its reader has them), and about a few discs or rays that distort the workload (outliers.hpp)
  std::vector<std::string> warnings;
  bool front_facing = false;
  bool rays_from_file = false;
  bool without_rays = false;
  double read_seconds = 0;   ///< time for reading or making the scene and the discs, and for reading rays from a file
  double trace_seconds = 0;  ///< time for making rays: tracing photons, or drawing lines
  double check_seconds = 0;  ///< time for checking rays and discs, and for S₀
  Measuring measuring = {};

  [[nodiscard]] std::size_t disc_count() const {
    return stored_discs ? static_cast<std::size_t>(stored_discs->size()) : discs.size();
  }
  /// The first `count` rays of a field that needs no scene. Throws as sim::enclosing_sphere.
  [[nodiscard]] std::unique_ptr<const sim::RaySource> field_rays(std::uint64_t count,
                                                                 const std::stop_token& stop = {}) const;
  /// Checks rays and discs, as sim::make_problem, and sets `given`; `make_job` has done so. Rays and discs must not change afterwards.
  void check_problem(int threads = 1, const std::stop_token& stop = {});
  /// Further rays of the same kind, at least so many, to the end of the last photon's path. Lines are those that follow the first `made` of the
  /// field, of which the job's own are the beginning. Photon paths are independent of the job's own, and of those of other batches. Throws std::invalid_argument for rays of a file, and for
  /// photon paths without keep_scene; sim::Stopped on a stop request.
  [[nodiscard]] sim::TracedPaths more_rays(std::uint64_t made, std::uint64_t batch, std::size_t rays,
                                           const std::stop_token& stop = {}) const;
  /// Measured on discs and rays (of a stream on rays_of_workload: its first, or pieces of a whole file) when it is first asked for; not for use from several threads. Throws
  /// as sim::observe, sim::Stopped on the stop request of `measuring`, and std::invalid_argument as check(Workload).
  /// Without rays: `given`, and no effects.
  [[nodiscard]] const Workload& workload() const;
  /// The effects, and what finding them cost; as workload().
  [[nodiscard]] const sim::Observed& observed() const;
  /// The problem. It refers to this job's rays and discs; moving the job does not change that. Throws std::invalid_argument
  /// if the rays are a stream.
  [[nodiscard]] const sim::Problem& problem() const;
  /// Notices and warnings.
  [[nodiscard]] std::vector<std::string> all_said() const {
    std::vector<std::string> all = notices;
    all.insert(all.end(), warnings.begin(), warnings.end());
    return all;
  }
  [[nodiscard]] sim::PathRays paths() const {
    sim::PathRays all(rays, photons, landings, photon_count, triangles_met);
    all.further = {further, bands.empty() ? 0 : bands.size() - 1};
    all.scale = power_scale;
    return all;
  }
  /// Rays have the numbers of their photons. If not, each is taken for a photon of its own.
  [[nodiscard]] bool numbered() const { return stream ? stream->numbered() : !photons.empty(); }
  /// Photons of all rays, independent of one another.
  [[nodiscard]] std::uint64_t independent_photons() const {
    return stream ? stream->photons() : numbered() ? std::max(photon_count, photons.back() + 1) : rays.size();
  }

 private:
  void measure() const;
  /// In place of what the discs alone would say.
  void take_numbers(Workload& workload) const;

  std::optional<sim::Problem> problem_;
  mutable std::optional<sim::Observed> observed_;  ///< of all rays, or of some of a stream
  mutable Workload workload_;
};

/// Rays of a job's kind that a run has taken.
struct RaysTaken {
  double rays = 0;
  double photons = 0;
  std::optional<sim::LightLedger> light = {};  ///< of photons that were traced for it
};

/// Makes what is requested; nothing is measured yet. Throws sim::FileError for a bad file, std::invalid_argument for a bad request,
/// std::length_error if the rays or samples would not fit in memory, and sim::Stopped within 0.1 s of a stop request.
[[nodiscard]] Job make_job(const JobRequest& request, std::stop_token stop = {}, const sim::ReportPhase& progress = {});

void add(std::span<const sim::Disc> discs, Digest& digest);
void add(std::span<const sim::Ray> rays, Digest& digest);

/// Of discs, of the rays in memory with the numbers of their photons, and of the seed: jobs with the same digest find the same.
[[nodiscard]] std::string digest_of(const Job& job);

}  // namespace detp::validate
