#include <doctest/doctest.h>

#include <set>

#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("a disabled technique is neither ranked nor run") {
    const auto technique_of = [](const std::string& arguments) {
      return result_of("choose " + arguments).at("choice").at("technique").get<std::string>();
    };
    const std::string scene = "@uniform --samples 2000 --rays 2000 --disc-radius 2%";
    CHECK(technique_of(scene) == "box-tree");
    CHECK(technique_of(scene + " --disable box-tree") != "box-tree");
    CHECK(technique_of(scene + " --disable box-tree,grid --rigor estimate") != "box-tree");
    const std::set<std::string> disabled{"bvh", "grid", "octree", "ray-map", "bsp"};
    const Json analysed = result_of("choose " + scene + " --disable bvh,grid,octree,ray-map,bsp --analyze");
    for (const Json& candidate : analysed.at("candidates")) CHECK(disabled.count(candidate.at("technique")) == 0);
    check_refused(
        {{"choose " + scene + " --disable tree", "sphere-tree"},
         {"choose " + scene + " --disable box-tree --rigor pilot", "box-tree"},
         {"choose " + scene + " --disable brute-force,sphere-cache,cell-spheres,sphere-tree,box-tree,octree,grid",
          "leaves no technique"}});
  }

  TEST_CASE("--technique names the only techniques that are considered, with every rigor") {
    const std::string scene = "@uniform --samples 2000 --rays 2000 --disc-radius 2%";
    const auto techniques_of = [&](const std::string& arguments) {
      std::set<std::string> techniques;
      const Json json = result_of("choose " + scene + arguments);
      for (const Json& candidate : json.at("candidates")) techniques.insert(candidate.at("technique"));
      return techniques;
    };
    using Names = std::set<std::string>;
    CHECK(techniques_of(" --technique grid,octree") == Names{"grid", "octree"});
    CHECK(techniques_of(" --technique box-tree") == Names{"box-tree"});
    CHECK(techniques_of(" --technique box-tree,brute-force --rigor structural") == Names{"box-tree", "brute-force"});
    CHECK(techniques_of(" --technique box-tree,grid --rigor pilot --disable grid") == Names{"box-tree"});
    CHECK(techniques_of(" --technique cell-spheres --rigor measure") == Names{"cell-spheres"});
    CHECK(techniques_of(" --technique bvh,grid --rigor measure") == Names{"bvh", "grid"});
    const Json grid = result_of("choose " + scene + " --technique grid");
    CHECK(grid.at("choice").at("parameters") == result_of("run " + scene + " --technique grid").at("parameters"));
    CHECK(grid.at("inputs").at("disabled").size() == 9);
    CHECK(result_of("choose " + scene).at("inputs").at("disabled").empty());
    const Json map =
        result_of("choose @uniform --samples 2000 --map --rays 100,1000 --disc-radius 2% --technique octree");
    for (const Json& cell : map.at("cells")) CHECK(cell.at("predicted").at("technique") == "octree");
    check_refused({{"choose " + scene + " --technique gird", "did you mean grid?"},
                   {"choose " + scene + " --technique grid --disable grid", "--technique with --disable leaves no"},
                   {"choose " + scene + " --technique bvh", "--technique leaves no technique"},
                   {"choose " + scene + " --technique grid --rigor pilot", "box-tree may not be chosen"},
                   {"choose " + scene + " --technique photon-map", "photon-map is never chosen"}});
  }
}

}  // namespace detp::support
