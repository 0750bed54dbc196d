#include "detp/sim/files/table_writer.hpp"

#include <doctest/doctest.h>

using detp::sim::suffix_of;

TEST_SUITE("known answer") {
  TEST_CASE("a suffix is a short ending behind the last dot of the name") {
    for (const char* path : {"a.ply", "/x/a.PLY", "x.csv/a.Ply", "a.csv.ply", ".hidden.ply", "ä.ply"})
      CHECK(suffix_of(path) == ".ply");
    for (const char* path : {"", "a", "x.ply/a", ".ply", "/x/.ply", "a.", "tmp.Q2xJmC7d9k", "run-0.5", "v1.20", "a.b c",
                             "a.p-y", "a.plyä", "/dev/stdout", "."})
      CHECK(suffix_of(path).empty());
    CHECK(suffix_of("clip.mp4") == ".mp4");
  }
}
