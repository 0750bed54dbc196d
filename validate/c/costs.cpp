#include "detp/model/vocabulary/checks.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "guard.hpp"
#include "types.hpp"

using namespace detp;

extern "C" {

detp_status detp_costs_built_in(detp_costs** costs, detp_error* error) {
  return c::guarded(error, [&] { c::given(costs, "costs") = new detp_costs{validate::built_in_unit_costs()}; });
}

detp_status detp_costs_stored(detp_costs** costs, detp_error* error) {
  return c::guarded(error, [&] { c::given(costs, "costs") = new detp_costs{validate::stored_unit_costs()}; });
}

detp_status detp_costs_measured(double seconds, int store, detp_progress progress, void* user, detp_costs** costs,
                                detp_error* error) {
  return c::guarded(error, [&] {
    detp_costs*& made = c::given(costs, "costs");
    require_positive("seconds", seconds);
    c::Watch watch(progress, user, "calibrating");
    const validate::MeasuredCalibration measured =
        validate::calibrate({.seconds = seconds, .stop = watch.token(), .progress = watch.report()});
    if (measured.stopped) throw sim::Stopped("the calibration was stopped", {});
    if (store != 0) static_cast<void>(validate::save_calibration(validate::default_calibration_path(), measured));
    made = new detp_costs{measured.simd};
  });
}

void detp_costs_free(detp_costs** costs) {
  if (costs == nullptr) return;
  delete *costs;
  *costs = nullptr;
}

const char* detp_version(void) { return DETP_VERSION; }
}
