#pragma once

#include <string>

#include "reference.hpp"

/// References take minutes, so they are kept in files.
namespace detp::validate {

/// What a reference depends on: a file is only used where all of this is the same.
struct ReferenceKey {
  std::string scene;          ///< a digest of mesh, materials and lights, 16 hexadecimal digits
  bool front_facing = false;  ///< light that arrives from behind does not count
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  int version = 0;  ///< of the methods of make_reference

  bool operator==(const ReferenceKey&) const = default;
};

[[nodiscard]] ReferenceKey reference_key(const sim::Scene& scene, const ReferenceOptions& options);

/// Throws sim::FileError.
void write_reference(const std::string& path, const Reference& reference, const ReferenceKey& key);

/// Throws sim::FileError for a file that cannot be read, is malformed, or is of another scene or other options; it says what differs.
[[nodiscard]] Reference read_reference(const std::string& path, const sim::Scene& scene,
                                       const ReferenceOptions& options);

/// Reads the file. If there is none, makes the reference and writes the file; a reference that a stop request cut short is not
/// written, one that reached its time limit is. Throws as read_reference and make_reference.
[[nodiscard]] Reference kept_reference(const std::string& path, const sim::Scene& scene,
                                       const ReferenceOptions& options = {});

}  // namespace detp::validate
