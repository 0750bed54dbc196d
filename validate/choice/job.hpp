#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/technique/technique.hpp"

/// From what a user names (numbers, a scene, files) to rays, discs and the workload they are.
namespace detp::validate {

/// A length in scene units, or a share of the scene's longest side.
struct Length {
  double value = 0;
  bool relative = false;  ///< value is a share of the scene's longest side: "4%" is 0.04
};

/// Reads "0.02" or "4%". Throws std::invalid_argument for anything else, and for what is not > 0 and finite.
[[nodiscard]] Length parse_length(std::string_view text);

/// What is asked for. Whatever is not given is chosen, and told in the job.
struct JobRequest {
  std::optional<std::string> scene;      ///< built-in name or mesh file
  std::optional<std::string> disc_file;  ///< instead of a scene's samples
  std::optional<std::string> ray_file;   ///< instead of photon paths or isotropic lines
  std::optional<double> rays;            ///< default 100 000
  std::optional<double> samples;         ///< default: the scene's vertices; numbers alone need it
  std::optional<Length> disc_radius;     ///< default: half the distance between samples; numbers alone need it
  std::optional<double> sphere_radius;   ///< numbers alone: r₀, or …
  std::optional<double> scene_side;      ///< … s
  std::optional<double> dimension;       ///< default: measured; numbers alone: 3
  std::optional<double> sample_extent;
  std::optional<sim::Field> field;
  bool front_facing = false;
  std::uint64_t seed = 1;
  /// Only the workload is wanted: of more rays than a block (sim::default_block), only the first block is made, and the
  /// workload is measured on it. Not for rays from a file.
  bool workload_only = false;
  bool stream = false;  ///< rays that can be made by their number stay out of memory if they fill more than a block

  /// Neither a scene nor a file: a workload in numbers.
  [[nodiscard]] bool numbers_alone() const { return !scene && !disc_file && !ray_file; }
};

/// The workload of numbers alone. r₀ and s give each other: r₀ = s√3/2 + d.
/// Throws std::invalid_argument where a number is missing or out of range.
[[nodiscard]] Workload workload_of_numbers(const JobRequest& request);

/// What the samples of a workload of numbers are called: "uniform samples in a cube", or "… on the faces of a cube".
[[nodiscard]] std::string_view name_of_numbers(const Workload& workload);

/// Rays and discs, with what is known of them.
struct Job {
  std::string name;  ///< "@tree", a file, or "uniform samples in a cube"
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;                    ///< all of them, none if they are a stream; see workload_only
  std::unique_ptr<const sim::RaySource> stream;  ///< makes rays by their number; null if they are in memory
  sim::Field field = sim::Field::isotropic;
  std::size_t triangles = 0;
  Workload workload;  ///< measured on discs and rays (the path length of a stream on its first block)
  sim::Notices notices;
  std::vector<std::string> warnings;  ///< few discs or rays that spoil what the workload says of all (outliers.hpp)
  bool front_facing = false;
  double read_seconds = 0;  ///< reading or making scene and rays

  /// The problem; borrows from this job. Throws std::invalid_argument where the rays are a stream.
  [[nodiscard]] sim::Problem problem(int threads = 1, const std::stop_token& stop = {}) const {
    return sim::make_problem(rays, discs, front_facing, threads, stop);
  }
};

/// Opens, makes and measures what was asked for. Throws sim::FileError and std::invalid_argument as the parts do.
/// Throws sim::Stopped within 0.1 s of a stop request.
[[nodiscard]] Job make_job(const JobRequest& request, std::stop_token stop = {});

}  // namespace detp::validate
