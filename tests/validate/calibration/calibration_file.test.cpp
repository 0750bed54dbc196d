#include "detp/validate/calibration/calibration_file.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibrate_answer.hpp"
#include "detp/validate/choice/choice.hpp"
#include "support/scratch_file.hpp"
#include "support/sealed.hpp"

using namespace detp;
using validate::costs_in_use;

namespace {

validate::Calibration some_calibration() {
  validate::Calibration calibration;
  calibration.plain = validate::built_in_unit_costs(Engine::plain);
  calibration.simd = validate::built_in_unit_costs();
  calibration.simd[Technique::grid].step = 1.25e-8;
  calibration.plain[Technique::box_tree].cull_test = 1.5e-8;
  calibration.simd.threads_of(Technique::bsp) = {.serial_preparing = 1, .serial_search = 0.0625, .start = 1.5e-5};
  calibration.left_out_median_error = 0.0625;
  calibration.processor_share = 0.9375;
  calibration.simd.relative_error_of(Technique::box_tree) = 0.03125;
  return calibration;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  REQUIRE(place != std::string::npos);
  return text.replace(place, what.size(), by);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a calibration is read back as it was written") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("made/for/it/calibration.json");
    validate::write_calibration(path, some_calibration());
    const validate::Calibration stored = validate::read_calibration(path);
    CHECK(stored.key == validate::this_machine());
    CHECK(stored.left_out_median_error == 0.0625);
    CHECK(stored.processor_share == 0.9375);
    CHECK(stored.date.size() == 10);
    const validate::Calibration written = some_calibration();
    CHECK(stored.plain.engine == Engine::plain);
    CHECK(stored.simd.engine == Engine::simd);
    for (const Technique technique : all_techniques)
      if (record_of(technique).exact) {
        CHECK(stored.simd.relative_error_of(technique) == written.simd.relative_error_of(technique));
        CHECK(stored.plain[technique] == written.plain[technique]);
        CHECK(stored.simd[technique] == written.simd[technique]);
        CHECK(stored.simd.threads_of(technique) == written.simd.threads_of(technique));
      }
  }

  TEST_CASE("a choice for rays with different powers has the costs of sums, one for equal powers has not") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 5000, 0.02, 3);
    auto rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 5000);
    const CostTable costs = validate::built_in_unit_costs();
    const auto seconds = [&](const CostTable& with) {
      const sim::Problem problem = sim::make_problem(rays, discs);
      return validate::choose({.problem = &problem}, with).best().seconds();
    };
    const double equal = seconds(costs);
    const double of_sums = seconds(validate::costs_of_sums(costs));
    CHECK(of_sums > equal);
    rays[1234].power = 2;
    CHECK(seconds(costs) == of_sums);
  }

  TEST_CASE("a workload cannot be measured on rays without discs: a clear error") {
    const std::vector<sim::Ray> rays(10);
    CHECK_THROWS_AS(
        static_cast<void>(validate::choose({.rays = rays, .rigor = Rigor::estimate}, validate::built_in_unit_costs())),
        std::invalid_argument);
  }

  TEST_CASE("techniques that search ray by ray, and the plain engine, add powers anyway") {
    const CostTable costs = validate::built_in_unit_costs();
    CHECK(validate::costs_of_sums(costs)[Technique::octree] == costs[Technique::octree]);
    const CostTable plain = validate::built_in_unit_costs(Engine::plain);
    CHECK(validate::costs_of_sums(plain) == plain);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a doubtful calibration does not replace a better one, but a worse, altered or foreign one") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("calibration.json");
    const auto with_error = [](double error) {
      validate::Calibration calibration = some_calibration();
      calibration.left_out_median_error = error;
      return calibration;
    };
    const auto stored_error = [&] { return validate::read_calibration(path).left_out_median_error; };
    CHECK(validate::save_calibration(path, with_error(0.4)).empty());
    CHECK(validate::save_calibration(path, with_error(0.3)).empty());
    CHECK_FALSE(validate::save_calibration(path, with_error(0.35)).empty());
    CHECK(stored_error() == 0.3);
    CHECK(validate::save_calibration(path, with_error(0.05)).empty());
    CHECK(validate::save_calibration(path, with_error(0.2)).find("its median error is 20 %") != std::string::npos);
    CHECK(stored_error() == 0.05);
    CHECK(validate::save_calibration(path, with_error(0.1)).empty());  // not doubtful: the newer one counts
    CHECK(stored_error() == 0.1);
    const std::string better = validate::calibration_text(with_error(0.05));
    for (const std::string& useless :
         {replaced(better, "\"cpu\": \"", "\"cpu\": \"x"), replaced(better, "1.25e-08", "1.26e-08"), std::string()}) {
      folder.file("calibration.json", useless);
      CHECK(validate::save_calibration(path, with_error(0.2)).empty());
      CHECK(stored_error() == 0.2);
    }
  }

  TEST_CASE("no calibration replaces a file of another program") {
    const support::ScratchFolder folder;
    for (const char* foreign : {"{", "[1]", "my notes", "{\"schema\": {\"name\": \"other\"}}"}) {
      const std::string path = folder.file("calibration.json", foreign);
      CHECK(validate::save_calibration(path, some_calibration()).find("is not a calibration and stays") !=
            std::string::npos);
      CHECK(support::content_of(path) == foreign);
    }
  }

  TEST_CASE("a stored calibration of this machine is found; a broken or foreign one is not, and it says why") {
    const support::ScratchFolder folder;
    std::string why = "nothing";
    CHECK_FALSE(validate::find_calibration(folder.path("none.json"), &why));
    CHECK(why.empty());
    const std::string good = validate::calibration_text(some_calibration());
    CHECK(validate::find_calibration(folder.file("good.json", good), &why)->simd[Technique::grid].step == 1.25e-8);
    CHECK(why.empty());
    CHECK_FALSE(validate::find_calibration(folder.file("bad.json", "{"), &why));
    CHECK(why.find("is not a calibration") != std::string::npos);
    const std::string far = replaced(good, "\"cpu\": \"", "\"cpu\": \"x");
    CHECK_FALSE(validate::find_calibration(
        folder.file("far.json", support::sealed_calibration(nlohmann::json::parse(far))), &why));
    CHECK(why.find("far.json: its cpu is") != std::string::npos);
    CHECK_FALSE(validate::find_calibration(folder.file("altered.json", far), &why));
    CHECK(why.find("does not fit its checksum") != std::string::npos);
  }

  TEST_CASE("built-in costs are nanoseconds by their symbols; what is not named is 0, but for the touching of memory") {
    const UnitCosts grid = validate::built_in_unit_costs(Engine::plain)[Technique::grid];
    CHECK(grid.index_test == 3.34e-9);
    CHECK(grid.start == doctest::Approx(872e-9));
    CHECK(grid.streamed == 0);
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Technique technique : exact_techniques) {
        const UnitCosts costs = validate::built_in_unit_costs(engine)[technique];
        CHECK(costs.touch == doctest::Approx(0.054e-9));
        CHECK(costs.hit > 0);
      }
  }

  TEST_CASE("given costs are those of all techniques and engines; without a calibration they are built in") {
    const validate::CostsInUse given = costs_in_use({.given = UnitCosts{.disc_test = 2e-9}, .calibration = "none"});
    CHECK(given.plain[Technique::grid].disc_test == 2e-9);
    CHECK(given.plain.engine == Engine::plain);
    CHECK_FALSE(given.built_in);
    CHECK(validate::to_json(given.simd).at("u") == 2e-9);
    const validate::CostsInUse none = costs_in_use({.calibration = "none"});
    CHECK(none.built_in);
    CHECK(none.of(Engine::simd) == validate::built_in_unit_costs());
    CHECK(validate::to_json(none.simd).at("grid").size() > 3);
  }

  TEST_CASE("a named calibration of this machine is used, with its error and doubt; one of elsewhere is refused") {
    const support::ScratchFolder folder;
    validate::Calibration calibration;
    calibration.plain = validate::built_in_unit_costs(Engine::plain);
    calibration.simd = validate::built_in_unit_costs();
    calibration.simd[Technique::grid].step = 1.25e-8;
    calibration.left_out_median_error = 0.3;
    const std::string text = validate::calibration_text(calibration);
    const validate::CostsInUse found = costs_in_use({.calibration = folder.file("mine.json", text)});
    CHECK(found.simd[Technique::grid].step == 1.25e-8);
    CHECK(found.relative_error == calibration.relative_error());
    CHECK(found.doubt == calibration.doubt());
    CHECK(found.origin.find("of this machine, calibrated") != std::string::npos);
    CHECK_THROWS_AS(static_cast<void>(costs_in_use({.calibration = folder.path("missing.json")})), sim::FileError);
  }

  TEST_CASE("each field of an answer of calibrate has a meaning, and fits are rows under their columns") {
    for (const validate::FieldText& field : validate::describe_calibrate()) CHECK_FALSE(field.meaning.empty());
    validate::MeasuredCalibration calibration;
    calibration.fits.push_back(
        {{.technique = Technique::grid, .runs = 12, .left_out_errors = {0.1, 0.3}}, {.step = 2e-9}});
    calibration.thread_fits.push_back({{.technique = Technique::grid, .left_out_errors = {0.5}}, {.start = 1e-5}});
    const auto rows = validate::calibrate_rows(calibration);
    const validate::Columns columns = validate::calibrate_columns();
    for (const validate::Json& row : rows)
      for (const auto& [column, value] : row.items())
        CHECK(std::find(columns.begin(), columns.end(), column) != columns.end());
    CHECK(rows.front().at("left_out_median_error").get<double>() == doctest::Approx(0.2));
    CHECK(rows.back().at("symbol") == "thread");
    CHECK(rows.back().at("seconds") == 1e-5);
    CHECK_FALSE(rows.back().contains("condition"));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("what is no calibration is refused with its file's name") {
    const std::string good = validate::calibration_text(some_calibration());
    CHECK_NOTHROW(static_cast<void>(validate::parse_calibration(good, "c.json")));
    for (const std::string& bad :
         {std::string(), std::string("{"), std::string("[]"), std::string("{\"schema\": 1}"),
          good.substr(0, good.size() / 2), replaced(good, "detp.calibrate", "detp.run"),
          replaced(good, "\"version\": 1", "\"version\": 2"),
          replaced(good, "\"left_out_median_error\": 0.0625", "\"left_out_median_error\": -1"),
          replaced(good, "\"left_out_median_error\": 0.0625", "\"left_out_median_error\": 1e308"),
          replaced(good, "\"processor_share\": 0.9375", "\"processor_share\": 2"),
          replaced(good, "\"box-tree\": 0.03125", "\"box-tree\": 1e308"),
          replaced(good, "\"v\": 1.25e-08", "\"v\": 1e9"), replaced(good, "\"start\": 1.5e-05", "\"start\": 1e308"),
          replaced(good, "\"octree\": {", "\"no-tree\": {"),
          replaced(good, "\"serial_search\": 0.0625", "\"serial_search\": 1.5"),
          replaced(good, "\"serial_search\": 0.0625", "\"serial\": 0.5"),
          replaced(good, "\"v\": 1.25e-08", "\"v\": -1"), replaced(good, "\"v\": 1.25e-08", "\"v\": \"x\"")}) {
      CAPTURE(bad);
      CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(bad, "c.json")), doctest::Contains("c.json: "),
                           sim::FileError);
    }
  }

  TEST_CASE("a calibration of which any digit was altered is refused" * doctest::test_suite("long")) {
    const std::string good = validate::calibration_text(some_calibration());
    std::size_t altered = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
      if (good[i] < '0' || good[i] > '9') continue;
      std::string bad = good;
      bad[i] = good[i] == '9' ? '8' : static_cast<char>(good[i] + 1);
      if (nlohmann::json::parse(bad, nullptr, false) == nlohmann::json::parse(good)) continue;  // as 10 of 1.25e-010
      ++altered;
      CHECK_THROWS_AS(static_cast<void>(validate::parse_calibration(bad, "c.json")), sim::FileError);
    }
    CHECK(altered > 100);
    const nlohmann::json json = nlohmann::json::parse(good);
    CHECK_NOTHROW(static_cast<void>(validate::parse_calibration(json.dump(), "c.json")));  // in another layout
  }

  TEST_CASE("a calibration with another version of the cost model is refused, and the message says why") {
    const std::string good = validate::calibration_text(some_calibration());
    const std::string here = std::to_string(validate::this_machine().cost_model);
    const std::string older = replaced(good, "\"cost_model\": " + here, "\"cost_model\": 2");
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(older, "c.json")),
                         doctest::Contains("version 2 of the cost model"), sim::FileError);
    // as it was before the file had the costs of both engines and of threads
    const std::string flat =
        "{\"schema\": {\"name\": \"detp.calibrate\", \"version\": 1}, \"key\": {\"cost_model\": 2}, "
        "\"costs\": {\"grid\": {\"w\": 1e-9}}}";
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(flat, "c.json")),
                         doctest::Contains("threads; make a new one with detp calibrate"), sim::FileError);
  }

  TEST_CASE("a missing file is refused") {
    CHECK_THROWS_AS(static_cast<void>(validate::read_calibration("/nowhere/calibration.json")), sim::FileError);
  }

  TEST_CASE("a calibration of no time is refused") {
    CHECK_THROWS_AS(static_cast<void>(validate::answer(validate::CalibrateRequest{.seconds = 0})),
                    std::invalid_argument);
  }
}
