#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "number_bytes.hpp"

/// The objects of a glTF file, and the numbers in its buffers.
namespace detp::sim {

/// Numbers in a buffer: `count` rows of `components` numbers.
struct GltfRows {
  const char* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;
  std::size_t components = 1;
  NumberType type = NumberType::float32;
  double divisor = 1;  ///< of whole numbers that stand for shares

  [[nodiscard]] double at(std::size_t row, std::size_t component) const {
    constexpr bool swapped = std::endian::native != std::endian::little;
    const double number = number_at(first + row * stride + component * size_of(type), type, swapped);
    return divisor == 1 ? number : std::max(number / divisor, -1.0);
  }
  [[nodiscard]] glm::dvec3 vector(std::size_t row) const { return {at(row, 0), at(row, 1), at(row, 2)}; }
};

/// A .gltf file with its buffers, or a .glb. All functions throw FileError for what is not as glTF 2.0 says.
class GltfDocument {
 public:
  using Json = nlohmann::json;

  /// Reads the file, and its buffers unless they are not wanted. Throws FileError also for required extensions that change the geometry; Stopped.
  GltfDocument(const std::string& path, const std::stop_token& stop, bool with_buffers = true);

  [[nodiscard]] const Json& json() const { return json_; }
  [[noreturn]] void fail(const std::string& what) const;

  /// A list of the whole file; empty if there is none.
  [[nodiscard]] const Json& list(const char* name) const;
  /// The object of the list `name` that a number in `from` refers to; null if there is no such number.
  [[nodiscard]] const Json* referred(const Json& from, const char* key, const char* name) const;
  /// Members of an object; nothing if it has none.
  [[nodiscard]] std::optional<std::size_t> whole(const Json& from, const char* key) const;
  [[nodiscard]] std::vector<std::size_t> indices_in(const Json& from, const char* key) const;
  [[nodiscard]] std::vector<double> numbers_in(const Json& from, const char* key, std::size_t count) const;

  /// The numbers of an accessor that `from` refers to; of one component they are indices. They stay with the document.
  [[nodiscard]] std::optional<GltfRows> rows(const Json& from, const char* key, std::size_t components) const;

  /// Paths of the buffers that are files.
  [[nodiscard]] std::vector<std::string> buffer_files() const;

 private:
  void refuse_extensions() const;
  void read_buffers(std::optional<std::string> binary, const std::stop_token& stop);
  [[nodiscard]] std::string bytes_of(const std::string& uri, const std::stop_token& stop) const;

  std::string path_;
  Json json_;
  std::vector<std::string> buffers_;
};

}  // namespace detp::sim
