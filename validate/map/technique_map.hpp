#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"

/// Predicts, and measures if wanted, which technique is fastest for each number of rays and each disc radius: `detp choose --map`.
namespace detp::validate {

/// The most values of an axis. In a picture of 300 points, cells of a 40th of it are still visible.
inline constexpr std::size_t most_axis_values = 40;

struct MapAxes {
  std::vector<double> rays;   ///< numbers of rays
  std::vector<Length> radii;  ///< of discs
};

/// Half decades from 100 to 300 000.
[[nodiscard]] std::vector<double> default_map_rays();

/// 0.25 %, 0.5 %, … 16 % of the scene's longest side.
[[nodiscard]] std::vector<Length> default_map_radii();

/// The axes without repeated values, numbers of rays ascending. Throws std::invalid_argument for a number of rays that
/// is not a whole number from 1 to 1e18, and for a radius <= 0; std::length_error for more than most_axis_values
/// different values of an axis.
[[nodiscard]] MapAxes checked(MapAxes axes);

struct MapRequest {
  JobRequest job = {};  ///< its number of rays and its disc radius are replaced by those of the axes
  /// an axis without values has the default ones; if a file decides, its number of rays, or its radii
  MapAxes axes = {};
  CostTable costs = {};             ///< seconds; their engine runs the candidates
  std::string costs_origin = {};    ///< "of each operation: built in, ..."
  std::optional<Rigor> rigor = {};  ///< default: a pilot where there are rays, as `choose`
  bool measure = false;             ///< run the candidates of every cell (analyse)
  int repeats = 3;                  ///< timed runs of a candidate, as AnalysisOptions
  int threads = 1;                  ///< most threads, of pilots and of runs
  std::vector<Technique> disabled = {};
  std::optional<std::filesystem::path> checkpoint = {};  ///< keeps the measured cells
  bool resume = false;                                   ///< takes cells from the checkpoint; a missing file has none
};

/// How a measured cell compares with its prediction.
struct CellVerdict {
  bool agrees = false;        ///< the predicted technique was the fastest measured one
  double slower = 0;          ///< measured time of the predicted choice / shortest measured time, minus 1
  bool within_noise = false;  ///< the ranges of the two times, median ± half range, overlap
};

struct MapCell {
  double rays = 0;
  std::optional<Choice> choice = {};      ///< nothing if a stop request came before
  std::optional<Analysis> analysis = {};  ///< complete; nothing if the cell was not measured
  Candidate paper = {};                   ///< of the paper's rule (model::paper_rule)

  /// The candidate that is chosen; null if it is not known.
  [[nodiscard]] const Candidate* predicted() const { return choice ? &choice->best().candidate : nullptr; }
  /// The fastest measured candidate; null if the cell was not measured.
  [[nodiscard]] const Analysed* fastest() const { return analysis ? analysis->fastest() : nullptr; }
  /// Nothing if the cell was not measured.
  [[nodiscard]] std::optional<CellVerdict> verdict() const;
};

/// The cells of one disc radius.
struct MapRow {
  Length given;                ///< as in the axes; the radius itself if it comes from a file
  Workload workload;           ///< with the most rays
  double x = 0;                ///< X = distance between neighbouring samples / d
  std::vector<MapCell> cells;  ///< by number of rays, ascending
};

/// A cell with its row; both belong to a map.
struct PlacedCell {
  const MapRow* row;
  const MapCell* cell;
};

struct TechniqueMap {
  std::string name;  ///< of the scene, as Job::name
  sim::Field field = sim::Field::isotropic;
  std::vector<double> rays;           ///< axis, ascending
  std::vector<MapRow> rows;           ///< by disc radius, ascending
  std::vector<std::string> notices;   ///< of the jobs, each once
  std::vector<std::string> warnings;  ///< of the jobs, each once
  std::string costs_origin;
  double predicting_seconds = 0;  ///< for scenes, rays and predictions
  double measuring_seconds = 0;
  std::optional<sim::Progress> stopped;  ///< if a stop request ended the map early

  /// By row, then by number of rays.
  [[nodiscard]] std::vector<PlacedCell> cells() const;
};

/// The map of the requested scene, files or numbers.
///
/// A row's rays are made once, as many as its last cell needs; a cell has the first of them. So each cell has the rays
/// that `choose` makes for it. After all predictions the cells are measured, those with the shortest predicted time first, so that
/// a stop request leaves out the most expensive ones.
///
/// Throws as make_job and choose; std::invalid_argument for axes out of range and for Rigor::structural;
/// std::length_error for axes that are too long, and if the rays of all rows, which measuring keeps, do not fit in
/// memory; sim::FileError for a checkpoint that cannot be written, is damaged, or was made with other inputs or choices. Does not throw
/// Stopped: after a stop request, the map has the rows so far, maybe none.
[[nodiscard]] TechniqueMap answer(const MapRequest& request, const std::stop_token& stop = {},
                                  const sim::ReportPhase& progress = {});

/// The choice for one cell of a map. Throws as choose, and std::invalid_argument if predicted times are 0 or not finite.
[[nodiscard]] Choice choose_for_cell(const Question& question, const CostTable& costs);

}  // namespace detp::validate
