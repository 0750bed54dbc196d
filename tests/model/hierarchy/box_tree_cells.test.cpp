#include "detp/model/hierarchy/box_tree_boxes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace detp::model::box_tree;
using doctest::Approx;

TEST_SUITE("identity") {
  TEST_CASE("the two halves of a cell share its samples, and each kind of cell has its share of them") {
    for (const int dimension : {2, 3}) {
      const auto& kinds = cell_kinds(dimension, 1e5);
      for (std::size_t i = 0; i < kinds.size(); ++i) {
        const CellKind& cell = kinds[i];
        if (cell.child[0] == 0 || cell.cells == 0) continue;
        CAPTURE(dimension);
        CAPTURE(i);
        CHECK(cell.part[0] + cell.part[1] == Approx(1).epsilon(1e-15));
        CHECK(kinds[cell.child[0]].share == Approx(cell.part[0] * cell.share).epsilon(1e-15));
        CHECK(kinds[cell.child[1]].share == Approx(cell.part[1] * cell.share).epsilon(1e-15));
        for (const auto child : cell.child) CHECK(child > i);
      }
    }
  }

  TEST_CASE("cells of one size hold all samples: in a cube, and on its faces") {
    for (const CellKind& cell : cell_kinds(3, 1e5)) CHECK(cell.cells * cell.share == 1);
    // Halved six times across each axis, 64 cells a side: cells on faces, at edges and at corners.
    double share = 0;
    for (const CellKind& cell : cell_kinds(2, 1e5))
      if (cell.side[0] == 0x1p-6 && cell.side[1] == 0x1p-6 && (cell.side[2] == 0 || cell.side[2] == 0x1p-6))
        share += cell.cells * cell.share;
    CHECK(share == Approx(1).epsilon(1e-12));
  }

  TEST_CASE(
      "the curve's smallest cells have 1/64 of the side below 8192 samples, else 1/1024; halves keep their sides") {
    for (const int dimension : {2, 3})
      for (const auto& [samples, side] : {std::pair{8191.0, 0x1p-6}, {8192.0, 0x1p-10}})
        for (const CellKind& cell : cell_kinds(dimension, samples)) {
          const bool smallest = cell.side[0] == side && cell.side[1] == side;
          CHECK(cell.side[0] >= side);
          if (cell.last) CHECK(smallest);
          if (smallest && dimension == 3 && cell.side[2] == side) CHECK(cell.last);
        }
  }
}
