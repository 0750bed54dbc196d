// The readers of meshes, discs and rays; the first byte selects the reader. Reading either succeeds or throws
// FileError. The data read satisfies what the reader's documentation promises.

#include <cmath>
#include <glm/geometric.hpp>

#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "scratch.hpp"

namespace {

using namespace detp::sim;

void require(bool promise) {
  if (!promise) std::abort();
}

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool unit(const glm::dvec3& v) { return std::abs(glm::length(v) - 1) < 1e-12; }

void read_as_mesh(const std::string& path) {
  Notices notices;
  const Mesh mesh = read_mesh(path, notices);
  for (const auto& corners : mesh.triangles)
    for (const auto corner : corners) require(corner < mesh.positions.size() && finite(mesh.positions[corner]));
}

void read_as_discs(const std::string& path) {
  for (const Disc& disc : read_discs(path, 0.5)) {
    require(finite(disc.centre) && unit(disc.normal));
    require(disc.radius > 0 && std::isfinite(disc.radius));
  }
}

void read_as_rays(const std::string& path) {
  for (const Ray& ray : read_rays(path).paths.rays) {
    require(finite(ray.origin) && unit(ray.direction));
    require(ray.length > 0 && ray.power >= 0 && std::isfinite(ray.power));
  }
}

struct Reader {
  const char* ending;
  void (*read)(const std::string&);
};

constexpr Reader readers[] = {{".obj", read_as_mesh},  {".ply", read_as_mesh},  {".csv", read_as_discs},
                              {".ply", read_as_discs}, {".csv", read_as_rays},  {".ply", read_as_rays},
                              {".stl", read_as_mesh},  {".gltf", read_as_mesh}, {".glb", read_as_mesh},
                              {".npz", read_as_rays},  {".mcpl", read_as_rays}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return -1;
  const Reader& reader = readers[data[0] % std::size(readers)];
  const detp::fuzz::Scratch file(reader.ending);
  try {
    reader.read(file.with(detp::fuzz::text_of(data + 1, size - 1)));
  } catch (const FileError&) {
  }
  return 0;
}
