#include <doctest/doctest.h>

#include <sstream>

#include "support/command.hpp"

namespace detp::support {
namespace {

const std::string tiny = "choose @uniform --samples 300 --map --rays 100,1000 --disc-radius 2%,8%";

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a cell of a map has the choice that choose makes") {
    const Json json = result_of(tiny);
    CHECK(json.at("schema").at("name") == "detp.choose-map");
    CHECK(json.at("inputs").at("map") == true);
    CHECK(json.at("inputs").at("scene") == "@uniform");
    CHECK(json.at("inputs").at("rays") == json.at("axes").at("rays"));
    CHECK(json.at("axes").at("disc_radius").size() == 2);
    CHECK(json.at("stopped") == false);
    CHECK_FALSE(json.contains("agreement"));
    REQUIRE(json.at("cells").size() == 4);
    const Json& cell = json.at("cells")[1];
    CHECK(cell.at("rays") == 1000);
    CHECK(cell.at("x").get<double>() == json.at("axes").at("x")[0].get<double>());
    CHECK_FALSE(cell.contains("measured"));
    CHECK_FALSE(cell.contains("agrees"));
    const Json choice = result_of("choose @uniform --samples 300 --rays 1000 --disc-radius 2%");
    CHECK(cell.at("disc_radius") == choice.at("inputs").at("disc_radius"));
    CHECK(cell.at("predicted").at("technique") == choice.at("choice").at("technique"));
    CHECK(cell.at("predicted").at("parameters") == choice.at("choice").at("parameters"));
    CHECK(cell.at("predicted").at("seconds") == choice.at("choice").at("predicted_seconds"));
    CHECK(cell.at("paper_rule").at("technique") == choice.at("paper_rule").at("technique"));
    CHECK(cell.at("predicted").at("techniques")[0].at("technique") == choice.at("choice").at("technique"));
  }

  TEST_CASE("a measured map says in how many cells both agree") {
    const Json json = result_of(
        "choose @uniform --samples 200 --map --analyze --rays 50,500 --disc-radius 4% --disable grid,bsp,ray-map");
    std::size_t agree = 0;
    for (const Json& cell : json.at("cells")) {
      const Json& measured = cell.at("measured");
      CHECK(measured.at("seconds") > 0);
      CHECK(cell.at("agrees") == (measured.at("technique") == cell.at("predicted").at("technique")));
      CHECK(cell.at("slower").get<double>() ==
            doctest::Approx(
                measured.at("predicted_choice_seconds").get<double>() / measured.at("seconds").get<double>() - 1));
      for (const Json& one : measured.at("techniques")) {
        CHECK(one.at("technique") != "bsp");
        CHECK(one.at("seconds") >= measured.at("seconds"));
      }
      agree += cell.at("agrees").get<bool>() ? 1 : 0;
    }
    CHECK(json.at("agreement").at("cells") == 2);
    CHECK(json.at("agreement").at("agree") == agree);
    CHECK(json.at("agreement").at("share") == doctest::Approx(static_cast<double>(agree) / 2));
    CHECK(json.at("agreement").at("slowdown").at("worst") >= 1);
  }

  TEST_CASE("-o FILE.svg draws the map, with the same bytes whatever the number of threads; the text goes to stdout") {
    const support::ScratchFolder folder;
    const Finished one = detp(words(tiny + " --threads 1 -o") + Arguments{folder.path("one.svg")});
    const Finished two = detp(words(tiny + " --threads 2 -o") + Arguments{folder.path("two.svg")});
    CHECK(one.code == 0);
    CHECK(one.err.empty());
    CHECK(one.out.find("the fastest technique") != std::string::npos);
    CHECK(one.out.find("picture   " + folder.path("one.svg")) != std::string::npos);
    const std::string svg = support::content_of(folder.path("one.svg"));
    CHECK(one.out.find("paper's rule") == std::string::npos);
    const std::string verbose = detp(tiny + " --verbose").out;
    for (const char* const part :
         {"paper's rule", "\npaper     its rule takes ", "\ntook      ", "neighbouring samples over d."})
      CHECK(verbose.find(part) != std::string::npos);
    CHECK(svg.find("</svg>\n") != std::string::npos);
    CHECK(svg == support::content_of(folder.path("two.svg")));
    CHECK(folder.entries() == 2);
    const Finished text = detp(words(tiny + " -o") + Arguments{folder.path("map.txt")});
    CHECK(text.out.empty());
    CHECK(support::content_of(folder.path("map.txt")).find("the fastest technique") != std::string::npos);
  }

  TEST_CASE("CSV has a row for each cell; text and CSV have neither nan nor inf") {
    const Finished csv = detp(tiny + " --format csv");
    std::istringstream lines(csv.out);
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    REQUIRE(rows.size() == 5);
    CHECK(rows[0].find(",x,predicted_technique,") != std::string::npos);
    CHECK(rows[1].starts_with("@uniform,isotropic,100,300,"));
    CHECK_FALSE(has_no_number(csv.out));
    CHECK_FALSE(has_no_number(detp(tiny).out));
  }

  TEST_CASE("a wide map leaves out numbers of rays to fit the screen, and says so") {
    const std::string wide =
        "choose --map --samples 1e4 --scene-side 2 --rays 100:3000:100 --disc-radius 1% --disable "
        "sphere-cache,sphere-tree,cell-spheres";
    CHECK(detp(wide).out.find("numbers of rays;") == std::string::npos);
    REQUIRE(::setenv("COLUMNS", "60", 1) == 0);
    const Finished narrow = detp(wide);
    REQUIRE(::unsetenv("COLUMNS") == 0);
    CHECK(narrow.out.find("numbers of rays;") != std::string::npos);
    std::istringstream lines(narrow.out);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 60);
  }

  TEST_CASE("numbers alone have a map, for any number of rays, over the default axes") {
    const Json json = result_of("choose --map --samples 1e4 --scene-side 2 --rays 1e2,1e18");
    CHECK(json.at("cells").size() == 14);
    for (const Json& cell : json.at("cells")) CHECK(cell.at("predicted").at("rigor") == "estimate");
    CHECK(result_of(tiny + " --rigor estimate").at("cells")[0].at("predicted").at("rigor") == "estimate");
  }

  TEST_CASE("files without a list give one number of rays and one radius") {
    const support::ScratchFolder folder;
    const Arguments files{"--discs",
                          folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,0.5\n1,0,0,0,0,1,0.5\n"),
                          "--ray-file", folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n")};
    const Json json = result_of(words("choose --map") + files);
    CHECK(json.at("axes").at("rays") == Json{1});
    CHECK(json.at("axes").at("disc_radius") == Json{0.5});
    CHECK(json.at("cells").size() == 1);
  }

  TEST_CASE("a map that is stopped prints the cells so far, and ends with code 3") {
    const std::string line = "choose @uniform --samples 20000 --map --analyze --rays 1e2,2e5 --disc-radius 1%,8%";
    const Finished finished = stopped_in_time(line + " --format json", [](const Finished& one) {
      return one.json().contains("cells") && !one.json().at("cells").empty();
    });
    CHECK(finished.code == 3);
    CHECK(finished.json().at("stopped") == true);
    CHECK(finished.json().at("stopped_after").at("unit").get<std::string>().starts_with("cells "));
    const support::ScratchFolder folder;
    const Finished none = detp(words(line + " --time-limit 1e-9 -o") + Arguments{folder.path("none.svg")});
    CHECK(none.code == 3);
    CHECK(none.out.find("nothing is known yet") != std::string::npos);
    CHECK(folder.entries() == 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a map refuses what it cannot draw, with the reason") {
    check_refused({{"choose @uniform --map --rays 5:1:1", "--rays"},
                   {"choose @uniform --map --rays 1:100:1", "at most 40"},
                   {"choose @uniform --map --rays 1:1e9:1", "--rays"},
                   {"choose @uniform --map --rays 100,x", "--rays"},
                   {"choose @uniform --map --rays 0,100", "number of rays"},
                   {"choose @uniform --map --disc-radius -1,2", "disc radius"},
                   {"choose @uniform --map --disc-radius 1%,", "disc radius"},
                   {"choose @uniform --map --technique photon-map", "photon-map is never chosen"},
                   {"choose @uniform --map --rigor structural", "structures"},
                   {"choose @uniform --map --analyze --rays 1e15", "GB"},
                   {"choose @uniform --map --costs t=0", "0 s"},
                   {"choose @uniform --map -o /nowhere/map.svg", "/nowhere"},
                   {"choose --map --scene-side 2", "--samples"},
                   {"choose --map --samples 100", "--scene-side"},
                   {"choose --map --samples 100 --scene-side 2 --rigor pilot", "needs rays"},
                   {"choose @uniform --rays 10,20", "--map"},
                   {"choose @uniform --disc-radius 1%,2%", "--map"}});
  }
}

}  // namespace detp::support
