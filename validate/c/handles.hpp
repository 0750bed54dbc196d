#pragma once

#include <string>
#include <vector>

#include "detp.h"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/choice/plan.hpp"

/// What the handles of the C interface are.

struct detp_costs {
  detp::CostTable table;
};

struct detp_plan {
  detp::validate::Plan plan;
  std::size_t discs;
  std::vector<double> weights;  ///< of the discs by area, with sum 1
  std::string technique;
  std::string parameters;
};

struct detp_scratch {
  detp::sim::SearchScratch memory;
  std::size_t discs = 0;
  bool has_pairs = false;  ///< of the last search
};
