#include "job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/technique/streamed.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t pieces_of_file = 64;  // its rays may have an order

/// Fills the block with rays from so many places of the stream.
void read_evenly(const sim::RaySource& stream, std::uint64_t pieces, std::span<sim::Ray> block,
                 const std::stop_token& stop) {
  for (std::uint64_t piece = 0; piece < pieces; ++piece) {
    const std::uint64_t first = block.size() * piece / pieces;
    const std::uint64_t last = block.size() * (piece + 1) / pieces;
    const std::uint64_t from = (stream.size() - block.size()) / pieces * piece + first;
    stream.read(from, block.subspan(first, last - first), stop);
  }
}

}  // namespace

bool on_faces(const Workload& workload) { return workload.dimension < 2.5; }

Length parse_length(std::string_view text) {
  const bool relative = text.ends_with('%');
  std::string_view digits = text;
  if (relative) digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw std::invalid_argument(
        fmt::format("disc radius must be a length or a percentage, as 0.02 or 4% (got {})", shortened(text)));
  require_positive("disc radius", value);
  const Length length{relative ? value / 100 : value, relative};
  require_positive("disc radius", length.value);  // a hundredth of the smallest double is 0
  return length;
}

Workload workload_of_numbers(const JobRequest& request) {
  if (!request.samples) throw std::invalid_argument("without a scene, the number of samples is needed");
  if (!request.disc_radius) throw std::invalid_argument("without a scene, the disc radius is needed");
  if (!request.sphere_radius && !request.scene_side)
    throw std::invalid_argument("without a scene, its size is needed: the radius of S0 or the side of the scene");
  if (request.sphere_radius) require_positive("sphere radius", *request.sphere_radius);
  if (request.scene_side) require_positive("scene side", *request.scene_side);
  double d = request.disc_radius->value;
  double side = request.scene_side.value_or(0);
  if (request.disc_radius->relative) {
    // Solves r₀ = s√3/2 + d for s, where d is the given share of s.
    if (!request.scene_side) side = *request.sphere_radius / (std::sqrt(0.75) + d);
    d *= side;
  }
  const double outer = request.sphere_radius.value_or(enclosing_radius(side, d));
  // If d >= r₀, no cube of samples has this r₀. Then uses the cube inscribed in S₀.
  if (!(side > 0)) side = (d < outer ? outer - d : outer) / std::sqrt(0.75);
  Workload workload =
      cube_workload(request.rays.value_or(rays_by_default), *request.samples, d, side, request.dimension.value_or(3));
  workload.sphere_radius = outer;
  workload.sample_extent = request.sample_extent.value_or(0);
  if (request.sample_extent) require_positive("sample extent", *request.sample_extent);
  workload.front_facing = request.front_facing;
  check(workload);
  return workload;
}

std::string_view name_of_numbers(const Workload& workload) {
  return on_faces(workload) ? "uniform samples on the faces of a cube" : "uniform samples in a cube";
}

std::unique_ptr<const sim::RaySource> Job::field_rays(std::uint64_t count, const std::stop_token& stop) const {
  const sim::Sphere around = numbers        ? sim::Sphere{glm::dvec3{0.0}, numbers->sphere_radius}
                             : stored_discs ? stored_summary.enclosing
                                            : sim::enclosing_sphere(discs, stop);
  if (field == sim::Field::isotropic) return std::make_unique<sim::LinesOfField>(around, seed, count);
  glm::dvec3 down{0.0};
  down[up.axis] = -up.sign;
  sim::Box box = stored_summary.centres;
  if (!stored_discs)
    for (const sim::Disc& disc : discs) box.include(disc.centre);
  glm::dvec3 point = box.centre();
  point[up.axis] = up.sign > 0 ? box.high[up.axis] : box.low[up.axis];
  return std::make_unique<sim::MixedField>(sim::FieldMixture{around, shares, down, point}, seed, count);
}

void Job::check_problem(int threads, const std::stop_token& stop) {
  const sim::Stopwatch watch;
  problem_ = without_rays ? sim::make_problem_without_rays(discs, 0, front_facing, stop)
                          : sim::make_problem(paths(), discs, front_facing, threads, stop);
  check_seconds = watch.seconds();
  given = sim::without_effects(*problem_);
  take_numbers(given);
}

void Job::take_numbers(Workload& workload) const {
  if (!numbers) return;
  workload.sphere_radius = numbers->sphere_radius;
  workload.box = numbers->box;
}

sim::TracedPaths Job::more_rays(std::uint64_t made, std::uint64_t batch, std::size_t count,
                                const std::stop_token& stop_request) const {
  if (rays_from_file) throw std::invalid_argument("a ray file has no further rays");
  if (field == sim::Field::photons) {
    if (!scene) throw std::invalid_argument("further photon paths need the scene, which was not kept");
    return sim::photon_paths(*scene, count, seed + 0x9e3779b97f4a7c15ULL * (batch + 1), caster, stop_request,
                             sim::PhotonPowers::equal);
  }
  sim::TracedPaths lines;
  lines.rays.resize(count);
  field_rays(made + count, stop_request)->read(made, lines.rays, stop_request);
  lines.photon_count = count;
  return lines;
}

void Job::measure() const {
  if (without_rays) {
    workload_ = given;
    observed_ = sim::Observed{.workload = given};
    return;
  }
  std::vector<sim::Ray> block;
  std::optional<sim::Problem> of_block;
  if (stream) {
    block.resize(static_cast<std::size_t>(std::min(rays_of_workload, stream->size())));
    read_evenly(*stream, rays_from_file ? pieces_of_file : 1, block, measuring.stop);
    of_block = sim::make_problem(block, discs, front_facing, measuring.threads, measuring.stop);
  }
  sim::Observed found =
      sim::observe(of_block ? *of_block : problem(), surface, measuring.effects, measuring.stop, measuring.effort);
  workload_ = found.workload;
  take_numbers(workload_);
  workload_.rays = given.rays;
  workload_.samples = given.samples;  // more than were measured if discs are stored
  if (measuring.dimension) workload_.dimension = *measuring.dimension;
  if (measuring.sample_extent) workload_.sample_extent = *measuring.sample_extent;
  check(workload_);
  observed_ = std::move(found);
}

const sim::Observed& Job::observed() const {
  if (!observed_) measure();
  return *observed_;
}

const Workload& Job::workload() const {
  if (!observed_) measure();
  return workload_;
}

const sim::Problem& Job::problem() const {
  if (!problem_) throw std::invalid_argument("the rays are a stream, or were not checked");
  return *problem_;
}

void add(std::span<const sim::Disc> discs, Digest& digest) {
  for (const sim::Disc& disc : discs) {
    digest.add(disc.centre);
    digest.add(disc.normal);
    digest.add(disc.radius);
  }
}

void add(std::span<const sim::Ray> rays, Digest& digest) {
  for (const sim::Ray& ray : rays) {
    digest.add(ray.origin);
    digest.add(ray.direction);
    digest.add(ray.length);
    digest.add(ray.power);
  }
}

std::string digest_of(const Job& job) {
  Digest digest;
  digest.add(job.seed);
  digest.add(job.independent_photons());
  add(job.discs, digest);
  add(job.rays, digest);
  for (const std::uint64_t photon : job.photons) digest.add(photon);
  return digest.text();
}

}  // namespace detp::validate
