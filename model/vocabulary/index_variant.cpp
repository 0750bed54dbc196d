#include "index_variant.hpp"

#include <stdexcept>

namespace detp {

std::string_view name(Traversal traversal) {
  switch (traversal) {
    case Traversal::top_down:
      return "top-down";
    case Traversal::front_to_back:
      return "front-to-back";
    case Traversal::restart:
      return "restart";
    case Traversal::neighbour_links:
      return "neighbour-links";
  }
  throw std::logic_error("a traversal without a name");
}

std::optional<Traversal> traversal_named(std::string_view wanted) {
  for (const auto traversal : all_traversals)
    if (name(traversal) == wanted) return traversal;
  return std::nullopt;
}

}  // namespace detp
