// Rules that end a run when its error is small enough, over many runs.
//
//   cmake --build build --target stopping_study
//   build/stopping_study scenes TABLE.csv [--seeds 50]
//   build/stopping_study rules TABLE.csv [--runs 4000]
//
// scenes: runs of several estimators, the error at the end against a long run. Two rules: that of run_until, and a naive one, which looks
// after each pair of batches and takes the noise found for the error. A row for each run. Cases that the table has are not made again.
// rules: one mean of independent values whose distribution is known. A row for each rule and distribution.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "detp/validate/stopping/run_until.hpp"
#include "scalar_rules.hpp"

namespace {

using namespace detp;

constexpr double first_rays = 1 << 16;
constexpr std::uint64_t rays_of_naive_batch = 1 << 11;
constexpr double reference_over_run = 40;  // rays

struct Case {
  std::string name;
  std::string scene;
  sim::Estimator estimator = sim::Estimator::disc;
  double target = 0.1;
  bool lines = false;
  std::uint64_t least_seeds = 0;
};

std::vector<Case> cases() {
  using enum sim::Estimator;
  return {{"@furnace", "@furnace", disc, 0.05},
          {"@cornell", "@cornell", disc, 0.1},
          {"@cornell", "@cornell", disc, 0.05, false, 100},
          {"@caustic", "@caustic", disc, 0.1},
          {"@tree", "@tree", disc, 0.2},
          {"lines in @cornell", "@cornell", disc, 0.1, true},
          {"@interior", "@interior", disc, 0.1},
          {"@cornell", "@cornell", area_corrected, 0.1},
          {"@caustic", "@caustic", triangle_hits, 0.1}};
}

validate::Job job_of(const Case& one, std::uint64_t seed, double rays) {
  validate::JobRequest request;
  request.scene = one.scene;
  request.rays = rays;
  request.seed = seed;
  request.keep_scene = true;
  request.field = one.lines ? sim::Field::isotropic : sim::Field::photons;
  request.threads = 0;
  return validate::make_job(request);
}

/// The job's rays, batch by batch, and their irradiance.
class Batches {
 public:
  Batches(const Case& one, std::uint64_t seed)
      : job_(job_of(one, seed, first_rays)),
        search_(job_, one.estimator, {Technique::box_tree, BoxTreeParameters{8, 16}}, {.count = false, .threads = 0}),
        rays_(job_) {}

  std::optional<validate::Batch> next(std::uint64_t rays) {
    const auto made = rays_.next(rays);
    if (!made) return std::nullopt;
    validate::Batch batch{search_(made->rays).irradiance, made->photons, made->rays.rays.size()};
    for (double& irradiance : batch.irradiance) irradiance *= made->scale;
    return batch;
  }
  [[nodiscard]] std::vector<double> weights() const { return validate::weights_of(job_); }

 private:
  validate::Job job_;
  validate::JobSearch search_;
  validate::JobBatches rays_;
};

/// A long run, and its own square error.
struct Reference {
  std::vector<double> irradiance;
  std::vector<double> weights;
  double mean_square = 0;
  double own_square = 0;
};

Reference reference_of(const Case& one, double rays) {
  Batches batches(one, 987'654);
  validate::PairedBatches sums(batches.weights());
  constexpr int count = 64;
  for (int i = 0; i < count; ++i) {
    const auto batch = batches.next(static_cast<std::uint64_t>(rays / count));
    sums.add(batch->irradiance, batch->photons);
  }
  const double noise = sums.noise(0.95).value;
  return {sums.irradiance(), batches.weights(), sums.mean_square(), noise * noise * sums.mean_square()};
}

double error_of(const std::vector<double>& found, const Reference& reference) {
  double square = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    square += reference.weights[i] * std::pow(found[i] - reference.irradiance[i], 2);
  return std::sqrt(std::max(0.0, square - reference.own_square) / reference.mean_square);
}

validate::UntilResult naive(Batches& batches, double target) {
  validate::PairedBatches sums(batches.weights());
  validate::UntilResult result;
  while (!(result.noise.value > 0 && result.noise.value <= target)) {
    for (int i = 0; i < 2; ++i) {
      const auto batch = batches.next(rays_of_naive_batch);
      sums.add(batch->irradiance, batch->photons);
      result.rays += batch->rays;
    }
    result.noise = sums.noise(0.95);
    if (!std::isfinite(result.noise.value)) result.noise.value = 0;
  }
  result.irradiance = sums.irradiance();
  result.photons = sums.photons();
  return result;
}

std::string label(const Case& one) { return fmt::format("{},{},{}", one.name, name(one.estimator), one.target); }

void run(const Case& one, std::uint64_t seeds, std::ostream& table) {
  seeds = std::max(seeds, one.least_seeds);
  std::vector<std::pair<std::string, validate::UntilResult>> results;
  std::vector<double> rays;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Batches batches(one, seed);
    results.emplace_back(
        "pairs of batches",
        validate::run_until([&](std::uint64_t count, std::uint64_t) { return batches.next(count); }, batches.weights(),
                            {.error = one.target}, {.first_rays = static_cast<std::uint64_t>(first_rays)}));
    rays.push_back(static_cast<double>(results.back().second.rays));
    Batches again(one, seed);
    results.emplace_back("naive", naive(again, one.target));
  }
  const Reference reference = reference_of(one, reference_over_run * validate::median(rays));
  int kept = 0;
  std::string text;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& [rule, result] = results[i];
    const double error = error_of(result.irradiance, reference);
    kept += rule != "naive" && error <= one.target ? 1 : 0;
    text += fmt::format("{},{},{},{},{:.0f},{},{},{},{}\n", label(one), rule, i / 2 + 1, result.rays, result.photons,
                        result.noise.value, result.noise.low, result.noise.high, error);
  }
  table << text << std::flush;
  fmt::print("{}: {} of {} below the target\n", label(one), kept, seeds);
  std::fflush(stdout);
}

void study_scenes(const std::string& path, std::uint64_t seeds) {
  std::set<std::string> done;
  std::ifstream before(path);
  for (std::string line; std::getline(before, line);) {
    std::istringstream fields(line);
    std::string name;
    std::string estimator;
    std::string target;
    std::getline(std::getline(std::getline(fields, name, ','), estimator, ','), target, ',');
    done.insert(fmt::format("{},{},{}", name, estimator, target));
  }
  std::ofstream table(path, std::ios::app);
  if (done.empty()) table << "scene,estimator,target,rule,seed,rays,photons,noise,noise_low,noise_high,error\n";
  for (const Case& one : cases())
    if (!done.contains(label(one))) run(one, seeds, table);
}

void study_rules(const std::string& path, std::uint64_t runs) {
  constexpr double error = 0.1;
  constexpr double first = 20;  // of the best fixed size: the number of values before a rule can know anything
  constexpr double looks = 50;  // in the best fixed size
  std::ofstream table(path);
  table << "distribution,rule,source,target,confidence,runs,inside,size_over_best,size_over_best_95\n";
  for (const tools::Distribution& distribution :
       {tools::hits("hits 10 %", 0.1), tools::hits("hits 1 %", 0.01), tools::hits("hits 0.1 %", 0.001),
        tools::uneven_hits("hits 10 %, uneven powers", 0.1, 0.7),
        tools::uneven_hits("hits 1 %, uneven powers", 0.01, 1)})
    for (const tools::ScalarRule& rule : tools::scalar_rules()) {
      tools::ScalarTarget target{.error = error};
      const double best = tools::best_fixed_size(distribution, target);
      target.first = best / first;
      target.look = best / looks;
      std::uint64_t inside = 0;
      std::vector<double> sizes;
      for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        tools::Stream stream(distribution, seed);
        const auto end = rule.run(stream, target);
        if (!end) break;
        inside += std::abs(end->estimate / distribution.mean() - 1) <= error ? 1 : 0;
        sizes.push_back(end->values / best);
      }
      if (sizes.empty()) continue;
      table << fmt::format("\"{}\",\"{}\",\"{}\",{},{},{},{},{:.4g},{:.4g}\n", distribution.name, rule.name,
                           rule.source, error, target.confidence, runs, inside, validate::median(sizes),
                           validate::quantile(sizes, 0.95))
            << std::flush;
    }
}

int study(int argc, char** argv) {
  CLI::App app("How often a run ends with an error below its target");
  std::string path;
  std::uint64_t seeds = 50;
  std::uint64_t runs = 4000;
  auto* scenes = app.add_subcommand("scenes", "runs in scenes");
  scenes->add_option("TABLE", path, "CSV; rows are appended")->required();
  scenes->add_option("--seeds", seeds, "runs of each case");
  auto* rules = app.add_subcommand("rules", "one mean");
  rules->add_option("TABLE", path, "CSV")->required();
  rules->add_option("--runs", runs, "of each rule and distribution");
  app.require_subcommand(1);
  CLI11_PARSE(app, argc, argv);
  if (*scenes)
    study_scenes(path, seeds);
  else
    study_rules(path, runs);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return study(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stopping_study: {}\n", error.what());
    return 2;
  }
}
