// Noise, bias and total error of each estimator, against references, in several scenes.
//
//   cmake --build build --target accuracy_study && build/accuracy_study TABLE.csv [--scenes @cornell,bunny.obj]
//
// A row for each scene, estimator, setting and number of rays (of gather: backward paths of each sample): from 8 runs with their own
// seeds at up to 2000 of the scene's samples, by area.
// Rows that the table has are not made again. Then it prints which estimator is best in each scene, with equal photons and in equal time.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/accuracy_rows.hpp"
#include "detp/validate/accuracy/error_split.hpp"
#include "detp/validate/accuracy/reference.hpp"
#include "detp/validate/accuracy/replicates.hpp"

namespace {

using namespace detp;

constexpr std::size_t runs = 8;
constexpr std::array all_rays{std::size_t{10'000}, std::size_t{100'000}, std::size_t{1'000'000}};
constexpr std::array all_paths{std::uint64_t{16}, std::uint64_t{64}, std::uint64_t{256}};

/// Settings with one radius, and those that do not use it with the first.
std::vector<validate::AccuracySetting> settings_of(double radius, bool first) {
  using enum sim::Estimator;
  std::vector<validate::AccuracySetting> all{{disc, radius}, {variable_radius, radius}, {area_corrected, radius}};
  if (!first) return all;
  for (const int k : {10, 50, 200}) all.push_back({.estimator = nearest, .nearest = k});
  all.push_back({.estimator = triangle_hits});
  return all;
}

struct Times {
  double trace = 0;
  double estimate = 0;
};

class Study {
 public:
  Study(const std::string& name, const std::string& table)
      : table_(table), scene_(sim::open_scene({.name = name, .samples = {}})) {
    label_ = std::filesystem::path(name).filename().string();
    distance_ = sim::mean_edge_length(scene_.mesh);
  }

  void run(std::vector<validate::AccuracyRow>& all) {
    const bool done = std::ranges::count_if(all, [&](const auto& row) { return row.scene == label_; }) >=
                      static_cast<std::ptrdiff_t>(all_rays.size() * rows_of_rays() + all_paths.size());
    if (done) return;
    std::erase_if(all, [&](const auto& row) { return row.scene == label_; });
    const validate::Reference reference = validate::make_reference(scene_);
    fmt::print(stderr, "{}: reference by {}, error {:.2g}, {:.0f} s\n", label_, name(reference.kind), reference.error(),
               reference.seconds);
    validate::ReplicateMaker maker(scene_, false, 0);
    for (const std::size_t rays : all_rays)
      for (const double share : validate::radii_over_distance) {
        const auto settings = settings_of(share * distance_, share == validate::radii_over_distance.front());
        std::vector<std::vector<std::vector<double>>> found(settings.size());
        std::vector<Times> times(settings.size());
        double photons = 0;
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
          sim::Stopwatch watch;
          const sim::Paths paths = maker.trace(rays, 1000 + seed, share * distance_);
          const double traced = watch.seconds();
          photons += static_cast<double>(paths.photon_count) / runs;
          for (std::size_t i = 0; i < settings.size(); ++i) {
            if (settings[i].estimator == sim::Estimator::nearest &&
                static_cast<std::size_t>(settings[i].nearest) > paths.rays.size() / 4)
              continue;
            found[i].push_back(maker.estimate(paths, reference.judged.samples, settings[i]).irradiance);
            times[i].trace += traced / runs;
            if (seed == 1) times[i].estimate = maker.estimate(paths, scene_.samples, settings[i]).seconds.total();
          }
        }
        for (std::size_t i = 0; i < settings.size(); ++i)
          if (!found[i].empty())
            all.push_back(row_of(settings[i], share, static_cast<double>(rays), photons,
                                 validate::split_error(found[i], reference.values()), times[i], reference));
      }
    for (const std::uint64_t paths : all_paths) all.push_back(gathered(maker, reference, paths));
    std::ofstream csv(table_);
    csv << validate::accuracy_header();
    for (const validate::AccuracyRow& row : all) csv << csv_row(row);
  }

 private:
  /// Seconds are those at the judged samples, in proportion.
  [[nodiscard]] validate::AccuracyRow gathered(const validate::ReplicateMaker& maker,
                                               const validate::Reference& reference, std::uint64_t paths) const {
    const auto& judged = reference.judged.samples;
    std::vector<std::vector<double>> found;
    const sim::Stopwatch watch;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
      std::vector<double>& run = found.emplace_back();
      for (const sim::PathSums& sums : maker.gather(judged, paths, 1000 + seed)) run.push_back(sums.irradiance());
    }
    const double samples = static_cast<double>(scene_.samples.size()) / static_cast<double>(judged.size());
    return row_of({.estimator = sim::Estimator::gather}, 0, static_cast<double>(paths), 0,
                  validate::split_error(found, reference.values()), {0, samples * watch.seconds() / runs}, reference);
  }

  static std::size_t rows_of_rays() { return 3 * validate::radii_over_distance.size() + 4; }

  [[nodiscard]] validate::AccuracyRow row_of(const validate::AccuracySetting& setting, double share, double rays,
                                             double photons, const validate::ErrorSplit& split, const Times& times,
                                             const validate::Reference& reference) const {
    const auto noise = validate::root_of(split.noise_squared, runs);
    const auto bias = validate::root_of(split.bias_squared, runs);
    const auto total = validate::root_of(split.total_squared, runs);
    const bool radius = validate::uses_radius(setting.estimator);
    return {.scene = label_,
            .estimator = std::string(name(setting.estimator)),
            .radius = radius ? share : 0,
            .nearest = setting.estimator == sim::Estimator::nearest ? double(setting.nearest) : 0,
            .rays = rays,
            .photons = photons,
            .noise = noise.value,
            .noise_low = noise.low,
            .noise_high = noise.high,
            .bias = bias.value,
            .bias_low = bias.low,
            .bias_high = bias.high,
            .total = total.value,
            .total_low = total.low,
            .total_high = total.high,
            .within = split.share_within,
            .error_95 = split.error_95,
            .worst = split.worst,
            .trace_seconds = times.trace,
            .estimate_seconds = times.estimate,
            .reference = std::string(name(reference.kind)),
            .reference_error = reference.error()};
  }

  std::string table_;
  std::string label_;
  sim::Scene scene_;
  double distance_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Noise, bias and total error of each estimator, against references");
  std::string table;
  std::vector<std::string> scenes{"@cornell", "@caustic", "@interior", "@tree"};
  app.add_option("TABLE", table, "CSV file")->required();
  app.add_option("--scenes", scenes, "built-in scenes and meshes")->delimiter(',')->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<validate::AccuracyRow> rows;
    if (std::ifstream before(table); before) rows = validate::read_accuracy_rows(before);
    for (const std::string& scene : scenes) Study(scene, table).run(rows);
    fmt::print("{}", validate::accuracy_summary(rows));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
