#pragma once

#include "detp/model/vocabulary/technique.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "support/command.hpp"

namespace detp::support {

/// Discs of radii 0.02 to 0.2, with centres in a cube of side 2.
inline std::vector<sim::Disc> mixed_discs(std::uint64_t count) {
  std::vector<sim::Disc> discs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto place = sim::uniform4(11, sim::Stream::tests, i);
    const auto turn = sim::uniform4(12, sim::Stream::tests, i);
    discs.push_back({2.0 * glm::dvec3(place[0], place[1], place[2]) - 1.0, sim::uniform_direction(turn[0], turn[1]),
                     0.02 * std::pow(10.0, place[3])});
  }
  return discs;
}

/// Rays that are alternately unbounded lines and segments. The segments are 0.01 to 2.01 long; all rays have powers of
/// 0 to 3.
inline std::vector<sim::Ray> mixed_rays(std::uint64_t count) {
  std::vector<sim::Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto place = sim::uniform4(13, sim::Stream::tests, i);
    const auto turn = sim::uniform4(14, sim::Stream::tests, i);
    rays.push_back({2.4 * glm::dvec3(place[0], place[1], place[2]) - 1.2, sim::uniform_direction(turn[0], turn[1]),
                    i % 2 == 0 ? sim::unbounded : 0.01 + 2 * turn[2], 3 * turn[3]});
  }
  return rays;
}

struct Written {
  std::string per_disc;
  std::string pairs;
  std::uint64_t hits = 0;
  Json json;

  bool operator==(const Written& other) const { return per_disc == other.per_disc && pairs == other.pairs; }
};

inline Written run_and_read(const Arguments& problem, const std::string& technique) {
  const support::ScratchFolder folder;
  const Arguments files{"--per-disc", folder.path("per_disc.csv"), "--pairs", folder.path("pairs.csv")};
  Written written;
  written.json = result_of(problem + words(technique) + files);
  written.per_disc = support::content_of(folder.path("per_disc.csv"));
  written.pairs = support::content_of(folder.path("pairs.csv"));
  written.hits = written.json.at("hits");
  return written;
}

/// Exact techniques, most with several parameters, as options of `detp run`.
inline const std::vector<std::string>& exact_techniques() {
  static const std::vector<std::string> all{"",
                                            "--technique sphere-cache",
                                            "--technique sphere-cache --ratio 0.5 --spheres 3",
                                            "--technique sphere-cache --ratio 0.8 --spheres 12",
                                            "--technique sphere-cache --ratio 0.65",
                                            "--technique sphere-cache --spheres 2 --order none",
                                            "--technique sphere-cache --order hilbert",
                                            "--technique cell-spheres",
                                            "--technique cell-spheres --depth 16",
                                            "--technique sphere-tree",
                                            "--technique sphere-tree --fan-out 2 --leaf 1",
                                            "--technique box-tree",
                                            "--technique box-tree --fan-out 16 --leaf 3",
                                            "--technique octree",
                                            "--technique octree --depth 0",
                                            "--technique octree --depth 5",
                                            "--technique octree --traversal front-to-back",
                                            "--technique octree --traversal restart",
                                            "--technique octree --traversal neighbour-links --depth 5",
                                            "--technique bsp",
                                            "--technique bsp --depth 40 --leaf 1",
                                            "--technique grid",
                                            "--technique grid --cells 1",
                                            "--technique grid --cells 37",
                                            detp::has_embree ? "--technique bvh" : "",
                                            detp::has_embree ? "--technique bvh --quality medium" : "",
                                            "--technique ray-map"};
  return all;
}

/// Exact techniques, each with the parameters that `detp run` chooses.
inline const std::vector<std::string>& best_techniques() {
  static const std::vector<std::string> all{"",
                                            "--technique sphere-cache",
                                            "--technique cell-spheres",
                                            "--technique sphere-tree",
                                            "--technique box-tree",
                                            "--technique octree",
                                            "--technique bsp",
                                            "--technique grid",
                                            detp::has_embree ? "--technique bvh" : "",
                                            "--technique ray-map"};
  return all;
}

/// Fails the test unless all techniques write the same bytes as brute force. Returns brute force's files.
inline Written check_all_agree(const Arguments& problem,
                               const std::vector<std::string>& techniques = exact_techniques()) {
  Written truth = run_and_read(problem, "--technique brute-force");
  CAPTURE(line_of(problem));
  CHECK(truth.hits > 0);
  for (const std::string& technique : techniques) {
    CAPTURE(technique);
    const Written written = run_and_read(problem, technique);
    CHECK(written.hits == truth.hits);
    CHECK_MESSAGE(written == truth, "the files differ");
  }
  return truth;
}

inline std::vector<std::string> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  rows.erase(rows.begin());
  return rows;
}

}  // namespace detp::support
