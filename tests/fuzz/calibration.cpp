// Stored calibrations: reading either succeeds, with costs that can be used, or throws FileError.

#include "detp/validate/calibration/calibration_file.hpp"

#include "detp/sim/files/file_error.hpp"
#include "scratch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace detp::validate;
  try {
    const Calibration stored = parse_calibration(std::string(detp::fuzz::text_of(data, size)), "calibration.json");
    check(stored.simd);
    check(stored.plain);
    if (difference(stored.key, this_machine()).size() > 400) std::abort();
    if (!(stored.relative_error() <= 1000)) std::abort();
    Calibration again;
    again.left_out_median_error = stored.left_out_median_error;
    again.processor_share = stored.processor_share;
    again.simd = stored.simd;
    again.plain = stored.plain;
    const std::string text = calibration_text(again);
    if (!difference(parse_calibration(text, "calibration.json").key, this_machine()).empty()) std::abort();
  } catch (const detp::sim::FileError&) {
  }
  return 0;
}
