#include "job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/effects/self_shadow.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/files/stored_rays.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/landings.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "job_progress.hpp"
#include "outliers.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t rays_looked_at = 4096;  // of a stream, for outliers

/// `count` as an integer. Throws unless it is a whole number from 1 to 1e18, and `count` things of `bytes` bytes each
/// fit in memory.
std::size_t count_in_memory(std::string_view what, double count, std::size_t bytes) {
  require_count(fmt::format("number of {}", what), count, 1, 1e18);
  sim::require_memory(fmt::format("{} {}", count, what), count * static_cast<double>(bytes));
  return static_cast<std::size_t>(count);
}

double triangle_area(const sim::Mesh& mesh, const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring triangles");
  double area = 0;
  sim::for_each_checked(std::span(mesh.triangles), check, [&](const auto& corners) {
    const glm::dvec3& a = mesh.positions[corners[0]];
    area += 0.5 * glm::length(glm::cross(mesh.positions[corners[1]] - a, mesh.positions[corners[2]] - a));
  });
  return area;
}

double absolute(const Length& length, double side) { return length.relative ? length.value * side : length.value; }

/// Half the distance between samples. The distance is `edge_length`, or if this is 0, that of as many points spread
/// evenly over a surface (in a volume if the scene has no triangles).
double default_radius(const sim::Scene& scene, double side, double edge_length) {
  const double root = scene.mesh.triangles.empty() ? 1.0 / 3 : 0.5;
  const double spread = side / std::pow(static_cast<double>(scene.samples.size()), root);
  return 0.5 * (edge_length > 0 ? edge_length : spread);
}

std::vector<sim::Disc> discs_at(const std::vector<sim::Sample>& samples, double radius, const std::stop_token& stop) {
  require_positive("disc radius", radius);
  sim::StopCheck check(stop, "making discs");
  std::vector<sim::Disc> discs;
  discs.reserve(samples.size());
  sim::for_each_checked(std::span(samples), check, [&](const sim::Sample& sample) {
    discs.push_back({sample.position, sample.normal, radius});
  });
  return discs;
}

class JobMaker {
 public:
  JobMaker(const JobRequest& request, std::stop_token stop, const sim::ReportPhase& progress)
      : request_(request), stop_(std::move(stop)), progress_(progress) {}

  Job make() {
    sim::Stopwatch watch;
    if (request_.without_rays) refuse_rays();
    check_columns();
    progress_.read(request_);
    sim::in_memory("reading the scene", [&] { request_.numbers_alone() ? from_numbers() : from_scene_and_files(); });
    job_.front_facing = request_.front_facing;
    job_.shares = request_.shares;
    job_.seed = request_.seed;
    job_.rays_from_file = request_.ray_file.has_value();
    job_.without_rays = request_.without_rays;
    if (request_.rgb && !job_.rays_from_file) job_.bands = {"r", "g", "b"};
    job_.read_seconds = watch.lap();
    if (!request_.without_rays) sim::in_memory("making rays", [&] { make_rays(); });
    (job_.rays_from_file ? job_.read_seconds : job_.trace_seconds) += watch.lap();
    progress_.measure(job_.rays.size(), job_.discs.size());
    sim::in_memory("checking rays and discs", [&] { check_rays_and_discs(); });
    if (request_.keep_scene && scene_) {
      job_.scene = std::make_shared<sim::Scene>(std::move(*scene_));
      job_.caster = caster_;
    }
    return std::move(job_);
  }

 private:
  void refuse_rays() const {
    if (!request_.scene) throw std::invalid_argument("gather needs a scene with triangles and light: name one");
    const auto refuse = [](bool given, std::string_view option) {
      if (given) throw std::invalid_argument(fmt::format("gather traces no photons: leave out {}", option));
    };
    refuse(request_.rays.has_value(), "--rays");
    refuse(request_.ray_file.has_value(), "--ray-file");
    refuse(request_.field.has_value(), "--field");
    refuse(request_.second_intersection, "--second-intersection");
  }

  void from_numbers() {
    if (request_.crease) throw std::invalid_argument("--crease is for a scene");
    const Workload workload = workload_of_numbers(request_);
    job_.numbers = workload;
    job_.name = name_of_numbers(workload);
    job_.discs = sim::uniform_discs(on_faces(workload) ? sim::Body::cube_faces : sim::Body::cube, scene_side(workload),
                                    count_in_memory("samples", workload.samples, sizeof(sim::Disc)),
                                    workload.disc_radius, request_.seed, stop_);
  }

  void from_scene_and_files() {
    if (request_.crease && !request_.scene) throw std::invalid_argument("--crease is for a scene");
    if (request_.scene) open_scene();
    if (request_.disc_file) {
      if (request_.samples)
        throw std::invalid_argument("the number of samples is for scenes; a disc file is taken whole");
      std::optional<double> radius;
      if (request_.disc_radius && !request_.disc_radius->relative) radius = request_.disc_radius->value;
      if (request_.disc_radius && request_.disc_radius->relative)
        throw std::invalid_argument("with a disc file the disc radius must be a length, not a percentage");
      read_discs(*request_.disc_file, radius);
      job_.name = request_.scene ? job_.name : *request_.disc_file;
    }
    if (job_.discs.empty()) throw std::invalid_argument("rays alone answer nothing: name a scene or a disc file");
  }

  /// Leaves discs in their file where they do not fit.
  void read_discs(const std::string& file, std::optional<double> radius) {
    std::vector<std::string> unused;
    auto stored = request_.store_discs && request_.stream
                      ? sim::StoredDiscs::open(file, radius, &unused, names_in(Names::discs))
                      : nullptr;
    if (stored && request_.ray_file && !ray_table(*request_.ray_file)) stored.reset();
    if (!stored || !are_large(stored->size())) {
      job_.discs = sim::read_discs(file, radius, stop_, &unused, names_in(Names::discs));
      note_unused(file, unused);
      return;
    }
    note_unused(file, unused);
    constexpr std::uint64_t sampled = std::uint64_t{1} << 17;
    job_.stored_summary = sim::summary_of(*stored, stop_);
    job_.discs = sim::sample_of(*stored, sampled, stop_);
    job_.notices.push_back(fmt::format(
        "the {} discs do not fit in memory: they are read part by part, and their workload is measured on {} of them",
        stored->size(), job_.discs.size()));
    job_.stored_discs = std::move(stored);
  }

  enum class Names { rays, discs };
  [[nodiscard]] std::vector<sim::ColumnName> names_in(Names of) const {
    std::vector<sim::ColumnName> names = request_.columns;
    std::erase_if(names, [&](const auto& one) { return sim::is_ray_column(one.name) != (of == Names::rays); });
    return names;
  }
  [[nodiscard]] sim::RayColumns ray_columns() const { return {request_.bands, names_in(Names::rays)}; }

  void check_columns() const {
    const std::vector<sim::TableColumn> of_discs = sim::disc_columns(1);
    for (const sim::ColumnName& one : request_.columns) {
      const bool of_rays = sim::is_ray_column(one.name);
      if (!of_rays && std::ranges::find(of_discs, one.name, &sim::TableColumn::name) == of_discs.end())
        throw std::invalid_argument(
            fmt::format("--columns: {} is no column of rays or discs: those are ox, oy, oz, dx, dy, dz, length, power, "
                        "power_NAME, photon, landing; x, y, z, nx, ny, nz, radius, vertex",
                        detp::quoted(one.name)));
      if (!(of_rays ? request_.ray_file : request_.disc_file))
        throw std::invalid_argument(fmt::format("--columns names {}, a column of {}, and there is none", one.name,
                                                of_rays ? "--ray-file" : "--discs"));
    }
  }

  void note_unused(const std::string& file, const std::vector<std::string>& unused) {
    if (std::string notice = sim::unused_notice(file, unused); !notice.empty())
      job_.notices.push_back(std::move(notice));
  }

  /// With their results they take more than half the memory of a process.
  [[nodiscard]] bool are_large(std::uint64_t discs) const {
    constexpr double bytes = sizeof(sim::Disc) + 4 * sizeof(double);
    return on_any_rank(bytes * static_cast<double>(discs) > sim::memory_budget() / 2);
  }

  /// Ranks can have different limits, but must do the same.
  [[nodiscard]] bool on_any_rank(bool here) const {
    return request_.ranks != nullptr ? sim::largest(*request_.ranks, here ? 1 : 0) == 1 : here;
  }

  /// Rays in memory, discs, and the index and results of most techniques do not fit.
  [[nodiscard]] bool all_are_large(double rays) const {
    return on_any_rank(static_cast<double>(sim::bytes_of_ray_in(request_.rgb ? 3 : 1)) * rays +
                           sim::bytes_of_disc * static_cast<double>(job_.disc_count()) >
                       sim::memory_budget());
  }

  void open_scene() {
    std::optional<std::size_t> samples;
    if (request_.samples)
      samples = count_in_memory("samples", *request_.samples, sizeof(sim::Sample) + sizeof(sim::Disc));
    scene_ = sim::open_scene({*request_.scene, samples, request_.seed, request_.lights,
                              request_.crease.value_or(sim::default_crease), request_.rgb, request_.up},
                             stop_);
    job_.name = scene_->name;
    job_.notices = scene_->notices;
    job_.lights = scene_->lights;
    job_.lights_placed = scene_->lights_placed;
    job_.up = scene_->up;
    job_.triangles = scene_->mesh.triangles.size();
    job_.polygons = scene_->mesh.polygons;
    job_.normals_made = scene_->mesh.normals_made;
    job_.coincident = scene_->mesh.coincident;
    job_.surface = {triangle_area(scene_->mesh, stop_),
                    request_.samples ? 0 : sim::mean_edge_length(scene_->mesh, stop_)};
    const double side = scene_->box.longest_side();
    const double radius = request_.disc_radius ? absolute(*request_.disc_radius, side)
                                               : default_radius(*scene_, side, job_.surface.edge_length);
    job_.discs = discs_at(scene_->samples, radius, stop_);
    if (!scene_->mesh.triangles.empty() && !request_.disc_file)
      for (const sim::Sample& sample : scene_->samples) job_.vertices.push_back(sample.vertex);
  }

  [[nodiscard]] bool are_shared(double rays) const {
    return request_.ranks != nullptr && request_.ranks->count() > 1 && rays > static_cast<double>(rays_of_workload);
  }

  void make_rays() {
    if (request_.ray_file) {
      if (request_.rgb) throw std::invalid_argument("--bands rgb is for photon paths; rays of a file have columns");
      refuse_lights("rays from a file");
      progress_.read_rays(*request_.ray_file, job_.disc_count());
      if (request_.rays)
        throw std::invalid_argument("the number of rays is for fields of rays; a ray file is taken whole");
      job_.field = sim::Field::photons;
      std::vector<std::string> unused;
      if (request_.landed && (!scene_ || scene_->mesh.triangles.empty()))
        throw std::invalid_argument("--landed finds the pieces of photons' paths in a scene: name one with triangles");
      if (!request_.landed && (job_.stored_discs || (request_.stream && is_large(*request_.ray_file))))
        if (auto stored = sim::StoredRays::open(*request_.ray_file, stop_, request_.ranks, ray_columns(), &unused)) {
          note_unused(*request_.ray_file, unused);
          name_bands(stored->band_columns());
          job_.stream = std::move(stored);
          return;
        }
      if (job_.stored_discs)
        throw std::length_error(
            fmt::format("{} and its rays do not fit in memory; rays are read part by part only if their photons' "
                        "numbers do not fall",
                        *request_.disc_file));
      sim::RayFile file = sim::read_rays(*request_.ray_file, stop_, ray_columns());
      name_bands(file.bands);
      note_unused(*request_.ray_file, file.unused);
      find_landings(*request_.ray_file, file.paths);
      keep(std::move(file.paths));
      job_.file_order = std::move(file.order);
      return;
    }
    if (request_.landed) throw std::invalid_argument("--landed is for photons of a --ray-file");
    if (!request_.bands.empty()) throw std::invalid_argument("--bands names columns of --ray-file, and there is none");
    const bool are_photons =
        request_.field.value_or(scene_ ? scene_->field : sim::Field::isotropic) == sim::Field::photons;
    if (request_.rgb && !are_photons) throw std::invalid_argument("--bands rgb is for photon paths in a scene");
    const double rays = request_.rays.value_or(rays_by_default);
    require_count("number of rays", rays, 1, 1e18);
    job_.field = request_.field.value_or(scene_ ? scene_->field : sim::Field::isotropic);
    if (job_.field != sim::Field::photons)
      refuse_lights(job_.field == sim::Field::mixed ? "a mixed field" : "isotropic lines");
    const auto block = static_cast<double>(sim::default_block(job_.disc_count()));
    const bool stream =
        job_.stored_discs || (request_.stream && (rays > block || are_shared(rays) || all_are_large(rays)));
    const double made = request_.workload_only && rays > block ? std::min<double>(rays, rays_of_workload) : rays;
    progress_.make_rays(job_.field, made, stream, job_.disc_count());
    if (stream) return make_stream(static_cast<std::uint64_t>(rays));
    const bool paths = job_.field == sim::Field::photons;
    const std::size_t count =
        count_in_memory("rays", made,
                        sim::bytes_of_ray_in(request_.rgb ? 3 : 1) +
                            (paths ? sizeof(std::uint64_t) + sizeof(double) + sizeof(std::uint32_t) : 0));
    if (job_.field != sim::Field::photons) {
      read_rays(*job_.field_rays(count, stop_));
      return;
    }
    const sim::Scene& scene = scene_for_photons();
    using enum sim::PhotonPowers;
    const auto powers = request_.in_batches ? equal : request_.stream ? scaled : unbiased;
    sim::TracedPaths traced = sim::photon_paths(scene, count, request_.seed, caster_, stop_, powers);
    job_.light = traced.light;
    job_.power_scale = traced.scale;
    keep(std::move(traced));
  }

  /// In a scene, of the rays of a file.
  void find_landings(const std::string& file, sim::Paths& paths) {
    if (!request_.landed && !(request_.landings && scene_ && !scene_->mesh.triangles.empty())) return;
    sim::LandingCounts counts;
    if (request_.landed) {
      const double overshoot = scene_for_photons().overshoot;
      counts = sim::make_pieces(paths, *caster_, scene_->box, overshoot, request_.threads, stop_);
    } else {
      caster_ = std::make_shared<sim::RayCaster>(scene_->mesh, scene_->box, stop_);
      counts = sim::land(paths, !paths.landings.empty(), *caster_, scene_->box, request_.threads, stop_);
    }
    if (const std::string notice = sim::landing_notice(counts); !notice.empty())
      job_.notices.push_back(fmt::format("{}: {}", shown_path(file), notice));
  }

  [[nodiscard]] std::optional<sim::TableFile> ray_table(const std::string& path) const {
    std::vector<sim::BandColumn> found;
    return sim::TableFile::open(path, sim::ray_columns(ray_columns(), found));
  }

  /// Its rays are to stay in the file: ranks share them, or they are more than a block and take more than half of the memory.
  [[nodiscard]] bool is_large(const std::string& path) const {
    const auto table = ray_table(path);
    if (!table) return false;
    const auto rays = static_cast<double>(table->rows());
    if (are_shared(rays)) return true;
    const double bytes = sizeof(sim::Ray) + sizeof(std::uint64_t) + sizeof(double) +
                         sizeof(double) * static_cast<double>(table->columns() - sim::ray_column::further);
    return table->rows() > sim::default_block(job_.disc_count()) && bytes * rays > sim::memory_budget() / 2;
  }

  void keep(sim::Paths paths) {
    job_.rays = std::move(paths.rays);
    job_.photons = std::move(paths.photons);
    job_.landings = std::move(paths.landings);
    job_.triangles_met = std::move(paths.triangles);
    job_.further = std::move(paths.further);
    job_.photon_count = paths.photon_count;
  }

  void name_bands(const std::vector<sim::BandColumn>& bands) {
    for (const sim::BandColumn& band : bands) job_.bands.push_back(band.name);
  }

  void refuse_lights(std::string_view rays) const {
    if (request_.second_intersection)
      throw std::invalid_argument(fmt::format("--second-intersection is for photon paths; these are {}", rays));
    if (!request_.lights.empty() || request_.up)
      throw std::invalid_argument(fmt::format("--light and --up are for photon paths; these are {}", rays));
  }

  void read_rays(const sim::RaySource& source) {
    constexpr std::size_t at_once = std::size_t{1} << 18;
    const std::size_t count = source.size();
    job_.rays.reserve(count);
    for (std::size_t made = 0; made < count; made = job_.rays.size()) {
      job_.rays.resize(std::min(count, made + at_once));
      source.read(made, std::span(job_.rays).subspan(made), stop_);
    }
  }

  /// The scene, whose photon paths go on through surfaces if the effect of concave surfaces is on.
  const sim::Scene& scene_for_photons() {
    if (!scene_) throw std::invalid_argument("photon paths need a scene; name one, or choose the isotropic field");
    caster_ = sim::caster_for(*scene_, stop_);
    if (request_.second_intersection) {
      scene_->overshoot = sim::unbounded;
      return *scene_;
    }
    const auto [shadow, piece_seconds] = sim::self_shadow(*scene_, caster_, request_.front_facing, stop_);
    if (request_.effects.is_on(sim::concave_surfaces, shadow.value, shadow.standard_error))
      scene_->overshoot = job_.stored_discs ? sim::overshoot_over_radius * job_.stored_summary.radii.largest
                                            : sim::overshoot_for(job_.discs);
    job_.surface.self_shadow = shadow;
    job_.surface.piece_seconds = piece_seconds;
    return *scene_;
  }

  void make_stream(std::uint64_t count) {
    if (job_.field != sim::Field::photons) {
      job_.stream = job_.field_rays(count, stop_);
      return;
    }
    const sim::Scene& scene = scene_for_photons();
    // Ranks share the counting. Rays that do not fit in memory beside the discs are read several times.
    const bool once = (request_.ranks == nullptr || request_.ranks->count() == 1) && !job_.stored_discs;
    auto source = std::make_unique<sim::PhotonSource>(scene, count, request_.seed, caster_, stop_, request_.ranks,
                                                      once ? sim::Counting::as_read : sim::Counting::ahead);
    job_.light = source->light_of(source->photons());
    job_.photon_stream = source.get();
    job_.stream = std::move(source);
  }

  /// What is out of range must be refused here, not when the workload is measured.
  void check_numbers() const {
    Workload workload = cube_workload(1, 1, 1, 1, request_.dimension.value_or(3));
    workload.sample_extent = request_.sample_extent.value_or(0);
    check(workload);
  }

  /// Outliers of a stream are those of its discs and first rays.
  void check_rays_and_discs() {
    check_numbers();
    std::vector<sim::Ray> first;
    std::optional<sim::Problem> of_first;
    if (job_.stream) {
      first.resize(static_cast<std::size_t>(std::min(rays_looked_at, job_.stream->size())));
      job_.stream->read(0, first, stop_);
      of_first = sim::make_problem(first, job_.discs, job_.front_facing, request_.threads, stop_);
      job_.given = sim::without_effects(*of_first);
      if (job_.stored_discs)
        job_.given =
            sim::without_effects(job_.stored_summary, static_cast<double>(job_.disc_count()), 0, of_first->segments());
      job_.given.rays = static_cast<double>(job_.stream->size());
    } else {
      job_.check_problem(request_.threads, stop_);
    }
    if (job_.light && !job_.photon_stream) job_.warnings = sim::light_warnings(*job_.light, job_.lights);
    for (std::string& one : outlier_warnings(of_first ? *of_first : job_.problem(), stop_))
      job_.warnings.push_back(std::move(one));
    if (request_.workload_only && !request_.ray_file)
      job_.given.rays = std::max(job_.given.rays, request_.rays.value_or(rays_by_default));
    const bool numbers = request_.numbers_alone();
    const Workload known = numbers ? workload_of_numbers(request_) : Workload{};
    job_.measuring = {.effects = request_.effects,
                      .dimension = numbers ? std::optional(known.dimension) : request_.dimension,
                      .sample_extent = numbers ? std::optional(known.sample_extent) : request_.sample_extent,
                      .threads = request_.threads,
                      .stop = stop_};
  }

  const JobRequest& request_;
  std::stop_token stop_;
  JobProgress progress_;
  std::optional<sim::Scene> scene_;
  std::shared_ptr<const sim::RayCaster> caster_;
  Job job_;
};

}  // namespace

Job make_job(const JobRequest& request, std::stop_token stop, const sim::ReportPhase& progress) {
  return JobMaker(request, std::move(stop), progress).make();
}

}  // namespace detp::validate
