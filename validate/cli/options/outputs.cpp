#include "outputs.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/output_place.hpp"

namespace detp::cli {

void check_outputs(std::initializer_list<Output> outputs) {
  for (const Output& output : outputs)
    if (output.path) sim::require_writable(*output.path);
  for (const Output& first : outputs)
    for (const Output* second = &first + 1; second != outputs.end(); ++second)
      if (first.path && second->path && sim::same_place(*first.path, *second->path))
        throw std::invalid_argument(fmt::format("{} and {} name the same file {}; each needs its own", first.option,
                                                second->option, shown_path(*second->path)));
}

}  // namespace detp::cli
