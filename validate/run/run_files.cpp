#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/files/result_file.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "detp/sim/files/writing_check.hpp"
#include "disc_mesh.hpp"
#include "run.hpp"
#include "run_picture.hpp"

namespace detp::validate {
namespace {

/// "ray,disc" for each pair. `order`: numbers of the rays in their file; empty if they have the file's order.
void write_pairs(const std::string& path, const JobRun& run, const std::vector<std::uint32_t>& order,
                 const std::stop_token& stop) {
  std::vector<sim::Pair> pairs;
  if (!order.empty()) {
    pairs = run.outcome.pairs;
    for (sim::Pair& pair : pairs) pair.ray = order[pair.ray];
    std::ranges::sort(pairs);
  }
  const std::vector<sim::Pair>& sorted = order.empty() ? run.outcome.pairs : pairs;
  sim::WritingCheck check(path, run.results ? run.results->pairs() : sorted.size(), "pairs", stop);
  sim::OutputFile file(path, stop);
  file.write("ray,disc\n");
  const auto write = [&](const sim::Pair& pair) {
    check.next();
    file.write(fmt::format("{},{}\n", pair.ray, pair.disc));
  };
  if (run.results)
    run.results->for_each_pair(write);
  else
    std::ranges::for_each(sorted, write);
  file.commit();
}

/// A job's discs, one after the other, wherever they are.
class DiscsInOrder {
 public:
  DiscsInOrder(const Job& job, const std::stop_token& stop) : job_(job), stop_(stop) {}

  const sim::Disc& next() {
    constexpr std::uint64_t at_once = 1 << 14;
    const std::uint64_t number = given_++;
    if (!job_.stored_discs) return job_.discs[number];
    if (number % at_once == 0) {
      block_.resize(std::min(at_once, job_.stored_discs->size() - number));
      job_.stored_discs->read(number, block_, stop_);
    }
    return block_[number % at_once];
  }

 private:
  const Job& job_;
  std::stop_token stop_;
  std::uint64_t given_ = 0;
  std::vector<sim::Disc> block_;
};

/// The columns of what is found, in each band.
void add_irradiance(const Job& job, bool errors, std::vector<sim::ResultColumn>& columns) {
  for (const std::string& band : job.bands.empty() ? std::vector<std::string>{""} : job.bands) {
    const std::string name = band.empty() ? "" : "_" + band;
    columns.push_back({"irradiance" + name});
    if (!errors) continue;
    columns.push_back({"standard_error" + name});
    columns.push_back({"upper_bound" + name});
    columns.push_back({"standard_error_weak" + name, sim::ResultColumn::Kind::index});
  }
}

/// Bounds are not written where errors are not weak.
void add_irradiance(const sim::DiscResult& found, bool errors, std::vector<double>& row) {
  row.push_back(found.irradiance);
  if (!errors) return;
  const bool weak = sim::is_weak(found);
  row.insert(row.end(), {found.standard_error, weak ? found.upper_bound : std::nan(""), weak ? 1.0 : 0.0});
}

/// Place, hits and irradiance of each disc; with standard errors and bounds if they were asked for.
void write_per_disc(const std::string& path, const JobRun& run, const Job& job, const std::stop_token& stop) {
  using Kind = sim::ResultColumn::Kind;
  const bool errors = run.results ? run.results->errors() : !run.outcome.standard_error.empty();
  std::vector<sim::ResultColumn> columns{{"disc", Kind::index}};
  for (const char* real : {"x", "y", "z", "nx", "ny", "nz", "radius"}) columns.push_back({real});
  columns.push_back({"vertex", Kind::index});
  columns.push_back({"hits", Kind::count});
  add_irradiance(job, errors, columns);
  const std::string suffix = sim::suffix_of(path);
  const auto triangles =
      suffix == ".ply" || suffix == ".vtp" ? triangles_of_discs(job) : std::vector<std::array<std::uint32_t, 3>>{};
  sim::ResultFile file(path, std::move(columns), disc_count(run), {.triangles = triangles}, "discs", stop);
  DiscsInOrder discs(job, stop);
  std::uint64_t number = 0;
  std::vector<double> row;
  for_each_disc(run, [&](std::span<const sim::DiscResult> by_band) {
    const sim::Disc& disc = discs.next();
    const bool at_vertex = !job.vertices.empty() && job.vertices[number] != sim::no_vertex;
    row = {static_cast<double>(number),
           disc.centre.x,
           disc.centre.y,
           disc.centre.z,
           disc.normal.x,
           disc.normal.y,
           disc.normal.z,
           disc.radius,
           at_vertex ? job.vertices[number] : -1.0,
           static_cast<double>(by_band[0].hits)};
    for (const sim::DiscResult& found : by_band) add_irradiance(found, errors, row);
    file.write(row);
    ++number;
  });
  file.commit();
}

/// Light on each triangle. With several groups, a triangle has all their names.
void write_per_face(const std::string& path, const LightOnFaces& faces, const Job& job, const std::stop_token& stop) {
  using Kind = sim::ResultColumn::Kind;
  const sim::Mesh& mesh = job.scene->mesh;
  const bool errors = !faces.triangles.standard_error.empty();
  std::vector<sim::ResultColumn> columns{{"face", Kind::index}};
  for (const char* real : {"x", "y", "z", "nx", "ny", "nz", "area"}) columns.push_back({real});
  columns.push_back({"material", Kind::index, faces.by_material.parts.names});
  std::vector<std::string> sets;
  for (const std::vector<std::uint32_t>& set : mesh.groups.sets) {
    std::string& names = sets.emplace_back();
    for (const std::uint32_t name : set) names += (names.empty() ? "" : " ") + mesh.groups.names[name];
  }
  const bool grouped = !mesh.groups.of_triangle.empty();
  columns.push_back({"group", Kind::index, sets});
  columns.push_back({"hits", Kind::count});
  add_irradiance(job, errors, columns);
  sim::ResultFile file(path, std::move(columns), mesh.triangles.size(), {mesh.positions, mesh.triangles}, "faces",
                       stop);
  std::vector<double> row;
  for (std::uint32_t face = 0; face < mesh.triangles.size(); ++face) {
    const auto& [a, b, c] = mesh.triangles[face];
    const glm::dvec3 place = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0;
    const glm::dvec3 facing = sim::area_vector(mesh, face);
    const double area = glm::length(facing);
    const glm::dvec3 normal = area > 0 ? facing / area : glm::dvec3{0.0};
    row = {static_cast<double>(face), place.x, place.y, place.z, normal.x, normal.y, normal.z, area};
    row.push_back(faces.by_material.parts.set_of_triangle[face]);
    row.push_back(grouped ? mesh.groups.of_triangle[face] : -1.0);
    row.push_back(static_cast<double>(faces.triangles.hits[face]));
    for (std::size_t band = 0; band < faces.triangles.bands(); ++band)
      add_irradiance(sim::result_of(faces.triangles, face, band), errors, row);
    file.write(row);
  }
  file.commit();
}

}  // namespace

WrittenRun write_files(const RunFiles& files, const Job& job, const RunAnswer& answer, const std::stop_token& stop) {
  WrittenRun written;
  const sim::Outcome& outcome = answer.run.outcome;
  if (outcome.stopped) {
    // By the photons so far, the irradiance is an estimate; sums over other rays would be too small.
    const bool is_estimate = answer.taken.has_value();
    std::vector<std::string_view> left_out;
    if (files.per_disc && !is_estimate) left_out.emplace_back("--per-disc");
    if (files.per_face) left_out.emplace_back("--per-face");
    if (files.pairs) left_out.emplace_back("--pairs");
    if (files.picture) left_out.emplace_back("--picture");
    if (!left_out.empty())
      written.notices.push_back(fmt::format("stopped before the end: not written, because they would be partial: {}",
                                            fmt::join(left_out, ", ")));
    if (is_estimate && files.per_disc) {
      written.notices.push_back(fmt::format("{} has the irradiance by the photons of the first {} rays",
                                            *files.per_disc, outcome.progress.done));
      write_per_disc(*files.per_disc, answer.run, job, {});
    }
    written.stopped = outcome.progress;
    return written;
  }
  try {
    if (files.per_disc) write_per_disc(*files.per_disc, answer.run, job, stop);
    if (files.per_face && !answer.faces) throw std::invalid_argument("a file of faces needs RunRequest::faces");
    if (files.per_face) write_per_face(*files.per_face, *answer.faces, job, stop);
    if (files.pairs) write_pairs(*files.pairs, answer.run, job.file_order, stop);
    if (files.picture) written.picture = write_picture(*files.picture, job, answer, stop);
  } catch (const sim::Stopped& stopped) {
    written.notices.push_back(fmt::format("{}; the file is not kept", stopped.what()));
    written.stopped = stopped.progress();
    return written;
  }
  if (answer.until && answer.until->result.reason == StopReason::time) {
    written.stopped = outcome.progress;
    return written;
  }
  const std::size_t timed = answer.timing.all.size();
  const auto repeat = static_cast<std::size_t>(answer.request.repeat);
  if (repeat > 0 && timed < repeat) written.stopped = sim::Progress{timed, repeat, "timed runs"};
  return written;
}

}  // namespace detp::validate
