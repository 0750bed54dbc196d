#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::support {

/// Variants of every exact technique with small parameters.
inline const std::vector<Candidate>& exact_candidates() {
  static const std::vector<Candidate> list = [] {
    std::vector<Candidate> all;
    for (const TechniqueRecord& record : technique_records)
      if (record.exact)
        for (const Candidate& variant : small_variants(record.technique)) all.push_back(variant);
    return all;
  }();
  return list;
}

}  // namespace detp::support
