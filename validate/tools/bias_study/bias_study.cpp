// How often the bias that a pilot states is true, in scenes whose irradiance is known in closed form.
//
//   cmake --build build --target bias_study && build/bias_study TABLE.csv [--seeds 10]
//
// A row for each scene, estimator, radius and seed: the bias of a pilot with its interval, and the true one, from long runs against the
// known irradiance. Then it prints how often the truth is inside.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/emitter.hpp"
#include "detp/sim/scene/resample.hpp"
#include "detp/validate/accuracy/accuracy_pilot.hpp"
#include "detp/validate/accuracy/error_split.hpp"
#include "detp/validate/accuracy/replicates.hpp"

namespace {

using namespace detp;

constexpr std::array estimators{sim::Estimator::disc, sim::Estimator::variable_radius, sim::Estimator::area_corrected};
constexpr std::array radii{0.02, 0.05, 0.1};  // of the scene's side, which is 1
constexpr double radiance = 10;

/// A scene, discs of its own, and their irradiance.
struct Known {
  std::string name;
  sim::Scene scene;
  std::vector<double> truth;
};

/// Adds a grid of cells over the parallelogram at `corner`.
void add_grid(sim::Mesh& mesh, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, std::uint32_t cells,
              std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      mesh.positions.push_back(corner + (1.0 * i / cells) * u + (1.0 * j / cells) * v);
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = first + j * (cells + 1) + i;
      const std::uint32_t c = a + cells + 2;
      mesh.triangles.push_back({a, a + 1, c});
      mesh.triangles.push_back({a, c, c - 1});
      mesh.materials.of_triangle.insert(mesh.materials.of_triangle.end(), 2, material);
    }
}

sim::Scene scene_of(sim::Mesh mesh, std::string name) {
  sim::Scene scene;
  scene.name = std::move(name);
  for (const glm::dvec3& position : mesh.positions) scene.box.include(position);
  scene.mesh = std::move(mesh);
  if (const double flux = sim::emitted_flux(scene.mesh); flux > 0) scene.lights = {{sim::SurfaceLight{}, flux}};
  return scene;
}

/// Materials of black surfaces and of a lamp.
sim::Mesh black_mesh() {
  sim::Mesh mesh;
  mesh.materials.all = {{.name = "black", .diffuse = 0}, {.name = "lamp", .diffuse = 0, .emitted = radiance}};
  return mesh;
}

/// Random places in [low, high]² of the floor z = 0.
std::vector<sim::Sample> on_floor(double low, double high, std::size_t count) {
  std::vector<sim::Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = sim::uniform4(3, sim::Stream::tests, i);
    samples.push_back({{low + (high - low) * place[0], low + (high - low) * place[1], 0}, {0, 0, 1}});
  }
  return samples;
}

/// Irradiance of a floor by a lamp that faces down, where `seen` says what is visible: midpoints of 100 by 100 parts.
double by_lamp(const glm::dvec3& point, const glm::dvec3& corner, double side,
               const std::function<bool(const glm::dvec3&, const glm::dvec3&)>& seen) {
  constexpr int parts = 100;
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      const glm::dvec3 from = corner + side / parts * glm::dvec3(i + 0.5, j + 0.5, 0);
      if (!seen(point, from)) continue;
      const glm::dvec3 way = from - point;
      const double square = glm::dot(way, way);
      sum += way.z * way.z / (square * square);
    }
  return radiance * sum * side * side / (parts * parts);
}

/// A lamp of 0.3 by 0.3 at z = 0.6 over a floor; `board`: a square board of 0.3 at z = 0.15 in between.
Known lamp_over_floor(bool board) {
  sim::Mesh mesh = black_mesh();
  add_grid(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 12, 0);
  add_grid(mesh, {0.35, 0.65, 0.6}, {0.3, 0, 0}, {0, -0.3, 0}, 1, 1);
  if (board) add_grid(mesh, {0.4, 0.4, 0.15}, {0.3, 0, 0}, {0, 0.3, 0}, 1, 0);
  Known known{board ? "lamp and board" : "lamp", scene_of(std::move(mesh), "lamp"), {}};
  known.scene.samples = on_floor(0.02, 0.98, 200);
  const auto seen = [board](const glm::dvec3& to, const glm::dvec3& from) {
    const glm::dvec3 at = to + (0.15 - to.z) / (from.z - to.z) * (from - to);
    return !board || at.x < 0.4 || at.x > 0.7 || at.y < 0.4 || at.y > 0.7;
  };
  for (const sim::Sample& sample : known.scene.samples)
    known.truth.push_back(by_lamp(sample.position, {0.35, 0.35, 0.6}, 0.3, seen));
  return known;
}

/// A point light over a floor.
Known point_over_floor() {
  sim::Mesh mesh = black_mesh();
  add_grid(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 12, 0);
  add_grid(mesh, {0, 0, 0.5}, {0.01, 0, 0}, {0, 0.01, 0}, 1, 0);
  Known known{"point", scene_of(std::move(mesh), "point"), {}};
  const glm::dvec3 light(0.5, 0.5, 0.3);
  known.scene.lights = {{sim::PointLight{light}, 4 * std::numbers::pi}};
  known.scene.samples = on_floor(0.02, 0.98, 200);
  for (const sim::Sample& sample : known.scene.samples) {
    const double distance = glm::distance(light, sample.position);
    known.truth.push_back(light.z / std::pow(distance, 3));
  }
  return known;
}

/// Two black rooms of half the side, with a door; a lamp in the first one.
Known two_rooms() {
  sim::Mesh mesh = black_mesh();
  add_grid(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 12, 0);
  add_grid(mesh, {0, 1, 0.5}, {1, 0, 0}, {0, -1, 0}, 12, 0);
  add_grid(mesh, {0, 0, 0}, {0, 1, 0}, {0, 0, 0.5}, 6, 0);
  add_grid(mesh, {1, 1, 0}, {0, -1, 0}, {0, 0, 0.5}, 6, 0);
  add_grid(mesh, {1, 0, 0}, {-1, 0, 0}, {0, 0, 0.5}, 6, 0);
  add_grid(mesh, {0, 1, 0}, {1, 0, 0}, {0, 0, 0.5}, 6, 0);
  add_grid(mesh, {0.5, 0, 0}, {0, 0.4, 0}, {0, 0, 0.5}, 4, 0);
  add_grid(mesh, {0.5, 0.6, 0}, {0, 0.4, 0}, {0, 0, 0.5}, 4, 0);
  add_grid(mesh, {0.15, 0.6, 0.48}, {0.2, 0, 0}, {0, -0.2, 0}, 1, 1);
  Known known{"two rooms", scene_of(std::move(mesh), "two rooms"), {}};
  known.scene.samples = on_floor(0.02, 0.98, 200);
  std::erase_if(known.scene.samples, [](const sim::Sample& one) { return std::abs(one.position.x - 0.5) < 1e-3; });
  const auto seen = [](const glm::dvec3& to, const glm::dvec3& from) {
    if (to.x < 0.5) return true;
    const double y = to.y + (0.5 - to.x) / (from.x - to.x) * (from.y - to.y);
    return y > 0.4 && y < 0.6;
  };
  for (const sim::Sample& sample : known.scene.samples)
    known.truth.push_back(by_lamp(sample.position, {0.15, 0.4, 0.48}, 0.2, seen));
  return known;
}

/// The closed diffuse box: all of its walls, edges too, or the middle of the floor alone.
Known furnace(bool middle) {
  Known known{middle ? "middle of a wall" : "furnace", sim::open_scene({.name = "@furnace", .samples = {}}), {}};
  auto& samples = known.scene.samples;
  samples.clear();
  if (!middle) sim::add_by_area(samples, known.scene.mesh, 200, 5);
  for (int i = 0; middle && i < 25; ++i) samples.push_back({{0.3 + 0.1 * (i % 5), 0, 0.3 + 0.1 * (i / 5)}, {0, 1, 0}});
  known.truth.assign(samples.size(), *known.scene.known_irradiance);
  return known;
}

struct Row {
  std::string scene;
  std::string_view estimator;
  double radius = 0;
  std::uint64_t seed = 0;
  validate::RootInterval stated;
  double mean = 0;
  validate::Estimate true_squared;
  double true_mean = 0;

  [[nodiscard]] double truth() const { return std::sqrt(std::max(0.0, true_squared.mean)); }
  [[nodiscard]] bool inside() const { return truth() >= stated.low && truth() <= stated.high; }
};

/// The true bias: of 32 runs of many rays.
validate::ErrorSplit true_error(validate::ReplicateMaker& maker, const Known& known,
                                const validate::AccuracySetting& setting) {
  std::vector<std::vector<double>> runs;
  for (std::uint64_t seed = 1; seed <= 32; ++seed)
    runs.push_back(maker.estimate(maker.trace(100'000, 1'000'000 + seed, setting.radius), known.scene.samples, setting)
                       .irradiance);
  const std::vector<double> exact(known.truth.size());
  return validate::split_error(runs, {known.truth, exact});
}

void add_rows(Known& known, std::uint64_t seeds, double rays, std::uint64_t paths, std::vector<Row>& rows) {
  std::vector<validate::ErrorSplit> truths;
  validate::ReplicateMaker maker(known.scene, false, 0);
  for (const sim::Estimator estimator : estimators)
    for (const double radius : radii) truths.push_back(true_error(maker, known, {estimator, radius}));
  const std::vector<double> equal(known.truth.size(), 1.0 / static_cast<double>(known.truth.size()));
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const validate::AccuracyPilot pilot =
        validate::make_accuracy_pilot(known.scene, {.estimators = {estimators.begin(), estimators.end()},
                                                    .rays = rays,
                                                    .paths = paths,
                                                    .radii = {radii.begin(), radii.end()},
                                                    .weights = equal,
                                                    .seed = seed});
    std::size_t number = 0;
    for (const validate::EstimatorPilot& one : pilot.estimators)
      for (const validate::SettingPilot& setting : one.settings) {
        const validate::ErrorSplit& truth = truths[number++];
        rows.push_back({known.name, name(one.estimator), setting.setting.radius, seed,
                        root_of(setting.bias_squared, one.runs), setting.mean_bias.mean, truth.bias_squared,
                        truth.mean_bias.mean});
      }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How often the stated bias is true");
  std::string table;
  std::uint64_t seeds = 10;
  double rays = 640'000;
  std::uint64_t paths = 1024;
  app.add_option("TABLE", table, "CSV file")->required();
  app.add_option("--seeds", seeds, "pilots of each scene")->capture_default_str();
  app.add_option("--rays", rays, "of a pilot")->capture_default_str();
  app.add_option("--paths", paths, "of its judge")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<Row> rows;
    for (Known& known : std::vector<Known>{furnace(false), furnace(true), lamp_over_floor(false), lamp_over_floor(true),
                                           point_over_floor(), two_rooms()}) {
      const std::size_t before = rows.size();
      add_rows(known, seeds, rays, paths, rows);
      const auto of_scene = std::span(rows).subspan(before);
      const auto inside = std::ranges::count_if(of_scene, &Row::inside);
      double widest = 0;
      for (const Row& row : of_scene) widest = std::max(widest, 0.5 * (row.stated.high - row.stated.low));
      fmt::print("{}: {} of {} inside, half width at most {:.2g} %\n", known.name, inside, of_scene.size(),
                 100 * widest);
    }
    std::ofstream csv(table);
    csv << "scene,estimator,radius,seed,bias,bias_low,bias_high,mean_bias,true_bias,true_mean_bias\n";
    for (const Row& row : rows)
      csv << fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", row.scene, row.estimator,
                         row.radius, row.seed, row.stated.value, row.stated.low, row.stated.high, row.mean, row.truth(),
                         row.true_mean);
    fmt::print("{} of {} inside\n", std::ranges::count_if(rows, &Row::inside), rows.size());
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
