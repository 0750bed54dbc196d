#include "progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <thread>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "messages.hpp"
#include "screen.hpp"

namespace detp::cli {
namespace {

constexpr std::chrono::milliseconds between_drawings{100};
constexpr double first_drawing = 0.3;  // seconds: shorter work shows nothing
constexpr double least_share = 0.005;  // the time left is shown only from this share on
constexpr double sure = 0.8;           // share of the predicted work up to which the prediction is trusted

/// The share of a phase that is done. `work` is the work or time so far, divided by the predicted work or time of the
/// phase. The result increases with `work` and stays below 1, even if there is more work than predicted.
double share_done(double work) { return work <= sure ? work : 1 - (1 - sure) * sure / work; }

}  // namespace

std::string duration_text(double seconds) {
  const double minutes = std::ceil(seconds / 60);
  if (seconds < 99.5) return fmt::format("{:.0f} s", std::max(1.0, std::ceil(seconds)));
  if (minutes < 100) return fmt::format("{:.0f} min", minutes);
  return fmt::format("{:.0f} h {:.0f} min", std::floor(minutes / 60), std::fmod(minutes, 60));
}

class ProgressLine::Display {
 public:
  Display() {
    sim::work_log = &log_;
    drawing_ = std::jthread([this](const std::stop_token& end) { draw_repeatedly(end); });
  }
  ~Display() {
    drawing_.request_stop();
    drawing_.join();
    sim::work_log = nullptr;
    if (drawn_) write_error("\r\033[K");
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  void show(const sim::Phase& phase) {
    const std::scoped_lock lock(mutex_);
    phase_ = phase;
    work_before_ = log_.total;
    begun_ = clock_.seconds();
  }

 private:
  struct Moment {
    double seconds;
    double share;
  };

  void draw_repeatedly(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    std::condition_variable_any never;
    while (!never.wait_for(lock, end, between_drawings, [&] { return end.stop_requested(); })) draw();
  }

  /// Computed from the work, or from the time if the work is unknown.
  [[nodiscard]] double share_of_phase() const {
    if (phase_.work > 0) return share_done(static_cast<double>(log_.total - work_before_) / phase_.work);
    return phase_.seconds > 0 ? share_done((clock_.seconds() - begun_) / phase_.seconds) : 0;
  }

  /// Must be called with the mutex locked.
  void draw() {
    share_ = std::max(share_, phase_.from + (phase_.to - phase_.from) * share_of_phase());
    const Moment now{clock_.seconds(), share_};
    moments_.push_back(now);
    while (moments_.size() > 2 && moments_[1].seconds < now.seconds / 2) moments_.pop_front();
    if (now.seconds < first_drawing) return;
    const std::string line = fmt::format("{:3.0f} %  {}{}", std::floor(100 * share_), escaped(phase_.what), left(now));
    const std::size_t width = screen_of(STDERR_FILENO, Colour::never).width;
    write_error("\r\033[K" + (width > 0 && line.size() >= width ? line.substr(0, width - 1) : line));
    drawn_ = true;
  }

  [[nodiscard]] std::string left(const Moment& now) const {
    const Moment& then = moments_.front();
    if (now.seconds < 1 || now.share < least_share || now.share <= then.share) return "";
    return fmt::format(", {} left",
                       duration_text((1 - now.share) * (now.seconds - then.seconds) / (now.share - then.share)));
  }

  sim::WorkLog log_;
  sim::Stopwatch clock_;
  std::mutex mutex_;
  sim::Phase phase_;
  std::uint64_t work_before_ = 0;  ///< work before this phase
  double begun_ = 0;               ///< start of the phase, seconds
  double share_ = 0;               ///< share of the whole work that is done; it does not decrease
  std::deque<Moment> moments_;     ///< of the second half of the elapsed time
  bool drawn_ = false;
  std::jthread drawing_;
};

ProgressLine::ProgressLine(bool quiet) {
  if (!quiet && isatty(STDERR_FILENO) == 1) display_ = std::make_unique<Display>();
}

ProgressLine::~ProgressLine() = default;

void ProgressLine::show(const sim::Phase& phase) const {
  if (display_) display_->show(phase);
}

sim::ReportPhase ProgressLine::report() const {
  if (!display_) return {};
  return [this](const sim::Phase& phase) { show(phase); };
}

}  // namespace detp::cli
