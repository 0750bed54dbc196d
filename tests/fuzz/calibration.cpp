// Stored calibrations: reading either succeeds, with costs that can be used, or throws FileError.

#include "detp/validate/calibration/calibration_file.hpp"

#include "detp/sim/files/file_error.hpp"
#include "scratch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace detp::validate;
  try {
    const StoredCalibration stored =
        parse_calibration(std::string(detp::fuzz::text_of(data, size)), "calibration.json");
    check(stored.costs);
    if (difference(stored.key, this_machine()).size() > 400) std::abort();
    const std::string text =
        calibration_text({.costs = stored.costs, .left_out_median_error = stored.left_out_median_error});
    if (!difference(parse_calibration(text, "calibration.json").key, this_machine()).empty()) std::abort();
  } catch (const detp::sim::FileError&) {
  }
  return 0;
}
