#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/statistics/statistics.hpp"

/// The sweep: every formula over the whole range for which it is stated, on uniform samples in a cube of side 2 or on its faces. Deviations of
/// predicted from observed counts, and their summaries.
namespace detp::validate {

/// One workload of the sweep, and the numbers of sets and lines to simulate.
struct SweepPoint {
  int dimension = 3;
  double samples = 0;     ///< n_P
  double disc_share = 0;  ///< d/r₀
  int sets = 0;           ///< independent sets of samples
  std::size_t lines = 0;  ///< isotropic lines through S₀ for each set

  [[nodiscard]] double disc_radius() const;
  [[nodiscard]] Workload workload() const;
  [[nodiscard]] std::vector<sim::Disc> discs(std::uint64_t seed, int set, const std::stop_token& stop = {}) const;

  /// The name of the point, unique in the sweep: "D=3 n=1000 d/r0=0.01".
  [[nodiscard]] std::string name() const;
};

/// All points: n_P 10³ … 10⁷, d/r₀ 10⁻⁴ … 0.2, D 2 and 3. Points with most samples come first, so that all threads
/// finish at about the same time.
[[nodiscard]] std::vector<SweepPoint> sweep_points();

/// The candidates to run on a point: sphere caches with five Q, indices and hierarchies with two resolutions, box trees
/// with five leaf sizes. Candidates with more than 10⁹ predicted tests, nodes and steps on one set are left out.
[[nodiscard]] std::vector<Candidate> sweep_candidates(const SweepPoint& point);

struct Deviation {
  int dimension = 3;
  double samples = 0;           ///< n_P
  double disc_share = 0;        ///< d/r₀
  std::string technique = {};   ///< "sphere-cache"
  std::string parameters = {};  ///< "Q 0.65, k 9"
  std::string quantity = {};    ///< name of a term of Counts, or "m_i" or "L_i" of sphere i
  std::int64_t sphere = 0;      ///< i; 0 for a term of Counts
  Form form = Form::corrected;
  double predicted = 0;
  Estimate observed = {};  ///< mean over sets of samples, with its standard error

  [[nodiscard]] double relative() const { return predicted / observed.mean - 1; }
  [[nodiscard]] double relative_error() const { return observed.standard_error / observed.mean; }
};

/// The largest relative deviations allowed.
struct Goal {
  double worst = 0;   ///< of any comparison
  double median = 0;  ///< median over the comparisons
};

/// All comparisons of one quantity of one technique with one form of the formulas.
struct DeviationSummary {
  std::string technique;
  std::string quantity;
  Form form = Form::corrected;
  Goal goal;
  std::size_t compared = 0;  ///< comparisons with a small enough standard error
  std::size_t noisy = 0;     ///< comparisons left out, because their standard error exceeds a quarter of the goal
  std::size_t beyond = 0;    ///< comparisons whose deviation exceeds goal.worst by more than three standard errors
  double median = 0;         ///< of |predicted/observed - 1|, like p95 and worst
  double p95 = 0;
  double worst = 0;
  Deviation worst_at;

  [[nodiscard]] bool met() const { return beyond == 0 && median <= goal.median; }
};

[[nodiscard]] const Fields<Deviation>& deviation_fields();
[[nodiscard]] const Fields<DeviationSummary>& summary_fields();

/// One summary for each technique, quantity and form, in the order of their first appearance.
[[nodiscard]] std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations);

/// Runs every candidate of a point on all sets of the point. Returns the comparisons of formula and count, one for each
/// form of the formulas: of each term of Counts, and of m_i (rebuilds) and L_i (mean rays in the list) of each sphere i
/// with at least 30 rebuilds. The result depends only on the point and the seed. Returns nothing if a stop was
/// requested.
[[nodiscard]] std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed,
                                                   const std::stop_token& stop);

/// The deviations of points, by name: the state in a checkpoint.
using MeasuredPoints = std::map<std::string, std::vector<Deviation>>;

/// The measurements in a checkpoint file; none if it is missing. Throws as CheckpointFile::read, also for a state that is none of a sweep.
[[nodiscard]] MeasuredPoints read_points(const CheckpointFile& file, std::stop_token stop = {});
void write_points(CheckpointFile& file, const MeasuredPoints& points);

struct SweepOptions {
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> checkpoint{};  ///< written, atomically, after each point
  bool resume = false;  ///< reuse the measurements in the checkpoint; a missing file has none
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct SweepResult {
  std::vector<Deviation> deviations;  ///< by point, in the order of the points
  std::size_t points = 0;             ///< number of requested points
  std::size_t measured = 0;           ///< number of points with results, < points if the sweep was stopped
  std::size_t resumed = 0;            ///< number of points read from the checkpoint
};

/// Measures the points in parallel, each on one thread, and starts them in their order. The same seed gives the same
/// result, whether or not the sweep was resumed. After a stop request, the result has the points that were finished.
///
/// Throws sim::FileError if the checkpoint cannot be read or written, is malformed, or was made with another seed or
/// another version of the sweep. The checkpoint is then left unchanged.
[[nodiscard]] SweepResult run_sweep(std::span<const SweepPoint> points, const SweepOptions& options = {});

/// Checks the checkpoint in the options without measuring anything. Throws as run_sweep does for the checkpoint, and
/// sim::Stopped within 0.1 s of a stop request.
void check_checkpoint(std::span<const SweepPoint> points, const SweepOptions& options);

/// Writes the comparisons as CSV: one row for each compared count, with the predictions of both forms. Counts that are
/// the same in every set and equal their prediction are left out. Predictions and observations have five digits,
/// standard errors two. Throws sim::FileError.
void write_sweep_rows(const std::string& path, const std::vector<Deviation>& deviations,
                      const std::stop_token& stop = {});

}  // namespace detp::validate
