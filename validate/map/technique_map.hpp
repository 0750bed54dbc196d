#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/progress.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/choice.hpp"
#include "map_axes.hpp"

/// Predicts, and measures if wanted, which technique is fastest for each number of rays and each disc radius.
namespace detp::validate {

struct MapCell {
  double rays = 0;
  std::optional<Choice> choice = {};      ///< nothing if a stop request came before
  std::optional<Analysis> analysis = {};  ///< complete; nothing if the cell was not measured
  Candidate paper = {};                   ///< of the paper's rule (model::paper_rule)
};

/// The cells of one disc radius.
struct MapRow {
  Length given;                ///< as in the axes; the radius itself if it comes from a file
  Workload workload;           ///< with the most rays
  double x = 0;                ///< X = distance between neighbouring samples / d
  std::vector<MapCell> cells;  ///< by number of rays, ascending
};

struct TechniqueMap {
  std::string name;  ///< of the scene, as Job::name
  sim::Field field = sim::Field::isotropic;
  std::vector<double> rays;           ///< axis, ascending
  std::vector<MapRow> rows;           ///< by disc radius, ascending
  std::vector<std::string> notices;   ///< of the jobs, each once
  std::vector<std::string> warnings;  ///< of the jobs, each once
  double predicting_seconds = 0;      ///< for scenes, rays and predictions
  double measuring_seconds = 0;
  std::optional<sim::Progress> stopped;  ///< if a stop request ended the map early
};

struct MapOptions {
  CostTable costs;                  ///< seconds; their engine runs the candidates
  std::optional<Rigor> rigor = {};  ///< default: a pilot where there are rays, as `choose`
  bool measure = false;             ///< run the candidates of every cell (analyse)
  int repeats = 3;                  ///< timed runs of a candidate, as AnalysisOptions
  int threads = 1;                  ///< most threads, of pilots and of runs
  std::vector<Technique> disabled = {};
  std::optional<std::filesystem::path> checkpoint = {};  ///< keeps the measured cells
  bool resume = false;                                   ///< takes cells from the checkpoint; a missing file has none
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

/// The map of the requested scene, files or numbers. The number of rays and the disc radius of the request are replaced
/// by those of the axes; empty axes leave them as they are.
///
/// A row's rays are made once, as many as its last cell needs; a cell has the first of them. So each cell has the rays
/// that `choose` makes for it. After all predictions the cells are measured, those with the shortest predicted time first, so that
/// a stop request leaves out the most expensive ones.
///
/// Throws as make_job and choose; std::invalid_argument for axes out of range and for Rigor::structural;
/// std::length_error for axes that are too long, and if the rays of all rows, which measuring keeps, do not fit in
/// memory; sim::FileError for a checkpoint that cannot be written, is damaged, or was made with other inputs or choices. Does not throw Stopped: after a stop request, the map has the rows so far, maybe none.
[[nodiscard]] TechniqueMap make_map(const JobRequest& request, const MapAxes& axes, const MapOptions& options);

/// The choice for one cell of a map. Throws as choose, and std::invalid_argument if predicted times are 0 or not finite.
[[nodiscard]] Choice choose_for_cell(const Question& question, const CostTable& costs);

}  // namespace detp::validate
