#pragma once

#include <cstddef>
#include <string>

#include "detp/sim/base/phase.hpp"
#include "job.hpp"

namespace detp::validate {

/// Reports the progress of making a job. Each function reports the start of one part of the work.
class JobProgress {
 public:
  explicit JobProgress(sim::ReportPhase report) : report_(std::move(report)) {}

  void read(const JobRequest& request);
  void read_rays(const std::string& file, std::size_t discs);
  void make_rays(sim::Field field, double rays, bool stream, std::size_t discs);
  void measure(std::size_t rays, std::size_t discs);

 private:
  /// Predicted work, in units of sim::StopCheck, and seconds.
  struct Part {
    double work = 0;
    double seconds = 0;
  };

  static Part reading(const std::string& file);
  static Part making(sim::Field field, double rays, bool stream);
  static Part measuring(double rays, double discs);
  void begin(const char* what, const Part& part, double later);

  sim::ReportPhase report_;
  double done_ = 0;  ///< share of the whole work that is done when the current part is finished
};

}  // namespace detp::validate
