#include "disc_order.hpp"

#include <utility>

#include "box_tree.hpp"

namespace detp::sim {

DiscOrder::DiscOrder(const Problem& problem, const RunOptions& options)
    : places_(stream::curve_order(problem, options)) {}

std::unique_ptr<Index> DiscOrder::prepare(const Problem& problem, const BoxTreeParameters& parameters,
                                          const RunOptions& options) const {
  check_options(options, problem);
  check(parameters);
  return prepare_box_tree(problem, stream::discs_in_known_order(problem, stream::Frame(problem), places_, options),
                          parameters, options);
}

}  // namespace detp::sim
