#include "detp/validate/choice/plan_basis.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

using namespace detp;
using validate::LateSearcher;

TEST_SUITE("identity") {
  TEST_CASE("a searcher is built once, when it is needed; after an error the next call tries again") {
    const std::vector<sim::Disc> discs{{.centre = {0, 0, 0}, .normal = {0, 0, 1}, .radius = 1}};
    int calls = 0;
    LateSearcher late([&](const std::stop_token&) {
      if (++calls == 1) throw std::length_error("no memory");
      return sim::Searcher(discs, default_candidate(Technique::brute_force));
    });
    CHECK_FALSE(late.is_built());
    CHECK_THROWS_AS(static_cast<void>(late.get()), std::length_error);
    CHECK_FALSE(late.is_built());
    const sim::Searcher& first = late.get();
    CHECK(late.is_built());
    CHECK(&late.get() == &first);
    CHECK(calls == 2);
    CHECK(LateSearcher(sim::Searcher(discs, default_candidate(Technique::brute_force))).is_built());
  }
}
