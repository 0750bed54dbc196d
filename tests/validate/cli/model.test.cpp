#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "detp/model/accuracy/nearest_photons.hpp"
#include "detp/model/disc_index/disc_index.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

using doctest::Approx;

constexpr double rays = 3e5;
constexpr double samples = 2e4;
constexpr double disc = 0.01;
constexpr double outer = 1.7;
const std::string model_command =
    "model --rays 300000 --samples 20000 --disc-radius 0.01 --sphere-radius 1.7 --costs t=3,u=5 ";

Approx near(double value) { return Approx(value).epsilon(1e-12); }

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the published sphere cache is the sum of the paper's terms") {
    for (const double ratio : {0.3, 0.5, 0.65, 0.8}) {
      CAPTURE(ratio);
      const Json json = result_of(model_command + "--form published --ratio " + std::to_string(ratio));
      const auto k = static_cast<int>(std::ceil(std::log(disc / outer) / std::log(ratio)));
      CHECK(json.at("k") == k);
      REQUIRE(json.at("spheres").size() == static_cast<std::size_t>(k));
      double rebuild_time = 0;
      for (int i = 1; i <= k; ++i) {
        const Json& sphere = json.at("spheres")[static_cast<std::size_t>(i - 1)];
        const double rebuilds = std::pow(ratio, -3 * i);
        const double cost = 3 * rays * std::pow(ratio, 2 * (i - 1));
        CHECK(sphere.at("i") == i);
        CHECK(sphere.at("radius").get<double>() == near(outer * std::pow(ratio, i)));
        CHECK(sphere.at("rays").get<double>() == near(rays * std::pow(ratio, 2 * i)));
        CHECK(sphere.at("rebuilds").get<double>() == near(rebuilds));
        CHECK(sphere.at("rebuild_cost").get<double>() == near(cost));
        rebuild_time += std::min(samples, rebuilds) * cost;
      }
      const double intersect_time = 5 * samples * rays * std::pow(ratio, 2 * k);
      CHECK(json.at("rebuild_time").get<double>() == near(rebuild_time));
      CHECK(json.at("intersect_time").get<double>() == near(intersect_time));
      CHECK(json.at("total_time").get<double>() == near(rebuild_time + intersect_time));
    }
  }

  TEST_CASE("the corrected sphere cache ends at the last sphere that holds a disc, and its parts make its total") {
    for (const double ratio : {0.3, 0.5, 0.65, 0.8}) {
      CAPTURE(ratio);
      const Json json = result_of(model_command + "--ratio " + std::to_string(ratio));
      CHECK(json.at("form") == "corrected");
      CHECK(json.at("k") == static_cast<int>(std::floor(std::log(disc / outer) / std::log(ratio))));
      CHECK(json.at("spheres").back().at("radius").get<double>() >= disc);
      double rebuild_time = 0;
      double listed = rays;
      // Rays that cross the next larger sphere. The number of tests lies between the listed rays and this number.
      double around = rays;
      for (const Json& sphere : json.at("spheres")) {
        const int i = sphere.at("i");
        const double cost = sphere.at("rebuild_cost");
        CHECK(sphere.at("rays").get<double>() == near(rays * std::pow(ratio, 2 * i)));
        CHECK(cost >= 3 * listed * (1 - 1e-12));
        CHECK(cost <= 3 * around * (1 + 1e-12));
        CHECK(sphere.at("rebuilds").get<double>() <= samples * (1 + 1e-12));
        rebuild_time += sphere.at("rebuilds").get<double>() * cost;
        listed = sphere.at("listed");
        around = sphere.at("rays");
        CHECK(listed <= around * (1 + 1e-12));
      }
      CHECK(json.at("rebuild_time").get<double>() == Approx(rebuild_time).epsilon(1e-9));
      CHECK(json.at("intersect_time").get<double>() >= 5 * samples * listed * (1 - 1e-12));
      CHECK(json.at("intersect_time").get<double>() <= 5 * samples * around * (1 + 1e-12));
      CHECK(json.at("total_time").get<double>() ==
            near(json.at("rebuild_time").get<double>() + json.at("intersect_time").get<double>()));
    }
  }

  TEST_CASE("--levels limits the spheres shown, not those computed") {
    const Json all = result_of(model_command);
    const Json few = result_of(model_command + "--levels 2");
    CHECK(few.at("spheres").size() == 2);
    CHECK(few.at("spheres")[1] == all.at("spheres")[1]);
    CHECK(few.at("total_time") == all.at("total_time"));
  }

  TEST_CASE("a disc as large as S0 has no sphere, and every ray is tested with every disc") {
    for (const std::string radius : {"1", "1.5", "100"})
      for (const std::string form : {"corrected", "published"}) {
        INFO("radius ", radius, ", form ", form);
        const Json json = result_of("model --rays 300 --samples 20 --sphere-radius 1 --costs u=5 --disc-radius " +
                                    radius + " --form " + form);
        CHECK(json.at("k") == 0);
        CHECK(json.at("spheres").empty());
        CHECK(json.at("rebuild_time") == 0);
        CHECK(json.at("total_time").get<double>() == near(5.0 * 300 * 20));
      }
  }

  TEST_CASE("k is the form's own by default; its best stop is reported, and used on request" *
            doctest::test_suite("long")) {
    for (const std::string form : {"published", "corrected"}) {
      CAPTURE(form);
      const std::string line = model_command + "--ratio 0.65 --form " + form;
      const Json max = result_of(line);
      const Json best = result_of(line + " --spheres best");
      CHECK(max.at("k") == max.at("k_max"));
      CHECK(best.at("k") == best.at("k_best"));
      CHECK(best.at("k_max") == max.at("k_max"));
      CHECK(best.at("k_best") == max.at("k_best"));
      CHECK(best.at("k").get<int>() < max.at("k").get<int>());
      CHECK(result_of(line + " --spheres max").at("total_time") == max.at("total_time"));
      const double least = best.at("total_time");
      for (int k = 1; k <= max.at("k").get<int>(); ++k)
        CHECK(result_of(line + " --spheres " + std::to_string(k)).at("total_time").get<double>() >= least);
    }
  }

  TEST_CASE("unit costs may come in any order, and those not named are 0") {
    const std::string octree = "model --samples 4096 --disc-radius 0.01 --scene-side 2 --technique octree --costs ";
    const Json one = result_of(octree + "u=7,w=5,n=3");
    CHECK(one.at("total_time") == result_of(octree + "n=3,w=5,u=7").at("total_time"));
    CHECK(one.at("total_time").get<double>() == near(result_of(octree + "w=5").at("total_time").get<double>() +
                                                     result_of(octree + "n=3").at("total_time").get<double>()));
    CHECK(result_of(octree + "u=7").at("total_time") == 0);
    const Json grid = result_of("model --samples 4096 --disc-radius 0.01 --scene-side 2 --technique grid --costs v=2");
    CHECK(grid.at("total_time").get<double>() == near(2 * grid.at("counts").at("steps").get<double>()));
    const Json tests = result_of("model --samples 4096 --disc-radius 0.01 --scene-side 2 --ratio 0.6");
    CHECK(tests.at("total_time").get<double>() ==
          near(tests.at("counts").at("cull_tests").get<double>() + tests.at("counts").at("disc_tests").get<double>()));
  }

  TEST_CASE("k is reported however large it is: a tiny disc and Q next to 1 have 4e18 spheres") {
    const Json json =
        result_of("model --rays 1e6 --samples 1e6 --sphere-radius 1 --disc-radius 1e-200 --ratio 0.9999999999999999");
    CHECK(json.at("k") == 4'147'968'546'718'736'978);
    CHECK(json.at("parameters").at("spheres") == json.at("k"));
    CHECK(json.at("total_time").get<double>() > 1e18);
  }

  TEST_CASE("brute force tests every ray against every disc") {
    CHECK(result_of(model_command + "--technique brute-force").at("total_time").get<double>() ==
          near(5 * rays * samples));
  }

  TEST_CASE("cell spheres and the sphere tree are the sums over their levels") {
    const std::string side = "model --rays 300000 --samples 20000 --disc-radius 0.01 --scene-side 2 --costs t=3,u=5 ";
    for (const std::string technique :
         {"cell-spheres --depth 4", "cell-spheres", "sphere-tree --fan-out 4 --leaf 6", "sphere-tree"}) {
      CAPTURE(technique);
      const Json json = result_of(side + "--technique " + technique);
      double rebuild_time = 0;
      double listed = rays;
      for (const Json& sphere : json.at("spheres")) {
        CHECK(sphere.at("rebuild_cost").get<double>() == near(3 * listed));
        rebuild_time += sphere.at("rebuilds").get<double>() * sphere.at("rebuild_cost").get<double>();
        listed = sphere.at("rays");
      }
      CHECK(json.at("rebuild_time").get<double>() == Approx(rebuild_time).epsilon(1e-9));
      CHECK(json.at("intersect_time").get<double>() == near(5 * samples * listed));
    }
    const Json cells = result_of(side + "--technique cell-spheres --depth 4");
    CHECK(cells.at("parameters").at("depth") == 4);
    CHECK(cells.at("spheres").size() == 4);
    CHECK(cells.at("spheres")[0].at("rebuilds").get<double>() == near(8));
    const Json tree = result_of(side + "--technique sphere-tree --fan-out 4 --leaf 6");
    CHECK(tree.at("parameters") == Json{{"fan_out", 4}, {"leaf", 6}});
    CHECK(tree.at("spheres").back().at("rebuilds") == 3334);
    CHECK(tree.at("spheres").back().at("samples") == 6);
    CHECK(result_of(side + "--technique sphere-tree --levels 2").at("spheres").size() == 2);
  }

  TEST_CASE("the published octree is eq 22") {
    const std::string octree =
        "model --rays 1000 --samples 4096 --disc-radius 0.01 --scene-side 2 --costs w=5 --technique octree ";
    const Json json = result_of(octree + "--form published");
    CHECK(json.at("depth") == 6);  // 2/(2 · 0.01) = 100, between 2^6 and 2^7
    const Json four = result_of(octree + "--form published --depth 4");
    CHECK(four.at("cells_per_line").get<double>() == near(16));
    CHECK(four.at("discs_per_cell").get<double>() == near(1));
    CHECK(four.at("tests_per_line").get<double>() == near(16));
    CHECK(four.at("total_time").get<double>() == near(5.0 * 4 * 1000 * 16));
  }

  TEST_CASE("a line crosses n cells of a cube with n cells a side, and tests their discs") {
    const std::string cube = "model --rays 1000 --samples 4096 --disc-radius 0.01 --scene-side 2 --costs w=5 ";
    const double x = 0.01 / (2.02 / 16);
    const double endless = 1 + 1.5 * 3.14159265358979 * (x + x * x);
    for (const std::string index : {"--technique octree --depth 4", "--technique grid --cells 16"}) {
      CAPTURE(index);
      const Json json = result_of(cube + index);
      const double overlapped = json.at("cells_per_disc");
      CHECK(overlapped > 1);
      CHECK(overlapped < endless);
      CHECK(overlapped > 1 + 0.9 * (endless - 1));
      CHECK(json.at("cells_per_line").get<double>() == near(16));
      CHECK(json.at("discs_per_cell").get<double>() == near(overlapped));
      CHECK(json.at("tests_per_line").get<double>() == near(16 * overlapped));
      const double hit_box = 6 * 2.02 * 2.02 / (4 * 3.141592653589793 * std::pow(std::sqrt(3.0) + 0.01, 2));
      CHECK(json.at("intersect_time").get<double>() == near(5 * 1000 * hit_box * 16 * overlapped));
    }
  }

  TEST_CASE("the orders of growth of the best times, and the bytes of an index, are those of the library") {
    const std::string cube = "model --rays 1000 --samples 4096 --disc-radius 0.01 --scene-side 2 ";
    const Workload workload = cube_workload(1000, 4096, 0.01, 2);
    const Json octree = result_of(cube + "--technique octree --depth 4");
    CHECK(octree.at("growth_power").get<double>() == near(1.0 / 3));
    CHECK(octree.at("growth_logarithms") == 0);
    CHECK(octree.at("index_bytes").get<double>() == near(model::octree_bytes(workload, {4})));
    CHECK(result_of(cube + "--technique octree --form published").at("growth_logarithms") == 1);
    CHECK(result_of(cube + "--technique grid --cells 16").at("index_bytes").get<double>() ==
          near(model::grid_bytes(workload, {16})));
    CHECK(result_of(cube + "--order none").at("growth_power") == 1);
    CHECK(result_of(cube + "--dimension 2").at("growth_power") == 0);
    CHECK(result_of(cube + "--dimension 2").at("growth_logarithms") == 1);
    CHECK_FALSE(result_of(cube + "--dimension 1.5").contains("growth_power"));
  }

  TEST_CASE("errors of estimates: in a uniform field always, beside a curvature if there is one") {
    const Json even = result_of(model_command);
    CHECK(even.at("uniform_field_deviation").get<double>() ==
          near(model::uniform_field_deviation(rays, {disc}, {outer})));
    CHECK_FALSE(even.contains("density_error"));
    CHECK_FALSE(even.contains("rays_for_deviation"));
    const Json curved = result_of(model_command + "--curvature -12 --target-error 0.05");
    const double f = 1 / (2 * 3.141592653589793 * outer * outer);  // a line hits a disc with probability d²/(2r₀²)
    const model::SmoothDensity density{f, -12 * f};
    CHECK(curved.at("rays_for_deviation").get<double>() == near(model::rays_for_deviation(0.05, {disc}, {outer})));
    CHECK(curved.at("density_bias").get<double>() == near(-12 * disc * disc / 8));
    CHECK(curved.at("density_error").get<double>() ==
          near(std::sqrt(model::density_error(density, rays, disc).mean_square()) / f));
    CHECK(curved.at("best_density_radius").get<double>() == near(model::best_density_radius(density, rays)));
    const double nearest = model::best_nearest_photons(density, rays);
    CHECK(curved.at("best_nearest") == nearest);
    CHECK(curved.at("nearest_error").get<double>() ==
          near(std::sqrt(model::nearest_photons_error(density, rays, nearest).mean_square()) / f));
    CHECK(curved.at("plain_nearest_error").get<double>() ==
          near(std::sqrt(model::plain_nearest_photons_error(density, rays, nearest).mean_square()) / f));
    CHECK(curved.at("photons_for_error").get<double>() == near(model::photons_for_error(density, 0.05)));
    CHECK(curved.at("photons_for_nearest_error").get<double>() ==
          near(model::photons_for_nearest_error(density, 0.05)));
    CHECK_FALSE(result_of(model_command + "--curvature 0").contains("best_density_radius"));
    check_refused(
        {{model_command + "--target-error 0", "target-error"}, {model_command + "--curvature nan", "--curvature"}});
  }

  TEST_CASE("--target-error takes percentages and lists, and its results are columns of a table") {
    const Json share = result_of(model_command + "--target-error 0.05");
    const Json percentage = result_of(model_command + "--target-error 5%");
    CHECK(percentage.at("inputs").at("target_error") == share.at("inputs").at("target_error"));
    CHECK(percentage.at("rays_for_deviation") == share.at("rays_for_deviation"));
    check_refused({{model_command + "--target-error 5x", "5%"}, {model_command + "--target-error 0%", "target-error"}});
    const Json rows = result_of(model_command + "--levels 0 --ratio 0.5,0.6 --target-error 1%:5%:2%").at("rows");
    REQUIRE(rows.size() == 6);
    CHECK(rows[5].at("rays_for_deviation") == percentage.at("rays_for_deviation"));
    const std::string text = detp(model_command + "--ratio 0.5,0.6 --target-error 1%,5% --curvature -12").out;
    for (const char* column : {" target_error ", " rays_for_deviation ", " photons_for_error ", " radius_for_error "})
      CHECK_MESSAGE(text.find(column) != std::string::npos, column);
  }

  TEST_CASE("photons_for_error is at radius_for_error, the best for so many photons, and the text says so") {
    const std::string line = model_command + "--curvature -12 --target-error 5%";
    const Json json = result_of(line);
    const double f = 1 / (2 * 3.141592653589793 * outer * outer);
    const double photons = json.at("photons_for_error");
    const model::DensityError error =
        model::density_error({f, -12 * f}, photons, json.at("radius_for_error").get<double>());
    CHECK(std::sqrt(error.mean_square()) / f == Approx(0.05));
    CHECK(json.at("radius_for_error").get<double>() > 2 * disc);
    CHECK(detp(line).out.find("not with the given disc") != std::string::npos);
  }

  TEST_CASE("in a field that is not uniform, --target-error answers for a disc with the mean number of hits") {
    const std::string line = "model @cornell --rays 2000 --samples 500 --disc-radius 4% --quiet --target-error 5% ";
    const Json json = result_of(line);
    const double hits = json.at("mean_disc_hits");
    const double p = hits / json.at("inputs").at("rays").get<double>();  // whole photons: 2000 rays or a few more
    CHECK(hits == near(json.at("counts").at("hits").get<double>() / 500));
    CHECK(json.at("mean_disc_deviation").get<double>() == near(std::sqrt((1 - p) / hits)));
    CHECK(json.at("rays_for_mean_disc").get<double>() == near((1 - p) / p / 0.0025));
    CHECK(json.at("notes").size() == 1);
    CHECK(detp(line).out.find("Discs with fewer hits need more rays.") != std::string::npos);
    CHECK_FALSE(json.contains("rays_for_deviation"));
  }

  TEST_CASE("the text answers in sentences: T, the best Q and k, the other form, the command that counts it") {
    const std::string line = "model --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2 --ratio 0.65";
    const Json json = result_of(line);
    const std::string text = detp(line).out;
    CHECK(text.starts_with("technique sphere-cache, Q 0.65, k 11, corrected form\n"));
    for (const char* said : {"\nT         1.038e+08 = T_R (making lists of rays) ", "\nbest      Q = ", " less T\n",
                             "\nk         11, all spheres that can hold a disc; at this Q k = 7 is the fastest",
                             "\npublished T = 3.789e+07 with k = 12", "\nhits      1.648e+05 expected, 1.65 a disc\n",
                             "\ncommand   detp validate --samples 100000 --disc-radius 0.01 --scene-side 2 "
                             "--experiments sphere-cache --ratio 0.65\n"})
      CHECK_MESSAGE(text.find(said) != std::string::npos, said, text);
    CHECK(text.find("rebuild_time") == std::string::npos);
    const std::string verbose = detp(line + " --verbose").out;
    CHECK(verbose.starts_with(text));
    CHECK(verbose.find("\nrebuild_time               1.0305421e+08\n") != std::string::npos);
    CHECK(detp(line + " --form published")
              .out.find("\ncorrected T = 1.038e+08 with k = 11, 2.7 of the published form\n") != std::string::npos);
    CHECK(detp("model @cornell --technique octree").out.find("\ncaution   outside of what was compared") !=
          std::string::npos);
    CHECK(detp("model --samples 10 --disc-radius 1 --sphere-radius 1")
              .out.find("\nk         0: no sphere holds a disc") != std::string::npos);
    CHECK(json.at("k") == 11);
  }

  TEST_CASE("side and sphere radius follow from each other, and a percentage is one of the side") {
    const Json side = result_of("model --samples 10 --disc-radius 0.05 --scene-side 2").at("inputs");
    CHECK(side.at("sphere_radius").get<double>() == near(std::sqrt(3.0) + 0.05));
    CHECK(side.at("rays") == 100000);
    const Json sphere = result_of("model --samples 10 --disc-radius 0.05 --sphere-radius 1").at("inputs");
    CHECK(sphere.at("scene_side").get<double>() == near(0.95 * 2 / std::sqrt(3.0)));
    const Json share = result_of("model --samples 10 --disc-radius 4% --scene-side 2").at("inputs");
    CHECK(share.at("disc_radius").get<double>() == near(0.08));
    const Json both = result_of("model --samples 10 --disc-radius 4% --sphere-radius 1").at("inputs");
    CHECK(both.at("disc_radius").get<double>() == near(0.04 * both.at("scene_side").get<double>()));
    CHECK(both.at("scene_side").get<double>() * std::sqrt(0.75) + both.at("disc_radius").get<double>() == near(1));
  }
}

}  // namespace detp::support
