#include "technique_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/base/digest.hpp"
#include "detp/validate/job/job.hpp"
#include "map_checkpoint.hpp"

namespace detp::validate {
namespace {

void require_few(std::string_view what, std::size_t values) {
  if (values > most_axis_values)
    throw std::length_error(fmt::format("a map has room for {} {}, not for {}: give at most {}, or make several maps",
                                        most_axis_values, what, values, most_axis_values));
}

/// Unless the list has it.
template <class T>
void add_new(std::vector<T>& list, const T& one) {
  if (std::ranges::find(list, one) == list.end()) list.push_back(one);
}

class MapMaker {
 public:
  MapMaker(const MapRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress)
      : request_(request), stop_(stop), progress_(progress), job_(request.job), axes_(request.axes) {
    if (request.rigor == Rigor::structural)
      throw std::invalid_argument("a map is predicted by a pilot or by closed forms, not by structures");
    if (job_.numbers_alone() && request.rigor == Rigor::pilot)
      throw std::invalid_argument("a pilot needs rays: name a scene or files, or estimate by closed forms");
    if (axes_.rays.empty() && !job_.ray_file) axes_.rays = default_map_rays();
    if (axes_.radii.empty() && !job_.disc_file) axes_.radii = default_map_radii();
    axes_ = checked(std::move(axes_));
    job_.workload_only = !request.measure;
    if (!axes_.rays.empty()) job_.rays = axes_.rays.back();
    map_.costs_origin = request.costs_origin;
  }

  TechniqueMap make() {
    predict_all();
    if (request_.measure && !map_.stopped) measure_all();
    for (Made& one : made_) map_.rows.push_back(std::move(one.row));
    return std::move(map_);
  }

 private:
  struct Made {
    MapRow row;
    Job job;  ///< empty unless cells will be measured
  };

  static constexpr double share_of_predicting = 0.1;  // of a map that is measured; a guess

  void predict_all() {
    const sim::Stopwatch watch;
    const std::size_t rows = std::max<std::size_t>(1, axes_.radii.size());
    if (request_.measure && !job_.ray_file && !axes_.rays.empty())
      sim::require_memory(fmt::format("a map of {} disc radii with up to {:g} rays", rows, axes_.rays.back()),
                          static_cast<double>(rows) * axes_.rays.back() * sizeof(sim::Ray));
    try {
      for (std::size_t i = 0; i < rows; ++i) predict_row(i, rows);
    } catch (const sim::Stopped&) {
      const std::size_t done = predicted();
      const std::size_t columns = std::max<std::size_t>(1, axes_.rays.size());
      if (made_.back().row.cells.empty()) made_.pop_back();
      map_.stopped = {done, rows * columns, "cells predicted"};
    }
    map_.predicting_seconds = watch.seconds();
    const auto radius = [](const Made& one) { return one.row.workload.disc_radius; };
    std::ranges::stable_sort(made_, {}, radius);
    const auto same = [&](const Made& one, const Made& other) { return radius(one) == radius(other); };
    made_.erase(std::unique(made_.begin(), made_.end(), same), made_.end());
  }

  void predict_row(std::size_t number, std::size_t rows) {
    if (!axes_.radii.empty()) job_.disc_radius = axes_.radii[number];
    const double end = request_.measure ? share_of_predicting : 1;
    const auto share = [&](std::size_t i) { return end * static_cast<double>(i) / static_cast<double>(rows); };
    Made& made = made_.emplace_back();
    const bool only_numbers = job_.numbers_alone() && !request_.measure;
    if (only_numbers) {
      made.row.workload = workload_of_numbers(job_);
      map_.name = name_of_numbers(made.row.workload);
    } else {
      made.job = make_job(job_, stop_, sim::part_of(progress_, share(number), share(number + 1)));
      made.row.workload = made.job.workload();
      map_.name = made.job.name;
      map_.field = made.job.field;
      for (const std::string& notice : made.job.notices) add_new(map_.notices, notice);
      for (const std::string& warning : made.job.warnings) add_new(map_.warnings, warning);
    }
    MapRow& row = made.row;
    row.given = axes_.radii.empty() ? Length{row.workload.disc_radius} : axes_.radii[number];
    row.x = sample_distance(row.workload) / row.workload.disc_radius;
    if (map_.rays.empty()) map_.rays = axes_.rays.empty() ? std::vector{row.workload.rays} : axes_.rays;
    for (const double rays : map_.rays)
      row.cells.push_back({.rays = rays, .paper = model::paper_rule(with(row, rays))});
    for (MapCell& cell : row.cells) cell.choice = predict(only_numbers ? nullptr : &made.job, with(row, cell.rays));
    if (!request_.measure) made.job = {};
  }

  [[nodiscard]] static Workload with(const MapRow& row, double rays) {
    Workload workload = row.workload;
    workload.rays = rays;
    return workload;
  }

  /// The cell's problem: the job's first rays.
  [[nodiscard]] sim::Problem problem_of(const Job& job, double rays) const {
    const auto first = static_cast<std::size_t>(std::min(rays, static_cast<double>(job.rays.size())));
    return sim::make_problem(std::span(job.rays).first(first), job.discs, job.front_facing, request_.threads, stop_);
  }

  /// `job` is null if only numbers are known.
  [[nodiscard]] Choice predict(const Job* job, const Workload& workload) const {
    std::optional<sim::Problem> problem;
    if (job != nullptr) problem = problem_of(*job, workload.rays);
    Question question{.problem = problem ? &*problem : nullptr,
                      .ray_count = workload.rays,
                      .workload = workload,
                      .rigor = request_.rigor,
                      .threads = request_.threads,
                      .disabled = request_.disabled,
                      .stop = stop_};
    if (!question.rigor && job_.numbers_alone()) question.rigor = Rigor::estimate;
    return choose_for_cell(question, request_.costs);
  }

  [[nodiscard]] std::size_t predicted() const {
    std::ptrdiff_t cells = 0;
    for (const Made& one : made_) cells += std::ranges::count_if(one.row.cells, &MapCell::predicted);
    return static_cast<std::size_t>(cells);
  }

  void measure_all() {
    struct Place {
      MapCell* cell;
      const Job* job;
      double seconds;  // predicted
    };
    const sim::Stopwatch watch;
    std::vector<Place> places;
    double all = 0;
    for (Made& one : made_)
      for (MapCell& cell : one.row.cells) {
        constexpr double least = 1e-3;  // a guess; for progress only
        places.push_back({&cell, &one.job, std::max(least, cell.choice->best().seconds())});
        all += places.back().seconds;
      }
    std::ranges::stable_sort(places, {}, &Place::seconds);
    std::optional<MapCheckpoint> kept;
    try {
      kept = checkpoint();
    } catch (const sim::Stopped&) {
      map_.stopped = {0, places.size(), "cells measured"};
      return;
    }
    double before = 0;
    std::size_t done = 0;
    const auto share = [&](double seconds) { return share_of_predicting + (1 - share_of_predicting) * seconds / all; };
    for (const Place& place : places) {
      const std::string name = fmt::format("{} rays, radius {}", place.cell->rays, place.job->given.disc_radius);
      if (kept) place.cell->analysis = kept->find(name, place.cell->choice->candidates);
      if (!place.cell->analysis)
        measure(place.job, *place.cell, sim::part_of(progress_, share(before), share(before + place.seconds)));
      if (kept && place.cell->analysis) kept->add(name, *place.cell->analysis);
      if (stop_.stop_requested()) break;
      before += place.seconds;
      ++done;
    }
    if (kept) kept->write();
    if (done < places.size()) map_.stopped = {done, places.size(), "cells measured"};
    map_.measuring_seconds = watch.seconds();
  }

  /// Of this map's cells, whose rays, discs and choices are known; read if the map is resumed.
  [[nodiscard]] std::optional<MapCheckpoint> checkpoint() const {
    if (!request_.checkpoint) return std::nullopt;
    Digest jobs;
    std::string choices;
    for (const Made& one : made_) {
      jobs.add(digest_of(one.job));
      for (const MapCell& cell : one.row.cells) choices += title(*cell.predicted()) + "; ";
    }
    std::string disabled;
    for (const Technique technique : request_.disabled) disabled += fmt::format("{} ", name(technique));
    MapCheckpoint kept(*request_.checkpoint, {{"digest of rays and discs", jobs.text()},
                                              {"choices", choices},
                                              {"engine", name(request_.costs.engine)},
                                              {"runs of each candidate", request_.repeats},
                                              {"threads", request_.threads},
                                              {"disabled", disabled}});
    if (request_.resume) kept.read(stop_);
    return kept;
  }

  void measure(const Job* job, MapCell& cell, const sim::ReportPhase& progress) const {
    try {
      Analysis analysis = analyse(problem_of(*job, cell.rays), cell.choice->candidates,
                                  {.repeats = request_.repeats,
                                   .disabled = request_.disabled,
                                   .engine = request_.costs.engine,
                                   .threads = sim::useful_threads(request_.threads),
                                   .stop = stop_,
                                   .progress = progress});
      if (!analysis.stopped && analysis.regret) cell.analysis = std::move(analysis);
    } catch (const sim::Stopped&) {
      // The cell stays unmeasured.
    }
  }

  const MapRequest& request_;
  const std::stop_token& stop_;
  const sim::ReportPhase& progress_;
  JobRequest job_;
  MapAxes axes_;
  std::vector<Made> made_;
  TechniqueMap map_;
};

}  // namespace

std::vector<double> default_map_rays() { return {100, 300, 1000, 3000, 10'000, 30'000, 100'000, 300'000}; }

std::vector<Length> default_map_radii() {
  std::vector<Length> radii;
  for (double share = 0.0025; share < 0.2; share *= 2) radii.push_back({share, true});
  return radii;
}

MapAxes checked(MapAxes axes) {
  for (const double rays : axes.rays) require_count("number of rays", rays, 1, 1e18);
  for (const Length& radius : axes.radii) require_positive("disc radius", radius.value);
  std::sort(axes.rays.begin(), axes.rays.end());
  axes.rays.erase(std::unique(axes.rays.begin(), axes.rays.end()), axes.rays.end());
  std::vector<Length> different;
  for (const Length& radius : axes.radii) add_new(different, radius);
  axes.radii = std::move(different);
  require_few("numbers of rays", axes.rays.size());
  require_few("disc radii", axes.radii.size());
  return axes;
}

TechniqueMap answer(const MapRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  return MapMaker(request, stop, progress).make();
}

Choice choose_for_cell(const Question& question, const CostTable& costs) {
  Choice choice = choose(question, costs);
  if (question.stop.stop_requested()) throw sim::Stopped("stopped while techniques were ranked");
  for (const Prediction& one : choice.candidates)
    if (const double seconds = one.seconds(); !(seconds > 0 && std::isfinite(seconds)))
      throw std::invalid_argument(
          fmt::format("with these unit costs {} takes {} s, so that nothing can be compared; give every operation its "
                      "cost in seconds",
                      name(one.candidate.technique), seconds));
  return choice;
}

}  // namespace detp::validate
