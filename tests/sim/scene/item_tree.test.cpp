#include "detp/sim/scene/item_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/machine.hpp"

using namespace detp::sim;

namespace {

constexpr const char* doing = "building";

glm::vec3 random_point(std::uint64_t index, std::uint64_t sub_index) {
  const auto random = uniform4(1, Stream::tests, index, sub_index);
  return glm::vec3(2 * random[0] - 1, 2 * random[1] - 1, 2 * random[2] - 1);
}

std::vector<ItemBox> random_boxes(std::size_t count, float size) {
  std::vector<ItemBox> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 corner = random_point(i, 0);
    boxes.push_back({corner, corner + size * glm::abs(random_point(i, 1))});
  }
  return boxes;
}

/// In double precision; boxes grown by `margin`.
bool meets(const ItemBox& box, const glm::dvec3& origin, const glm::dvec3& direction, double length, double margin) {
  double enter = 0;
  double leave = length;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis] - margin - origin[axis];
    const double high = box.high[axis] + margin - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / direction[axis], high / direction[axis]));
    leave = std::min(leave, std::max(low / direction[axis], high / direction[axis]));
  }
  return enter <= leave;
}

double distance_to(const ItemBox& box, const glm::dvec3& point) {
  const glm::dvec3 apart =
      glm::max(glm::max(glm::dvec3(box.low) - point, point - glm::dvec3(box.high)), glm::dvec3(0.0));
  return glm::length(apart);
}

std::vector<std::uint32_t> items_along(const ItemTree& tree, const glm::vec3& origin, const glm::vec3& direction,
                                       float length) {
  std::vector<std::uint32_t> items;
  tree.along(origin, direction, length, [&](std::uint32_t item) {
    items.push_back(item);
    return length;
  });
  std::ranges::sort(items);
  return items;
}

/// Whether rays and points find each box that they meet by more than rounding, each once.
bool finds_all(const std::vector<ItemBox>& boxes) {
  constexpr double rounding = 1e-6;
  const ItemTree tree(boxes, {}, doing);
  bool good = true;
  for (std::uint64_t query = 0; query < 40; ++query) {
    glm::vec3 direction = random_point(query, 2);
    if (query % 4 == 1) direction.x = 0;
    if (query % 4 == 2) direction.y = direction.z = -0.0F;
    direction = glm::normalize(direction);
    // Some rays lie in the face of a box.
    const glm::vec3 origin = query % 8 < 4 || boxes.empty() ? random_point(query, 3) : boxes.front().low;
    const float length = query % 2 == 0 ? 3.0F : 0.3F;
    const float reach = query % 2 == 0 ? 0.01F : 0.3F;
    const std::vector<std::uint32_t> found = items_along(tree, origin, direction, length);
    std::vector<std::uint32_t> near;
    tree.near(origin, reach, [&](std::uint32_t item) { near.push_back(item); });
    std::ranges::sort(near);
    good &= std::ranges::adjacent_find(found) == found.end() && std::ranges::adjacent_find(near) == near.end();
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (meets(boxes[i], origin, direction, length, -rounding)) good &= std::ranges::binary_search(found, i);
      if (distance_to(boxes[i], origin) < reach - rounding) good &= std::ranges::binary_search(near, i);
    }
  }
  return good;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("rays and points find all items whose box they meet, with each instruction set") {
    detp::support::with_each_instruction_set([] {
      for (const std::size_t count : {0, 1, 2, 5, 9, 100, 3000}) {
        CAPTURE(count);
        CHECK(finds_all(random_boxes(count, 0.1F)));
        CHECK(finds_all(std::vector<ItemBox>(count, {glm::vec3(0.25F), glm::vec3(0.5F)})));  // all in one place
      }
      std::vector<ItemBox> line = random_boxes(500, 0);
      for (std::size_t i = 0; i < line.size(); ++i) {  // each split leaves one behind
        line[i].low = {std::ldexp(1.0F, -static_cast<int>(i) / 4), 0, 0};
        line[i].high = line[i].low + glm::vec3(0, 0.1F, 0.1F);
      }
      CHECK(finds_all(line));
    });
  }

  TEST_CASE("a ray that gets shorter visits only what is nearer") {
    std::vector<ItemBox> row;
    for (int i = 0; i < 100; ++i) {
      const float start = 0.02F * static_cast<float>(i) - 1;
      row.push_back({{start, -0.1F, -0.1F}, {start + 0.01F, 0.1F, 0.1F}});
    }
    const ItemTree tree(row, {}, doing);
    std::size_t visited = 0;
    std::uint32_t nearest = UINT32_MAX;
    tree.along({-1.1F, 0, 0}, {1, 0, 0}, 3, [&](std::uint32_t item) {
      ++visited;
      nearest = std::min(nearest, item);
      return 0.12F + 0.02F * static_cast<float>(nearest);
    });
    CHECK(nearest == 0);
    CHECK(visited < 12);
  }

  TEST_CASE("a stop ends the building of a tree of items") {
    std::stop_source stop;
    stop.request_stop();
    const std::vector<ItemBox> boxes = random_boxes(200'000, 0.01F);
    CHECK_THROWS_WITH_AS(ItemTree(boxes, stop.get_token(), doing), "stopped while building", Stopped);
  }
}
