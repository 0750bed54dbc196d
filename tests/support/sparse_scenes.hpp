#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <string>

#include "detp/sim/geometry/random.hpp"

/// Meshes with dense objects that few rays reach, as OBJ files.
namespace detp::support {

class SparseScene {
 public:
  explicit SparseScene(std::uint64_t seed) : seed_(seed) {}

  /// A number between the two, with a uniform logarithm.
  double between(double least, double most) {
    return least * std::pow(most / least, sim::uniform4(seed_, sim::Stream::tests, drawn_++)[0]);
  }

  /// A square floor of 10 x 10 with (cells + 1)² vertices.
  void floor(int cells) { square({0, 0, 0}, {10, 0, 0}, {0, 0, 10}, cells); }

  /// A sphere of about so many vertices.
  void sphere(double x, double y, double z, double radius, double vertices) {
    const int rings = static_cast<int>(std::sqrt(0.5 * vertices));
    const int first = vertices_ + 1;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j < 2 * rings; ++j) {
        const double polar = std::numbers::pi * i / rings;
        const double around = std::numbers::pi * j / rings;
        vertex(x + radius * std::sin(polar) * std::cos(around), y + radius * std::cos(polar),
               z + radius * std::sin(polar) * std::sin(around));
      }
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < 2 * rings; ++j) {
        const int next = (j + 1) % (2 * rings);
        const int ring = first + 2 * rings * i;
        quad(ring + j, ring + next, ring + 2 * rings + next, ring + 2 * rings + j);
      }
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  /// A parallelogram of cells² quads.
  void square(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int cells) {
    const int first = vertices_ + 1;
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j) {
        const glm::dvec3 place = corner + u * (1.0 * i / cells) + v * (1.0 * j / cells);
        vertex(place.x, place.y, place.z);
      }
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const int low = first + i * (cells + 1) + j;
        quad(low, low + 1, low + cells + 2, low + cells + 1);
      }
  }
  void vertex(double x, double y, double z) {
    text_ += fmt::format("v {:.7g} {:.7g} {:.7g}\n", x, y, z);
    ++vertices_;
  }
  void quad(int a, int b, int c, int d) { text_ += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d); }

  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  int vertices_ = 0;
  std::string text_;
};

/// A tiny object on a huge floor.
inline std::string tiny_object(std::uint64_t seed) {
  SparseScene scene(seed);
  scene.floor(static_cast<int>(scene.between(1, 60)));
  const double radius = scene.between(0.01, 0.2);
  scene.sphere(scene.between(1, 9), radius, scene.between(1, 9), radius, scene.between(2000, 12'000));
  return scene.text();
}

/// Some dense objects on a floor.
inline std::string furnished_floor(std::uint64_t seed) {
  SparseScene scene(seed);
  scene.floor(static_cast<int>(scene.between(1, 20)));
  for (int left = static_cast<int>(scene.between(4, 30)); left > 0; --left) {
    const double radius = scene.between(0.02, 0.5);
    scene.sphere(scene.between(1, 9), radius, scene.between(1, 9), radius, scene.between(200, 2000));
  }
  return scene.text();
}

}  // namespace detp::support
