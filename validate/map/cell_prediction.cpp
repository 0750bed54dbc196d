#include "cell_prediction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"

namespace detp::validate {

Choice choose_for_cell(const Question& question, const CostTable& costs) {
  Choice choice = choose(question, costs);
  if (question.stop.stop_requested()) throw sim::Stopped("stopped while techniques were ranked");
  for (const Prediction& one : choice.candidates)
    if (const double seconds = one.seconds(); !(seconds > 0 && std::isfinite(seconds)))
      throw std::invalid_argument(
          fmt::format("with these unit costs {} takes {} s, so that nothing can be compared; give every operation its "
                      "cost in seconds",
                      name(one.candidate.technique), seconds));
  return choice;
}

}  // namespace detp::validate
