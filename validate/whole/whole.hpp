#pragma once

#include <optional>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/job/job.hpp"

/// The whole wait of a command that searches once, and its peak memory.
namespace detp::validate {

/// Seconds by part.
struct WholeSeconds {
  double read = 0;   ///< files or built-in scene, with vertices, samples and discs
  double trace = 0;  ///< making rays: what traces photons, photon paths or lines
  double prepare =
      0;              ///< choosing, sorting the discs and building the index; with counts in JSON, evidence for effects
  double search = 0;  ///< checking rays and discs, and the search
  double rest = 0;    ///< starting the program, and writing
  [[nodiscard]] double total() const { return read + trace + prepare + search + rest; }
};

/// Both, predicted or measured.
struct Whole {
  WholeSeconds seconds;
  std::optional<double> peak_bytes;
};

/// What both depend on.
struct WholeInputs {
  double text_bytes = 0;    ///< of files
  double binary_bytes = 0;  ///< of files
  double triangles = 0;
  double discs = 0;
  double rays = 0;
  double rays_in_memory = 0;  ///< at a time
  double bands = 1;           ///< of powers
  bool traced = false;        ///< rays are photon paths, traced here
  bool from_file = false;
  double piece_seconds = 0;  ///< to trace a piece on one thread, as sim::SurfaceFacts
};

/// Adds the size of a file by its format; nothing for a built-in scene.
void add_file(const std::optional<std::string>& path, WholeInputs& inputs);

/// `rays`: of the search. The job may have fewer, as that of `choose`.
[[nodiscard]] WholeInputs whole_inputs(const JobRequest& request, const Job& job, double rays);

/// By AccuracyCosts; tracing by `piece_seconds` if it is known. `search`: of a first search on `threads` threads, checking included; `pilot`: rays that choosing looks at, 0 without.
[[nodiscard]] WholeSeconds whole_seconds(const WholeInputs& inputs, const CostBreakdown& search, double pilot,
                                         int threads);

/// Bytes that are in memory at the same time at most: of the program, mesh and what traces photons, discs, rays, and of the search
/// (Counts::bytes_touched). Eight meshes and seven built-in scenes, 10³ to 4·10⁶ pieces of paths, box trees, AMD EPYC (Zen 5), with the allocator that
/// the command is linked with.
[[nodiscard]] double peak_bytes(const WholeInputs& inputs, double bytes_touched);

/// The peak of this process so far; nothing if the system does not say.
[[nodiscard]] std::optional<double> measured_peak_bytes();

}  // namespace detp::validate
