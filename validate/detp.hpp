#pragma once

/// What a program needs that embeds detp: choose a technique for rays and discs, search them with it. The headers that
/// these include are installed too, and those of single formulas (detp/model), scenes and rays (detp/sim) and claims
/// (detp/validate).
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/choice/choose.hpp"
