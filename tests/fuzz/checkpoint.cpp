// Checkpoint files of the sweep: reading either succeeds or throws FileError. A checkpoint that was read can be written
// and read again.

#include "detp/validate/sweep/checkpoint.hpp"
#include "detp/sim/files/file_error.hpp"
#include "scratch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using detp::validate::Checkpoint;
  const detp::fuzz::Scratch file(".json");
  const std::string& path = file.with(detp::fuzz::text_of(data, size));
  try {
    Checkpoint checkpoint(path, 1, "2");
    checkpoint.read();
    const std::size_t points = checkpoint.points().size();
    checkpoint.add("one more", {});
    Checkpoint again(path, 1, "2");
    again.read();
    if (again.points().size() < points) std::abort();
  } catch (const detp::sim::FileError&) {
  }
  return 0;
}
