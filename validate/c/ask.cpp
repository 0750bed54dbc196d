#include <array>
#include <cstring>
#include <utility>

#include "detp/sim/files/result_file.hpp"
#include "detp/validate/cli/command_line.hpp"
#include "detp/validate/run/disc_mesh.hpp"
#include "detp/validate/run/run.hpp"
#include "guard.hpp"

using namespace detp;

/// What a run found, as arrays.
struct detp_run {
  std::string json;
  std::vector<double> centres;
  std::vector<double> normals;
  std::vector<double> radii;
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance;
  std::vector<double> standard_error;
  std::vector<double> upper_bound;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

namespace {

std::vector<std::string> strings(const char* const* words, std::size_t count) {
  std::vector<std::string> all;
  if (count > 0) c::given(words, "words");
  for (std::size_t i = 0; i < count; ++i) all.emplace_back(&c::given(words[i], "a word"));
  return all;
}

std::string text_of(const cli::Json& json) { return json.dump(-1, ' ', false, cli::Json::error_handler_t::replace); }

void add_discs(detp_run& run, const validate::Job& job) {
  const sim::DiscsInMemory in_memory(job.discs);
  const sim::DiscSource& discs = job.stored_discs ? *job.stored_discs : in_memory;
  sim::for_each_block(discs, {}, [&](std::uint64_t, std::span<const sim::Disc> block) {
    for (const sim::Disc& disc : block) {
      run.centres.insert(run.centres.end(), {disc.centre.x, disc.centre.y, disc.centre.z});
      run.normals.insert(run.normals.end(), {disc.normal.x, disc.normal.y, disc.normal.z});
      run.radii.push_back(disc.radius);
    }
  });
}

void add_results(detp_run& run, const validate::JobRun& found) {
  const bool errors = found.results ? found.results->errors() : !found.outcome.standard_error.empty();
  validate::for_each_disc(found, [&](std::span<const sim::DiscResult> by_band) {
    run.hits.push_back(by_band.front().hits);
    for (const sim::DiscResult& one : by_band) {
      run.irradiance.push_back(one.irradiance);
      if (!errors) continue;
      run.standard_error.push_back(one.standard_error);
      run.upper_bound.push_back(one.upper_bound);
    }
  });
}

}  // namespace

extern "C" {

detp_status detp_run_create(const char* const* words, size_t count, detp_progress progress, void* user, detp_run** run,
                            detp_error* error) {
  return c::guarded(error, [&] {
    detp_run*& made = c::given(run, "run");
    const c::Watch watch(progress, user, "working");
    const cli::AskedRun asked = cli::ask_run(strings(words, count), watch.token());
    auto one = std::make_unique<detp_run>();
    one->json = text_of(asked.json);
    add_discs(*one, asked.run->job);
    add_results(*one, asked.run->answer.run);
    one->triangles = validate::triangles_of_discs(asked.run->job);
    made = one.release();
  });
}

detp_status detp_run_look(const detp_run* run, detp_run_view* view, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_run& one = c::given(run, "run");
    detp_run_view ours = c::known(view, "view");
    const auto array = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
    ours.discs = one.radii.size();
    ours.centres = array(one.centres);
    ours.normals = array(one.normals);
    ours.radii = array(one.radii);
    ours.hits = array(one.hits);
    ours.irradiance = array(one.irradiance);
    ours.standard_error = array(one.standard_error);
    ours.upper_bound = array(one.upper_bound);
    ours.json = one.json.c_str();
    ours.triangles = one.triangles.size();
    ours.corners = one.triangles.empty() ? nullptr : one.triangles.front().data();
    ours.bands = one.hits.empty() ? 1 : one.irradiance.size() / one.hits.size();
    c::write_back(view, ours);
  });
}

void detp_run_free(detp_run** run) {
  if (run == nullptr) return;
  delete *run;
  *run = nullptr;
}

detp_status detp_results_write(const char* path, const detp_column* columns, size_t count, size_t rows,
                               const uint32_t* corners, size_t triangles, detp_error* error) {
  return c::guarded(error, [&] {
    if (count == 0) throw std::invalid_argument("a file of results needs a column");
    std::vector<sim::ResultColumn> all;
    for (std::size_t i = 0; i < count; ++i) {
      const detp_column& one = (&c::given(columns, "columns"))[i];
      if (one.kind < DETP_REAL || one.kind > DETP_INDEX) throw std::invalid_argument("a column has an unknown kind");
      if (rows > 0) c::given(one.numbers, "the numbers of a column");
      all.push_back({&c::given(one.name, "the name of a column"), static_cast<sim::ResultColumn::Kind>(one.kind)});
    }
    std::vector<std::array<std::uint32_t, 3>> all_triangles(corners == nullptr ? 0 : triangles);
    for (std::size_t i = 0; i < 3 * all_triangles.size(); ++i) {
      if (corners[i] >= rows) throw std::invalid_argument("a corner of a triangle is no row");
      all_triangles[i / 3][i % 3] = corners[i];
    }
    sim::ResultFile file(&c::given(path, "path"), std::move(all), rows, {.triangles = all_triangles}, "rows", {});
    std::vector<double> row(count);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t column = 0; column < count; ++column) row[column] = columns[column].numbers[i];
      file.write(row);
    }
    file.commit();
  });
}

detp_status detp_ask(const char* const* words, size_t count, detp_progress progress, void* user, char** json,
                     detp_error* error) {
  return c::guarded(error, [&] {
    char*& text = c::given(json, "json");
    const c::Watch watch(progress, user, "working");
    const std::string answer = text_of(cli::ask(strings(words, count), watch.token()));
    text = new char[answer.size() + 1];
    std::memcpy(text, answer.c_str(), answer.size() + 1);
  });
}

void detp_text_free(char** text) {
  if (text == nullptr) return;
  delete[] * text;
  *text = nullptr;
}
}
