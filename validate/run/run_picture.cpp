#include "run_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/view/nearest_disc.hpp"
#include "detp/sim/view/view.hpp"
#include "detp/validate/picture/value_picture.hpp"
#include "disc_mesh.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t most_bands = 6;  // with a panel of their own
constexpr std::size_t most_discs = 2'000'000;

/// What is known of each disc.
struct Found {
  std::string title;
  std::vector<double> values;
};

/// For each band a row: irradiance, and its relative standard error if there are errors. Of many bands the sum.
std::vector<std::vector<Found>> found_of(const Job& job, const JobRun& run) {
  const bool errors = run.results ? run.results->errors() : !run.outcome.standard_error.empty();
  const std::size_t bands = std::max<std::size_t>(1, job.bands.size());
  std::vector<std::vector<Found>> rows;
  if (bands > most_bands) {
    rows.push_back({{fmt::format("irradiance, sum of {} bands", bands), {}}});
    for_each_disc(run, [&](std::span<const sim::DiscResult> by_band) {
      const auto add = [](double sum, const sim::DiscResult& one) { return sum + one.irradiance; };
      rows[0][0].values.push_back(std::accumulate(by_band.begin(), by_band.end(), 0.0, add));
    });
    return rows;
  }
  for (std::size_t band = 0; band < bands; ++band) {
    const std::string name = job.bands.empty() ? "" : " " + job.bands[band];
    rows.push_back({{"irradiance" + name, {}}});
    if (errors) rows.back().push_back({"relative error" + name + " (grey: bound only)", {}});
  }
  for_each_disc(run, [&](std::span<const sim::DiscResult> by_band) {
    for (std::size_t band = 0; band < bands; ++band) {
      const sim::DiscResult& one = by_band[band];
      rows[band][0].values.push_back(one.irradiance);
      if (errors)
        rows[band][1].values.push_back(
            sim::is_weak(one) || !(one.irradiance > 0) ? not_known : one.standard_error / one.irradiance);
    }
  });
  return rows;
}

/// What the picture shows: triangles, and which discs give their values.
class Surface {
 public:
  Surface(const Job& job, const std::stop_token& stop) : job_(job) {
    if (job.stored_discs || job.discs.size() > most_discs)
      throw std::invalid_argument(
          fmt::format("--picture draws at most {} discs: give --samples or fewer discs", most_discs));
    if (job.scene && !job.scene->mesh.triangles.empty()) {
      corners_ = triangles_of_discs(job);
      if (corners_.empty()) nearest_.emplace(job.discs, stop);
      caster_ = job.caster ? job.caster : sim::caster_for(*job.scene, stop);
    } else {
      polygons_ = polygons_of(job.discs);
      nearest_.emplace(job.discs, stop);
    }
    if (!caster_) caster_ = std::make_shared<sim::RayCaster>(mesh(), sim::used_box(mesh()), stop);
  }

  [[nodiscard]] const sim::Mesh& mesh() const { return polygons_ ? polygons_->mesh : job_.scene->mesh; }
  [[nodiscard]] const sim::RayCaster& caster() const { return *caster_; }

  /// The discs that a place gets its value from, by their weights.
  struct Source {
    std::array<std::uint32_t, 3> discs{};
    std::array<double, 3> weights{};
    bool known = false;
  };
  [[nodiscard]] Source source(const sim::Seen& seen) const {
    if (!corners_.empty())
      return {corners_[seen.triangle], {1 - seen.second - seen.third, seen.second, seen.third}, true};
    const auto& [a, b, c] = mesh().triangles[seen.triangle];
    const glm::dvec3 first = mesh().positions[b] - mesh().positions[a];
    const glm::dvec3 second = mesh().positions[c] - mesh().positions[a];
    const glm::dvec3 place = mesh().positions[a] + seen.second * first + seen.third * second;
    std::optional<std::uint32_t> disc = nearest_->at(place, glm::normalize(glm::cross(first, second)));
    if (polygons_ && !disc) disc = seen.triangle / polygons_->triangles_each;
    return disc ? Source{{*disc, *disc, *disc}, {1, 0, 0}, true} : Source{};
  }

 private:
  const Job& job_;
  std::vector<std::array<std::uint32_t, 3>> corners_;  ///< of the mesh; empty: places get the value of the nearest disc
  std::optional<DiscPolygons> polygons_;
  std::optional<sim::NearestDisc> nearest_;
  std::shared_ptr<const sim::RayCaster> caster_;
};

sim::View view_of(const Picture& picture, const Surface& surface, const Job& job, const std::vector<double>& irradiance,
                  const std::stop_token& stop) {
  const sim::Up up = job.scene ? job.scene->up : up_of(surface.mesh(), used_box(surface.mesh()), stop);
  if (picture.view) return sim::view_between(picture.view->first, picture.view->second, up);
  constexpr double dark = 0.1;
  std::vector<sim::Sight> sights;
  sights.reserve(job.discs.size());
  for (std::size_t disc = 0; disc < job.discs.size(); ++disc)
    sights.push_back({job.discs[disc].centre, job.discs[disc].normal, irradiance[disc] > 0 ? 1 : dark});
  return sim::view_of_most(surface.caster(), surface.mesh(), up, sights, stop);
}

}  // namespace

SeenBetween write_picture(const Picture& picture, const Job& job, const RunAnswer& answer,
                          const std::stop_token& stop) {
  const Surface surface(job, stop);
  std::vector<std::vector<Found>> found = found_of(job, answer.run);
  const sim::View view = view_of(picture, surface, job, found[0][0].values, stop);
  constexpr int fineness = ValuePanel::fineness;
  const sim::Cells cells(view, 0.75 * picture.width * picture.width * fineness * fineness);
  constexpr double bytes_of_cell = 100;
  sim::require_memory("a picture of this width", bytes_of_cell * static_cast<double>(cells.count()));
  const std::vector<sim::Seen> seen = look(surface.caster(), surface.mesh(), view, cells, answer.threads, stop);
  std::vector<Surface::Source> sources(seen.size());
  sim::on_threads(answer.threads, [&] {
    sim::parallel_for(sim::ParallelRange(0, seen.size(), 1024), [&](const sim::ParallelRange& part) {
      for (std::size_t i = part.begin(); i < part.end() && !stop.stop_requested(); ++i)
        if (seen[i].anything()) sources[i] = surface.source(seen[i]);
    });
  });
  const std::vector<char> edges = outlines(seen, surface.mesh(), view, cells);
  const auto check_stop = [&] {
    if (stop.stop_requested()) throw sim::Stopped("stopped while drawing a picture");
  };
  PanelRows rows;
  for (std::vector<Found>& of_band : found) {
    rows.emplace_back();
    for (Found& one : of_band) {
      check_stop();
      ValuePanel& panel = rows.back().emplace_back(
          ValuePanel{std::move(one.title), cells.width / fineness, cells.height / fineness, {}, edges});
      panel.scale = scale_of(one.values, picture.scaling);
      panel.cells.resize(seen.size(), no_surface);
      for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen[i].anything()) continue;
        const Surface::Source& source = sources[i];
        double value = 0;
        for (std::size_t corner = 0; corner < 3; ++corner)
          value += source.weights[corner] == 0 ? 0 : source.weights[corner] * one.values[source.discs[corner]];
        panel.cells[i] = source.known ? value : not_known;
      }
    }
  }
  check_stop();
  sim::OutputFile file(picture.path, stop);
  const bool is_svg = sim::suffix_of(picture.path) == ".svg";
  file.write(is_svg ? picture_svg(rows, "Irradiance in " + job.name) : picture_png(rows));
  file.commit();
  return {view.from, view.to};
}

}  // namespace detp::validate
