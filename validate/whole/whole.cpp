#include "whole.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "accuracy_costs.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/technique/streamed.hpp"

namespace detp::validate {
namespace {

/// 0 if the file has no size.
double size_of(const std::string& path) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  return unknown ? 0 : static_cast<double>(size);
}

double seconds_of_pieces(const WholeInputs& inputs, const AccuracyCosts& costs, int threads) {
  const double known = inputs.piece_seconds / sim::useful_threads(threads);
  return inputs.rays * (known > 0 ? known : costs.trace().per_ray);
}

}  // namespace

void add_file(const std::optional<std::string>& path, WholeInputs& inputs) {
  if (!path || path->starts_with('@')) return;
  const std::string_view name = sim::without_gz(*path);
  const bool binary = sim::has_ending(name, ".ply") || sim::has_ending(name, ".npy");
  (binary ? inputs.binary_bytes : inputs.text_bytes) += size_of(*path);
}

WholeInputs whole_inputs(const JobRequest& request, const Job& job, double rays) {
  WholeInputs inputs{.triangles = static_cast<double>(job.triangles),
                     .discs = static_cast<double>(job.disc_count()),
                     .rays = rays,
                     .rays_in_memory = rays,
                     .bands = static_cast<double>(std::max<std::size_t>(1, job.bands.size())),
                     .traced = job.field == sim::Field::photons && !job.rays_from_file && !job.without_rays,
                     .from_file = job.rays_from_file,
                     .piece_seconds = job.surface.piece_seconds};
  for (const auto* path : {&request.scene, &request.disc_file, &request.ray_file}) add_file(*path, inputs);
  const double block = static_cast<double>(sim::default_block(job.disc_count()));
  if (job.stream || (!job.rays_from_file && rays > block))
    inputs.rays_in_memory = static_cast<double>(sim::block_in_memory(job.disc_count()));
  return inputs;
}

WholeSeconds whole_seconds(const WholeInputs& inputs, const CostBreakdown& search, double pilot, int threads) {
  constexpr double start = 15'000;        // microseconds, of the program
  constexpr double concave = 12'000;      // deciding whether paths go on beyond surfaces
  constexpr double look_at_a_ray = 0.15;  // of a pilot
  const AccuracyCosts costs(static_cast<std::size_t>(inputs.triangles), threads);
  constexpr double first_touch = 0.03;  // of a ray's memory, where lines are drawn
  double trace = 0;
  if (inputs.traced && !inputs.from_file)
    trace = costs.on_one_thread(concave) + costs.caster() + seconds_of_pieces(inputs, costs, threads);
  else if (!inputs.from_file)
    trace = costs.lines().at(inputs.rays) + costs.on_one_thread(first_touch * inputs.rays_in_memory);
  return {.read = costs.read(inputs.text_bytes, inputs.binary_bytes, inputs.discs),
          .trace = trace,
          .prepare = search.order + search.build + costs.on_one_thread(look_at_a_ray * pilot),
          .search = search.total() - search.order - search.build,
          .rest = costs.on_one_thread(start)};
}

double peak_bytes(const WholeInputs& inputs, double bytes_touched) {
  constexpr double program = 19e6;
  constexpr double triangle = 330;  // mesh, vertices, and what traces photons
  constexpr double disc = 112;      // with its sample
  const double ray = static_cast<double>(sim::bytes_of_ray_in(static_cast<std::size_t>(inputs.bands)));
  const double piece = ray + 20;         // with photon, landing and triangle
  constexpr double traced_beside = 150;  // of pieces that are traced before they are in their place
  constexpr double most_beside = 0x1p18;
  // Of a ray of a block that is searched: its lists, in large pages, which few levels of a small index fill.
  const double deep = 1 - std::exp(-inputs.discs / 8000);
  const double lists = 200 * deep;
  const double block = static_cast<double>(sim::block_in_memory(static_cast<std::size_t>(inputs.discs)));
  const double searched = lists * std::min({inputs.rays, block, 0x1p19});
  double rays = 0;
  if (inputs.traced &&
      inputs.rays_in_memory < inputs.rays)  // what is traced ahead and kept until it is read comes in addition
    rays = (ray + std::max(200.0, 500 * deep)) * inputs.rays_in_memory;
  else if (inputs.traced)
    rays = piece * inputs.rays + std::max(searched, traced_beside * std::min(inputs.rays, most_beside));
  else
    rays = (inputs.from_file ? piece : ray) * inputs.rays_in_memory + 0.5 * searched;  // lines have no ends
  return program + triangle * inputs.triangles + disc * inputs.discs + rays + bytes_touched;
}

std::optional<double> measured_peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("VmHWM:")) continue;
    const auto digits = line.find_first_of("0123456789");
    double kilobytes = 0;
    if (digits == std::string::npos) return std::nullopt;
    std::from_chars(line.data() + digits, line.data() + line.size(), kilobytes);
    return 1024 * kilobytes;
  }
  return std::nullopt;
}

}  // namespace detp::validate
