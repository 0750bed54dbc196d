// How often are the counts and seconds that a pilot predicts within twice the errors that it states?
//
//   cmake --build build --target pilot_errors && build/pilot_errors TABLE.csv --seeds 5001-5060
//
// Each seed is a search: of a tiny object on a huge floor, of dense objects in a closed room, or of clusters in empty
// space. The program chooses by a pilot, runs the choice, and adds a row for each count and for the seconds to the
// table. Seeds that the table has are not run again. Then it prints a summary of the whole table. About a tenth of a second
// for each search, one thread.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/own_time.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "sparse_search.hpp"
#include "stated_errors.hpp"

namespace {

using namespace detp;

constexpr std::array judged{&Counts<double>::cull_tests, &Counts<double>::culls,      &Counts<double>::listed,
                            &Counts<double>::visits,     &Counts<double>::disc_tests, &Counts<double>::made,
                            &Counts<double>::hits};

std::string_view name_of(double Counts<double>::*term) {
  for (const auto& [name, other] : count_terms<double>)
    if (other == term) return name;
  return "";
}

double seconds_of(const sim::Problem& problem, const Prediction& choice) {
  constexpr int runs = 5;
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const validate::OwnTime time(choice.threads);
    const sim::Outcome outcome = sim::run(problem, choice.candidate, {.count = false, .threads = choice.threads});
    seconds.push_back(time.own_part_of(outcome.seconds.total()));
  }
  return validate::median(seconds);
}

/// Nothing if a closed form was chosen, the errors of which are not stated.
std::vector<study::StatedError> judge(const study::SparseSearch& search, const std::string& mesh_file,
                                      const CostTable& costs) {
  std::ofstream(mesh_file) << search.mesh;
  validate::JobRequest request;
  request.scene = mesh_file;
  request.rays = search.rays;
  request.disc_radius = validate::Length{search.radius, true};
  request.field = search.field;
  request.seed = search.seed;
  const validate::Job job = validate::make_job(request);
  std::filesystem::remove(mesh_file);
  const sim::Problem& problem = job.problem();
  const auto found =
      validate::choose({.problem = &problem, .workload = job.workload(), .disabled = {Technique::brute_force}}, costs);
  const Prediction& choice = found.best();
  if (choice.source == Source::closed_form) return {};
  const auto counted = as_expected(sim::run(problem, choice.candidate).counts);
  const auto& shape = std::get<BoxTreeParameters>(choice.candidate.parameters);
  const std::string columns =
      fmt::format("{},{},{},{},{:.4f},{}/{}", search.kind, search.field == sim::Field::isotropic ? "lines" : "photons",
                  job.rays.size(), job.discs.size(), search.radius, shape.fan_out, shape.leaf);
  std::vector<study::StatedError> errors;
  for (const auto term : judged)
    errors.push_back({search.seed, columns, std::string(name_of(term)), choice.counts.*term, choice.counts_error.*term,
                      counted.*term});
  errors.push_back({search.seed, columns, "seconds", choice.time.total(), choice.error, seconds_of(problem, choice)});
  return errors;
}

std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text) {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  const char* const end = text.data() + text.size();
  const auto [dash, bad_first] = std::from_chars(text.data(), end, first);
  if (bad_first != std::errc() || dash == end || *dash != '-')
    throw std::invalid_argument("--seeds must be FIRST-LAST (got " + text + ")");
  const auto [rest, bad_last] = std::from_chars(dash + 1, end, last);
  if (bad_last != std::errc() || rest != end || last < first)
    throw std::invalid_argument("--seeds must be FIRST-LAST (got " + text + ")");
  return {first, last};
}

void study_errors(const std::string& table, const std::string& seeds, const std::string& costs_file) {
  const auto [first, last] = parse_seeds(seeds);
  const CostTable costs = costs_file == "built-in" ? validate::built_in_unit_costs()
                                                   : validate::read_calibration(costs_file).of(Engine::simd);
  std::vector<study::StatedError> all;
  if (std::ifstream before(table); before) all = study::read_stated_errors(before);
  std::set<std::uint64_t> done;
  for (const study::StatedError& one : all) done.insert(one.seed);
  std::ofstream csv(table, std::ios::app);
  if (all.empty() && std::filesystem::file_size(table) == 0) csv << study::stated_errors_header;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    if (done.contains(seed)) continue;
    const auto errors = judge(study::sparse_search(seed), table + ".obj", costs);
    if (errors.empty()) fmt::print(stderr, "seed {}: the choice has a closed form, not a pilot\n", seed);
    std::string rows;
    for (const study::StatedError& one : errors) rows += csv_row(one);
    csv << rows << std::flush;
    all.insert(all.end(), errors.begin(), errors.end());
  }
  fmt::print("{}", study::summary(all));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How often are the counts and seconds that a pilot predicts within twice the errors that it states?");
  std::string table;
  std::string seeds = "1-60";
  std::string costs = "built-in";
  app.add_option("TABLE", table, "CSV file; rows are added to it")->required();
  app.add_option("--seeds", seeds, "FIRST-LAST")->capture_default_str();
  app.add_option("--costs", costs, "built-in, or a file that detp calibrate wrote")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    study_errors(table, seeds, costs);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
