#include "job_progress.hpp"

#include <filesystem>
#include <system_error>

#include "detp/sim/files/input_file.hpp"

namespace detp::validate {
namespace {

/// Assumed number of rays or discs before the scene has been read.
constexpr double usual = 1e5;

}  // namespace

JobProgress::Part JobProgress::reading(const std::string& file) {
  std::error_code none;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, none));
  if (none) return {};
  return {bytes / static_cast<double>(sim::bytes_a_unit), 30e-9 * bytes};
}

/// A stream of photon paths traces all photons once, to number their segments. A stream of lines makes nothing before
/// its lines are needed.
JobProgress::Part JobProgress::making(sim::Field field, double rays, bool stream) {
  if (field == sim::Field::photons) return {120 * rays, 4e-6 * rays};
  return stream ? Part{} : Part{rays, 1e-7 * rays};
}

JobProgress::Part JobProgress::measuring(double rays, double discs) {
  return {rays + 5 * discs, 1e-8 * (rays + discs)};
}

void JobProgress::read(const JobRequest& request) {
  if (!report_) return;
  Part part{.work = 0, .seconds = 0.1};
  for (const auto& file : {request.scene, request.disc_file})
    if (file && !file->starts_with('@')) {
      const Part one = reading(*file);
      part.work += one.work;
      part.seconds += one.seconds;
    }
  const sim::Field field = request.field.value_or(request.scene ? sim::Field::photons : sim::Field::isotropic);
  const double rays = request.rays.value_or(usual);
  begin("reading the scene", part, making(field, rays, request.stream).seconds + measuring(rays, usual).seconds);
}

void JobProgress::read_rays(const std::string& file, std::size_t discs) {
  if (report_) begin("reading rays", reading(file), measuring(usual, static_cast<double>(discs)).seconds);
}

void JobProgress::make_rays(sim::Field field, double rays, bool stream, std::size_t discs) {
  if (!report_) return;
  begin("making rays", making(field, rays, stream), measuring(rays, static_cast<double>(discs)).seconds);
}

void JobProgress::measure(std::size_t rays, std::size_t discs) {
  if (report_) begin("measuring rays and discs", measuring(static_cast<double>(rays), static_cast<double>(discs)), 0);
}

void JobProgress::begin(const char* what, const Part& part, double later) {
  const double before = done_;
  const double share = part.seconds > 0 ? part.seconds / (part.seconds + later) : 0;
  done_ += (1 - done_) * share;
  report_({what, before, done_, part.work, part.work > 0 ? 0 : part.seconds});
}

}  // namespace detp::validate
