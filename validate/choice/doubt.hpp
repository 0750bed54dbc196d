#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// How predictions of different kinds are compared.
namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// Sets how much each prediction is doubted:
///
///     1                  counts of a sample; brute force, whose tests are exact; box trees, whose closed forms were compared with
///                        real scenes; closed forms that are not extrapolated, compared with other closed forms
///     closed_form_doubt  closed forms that are compared with a sample's counts; or where only numbers are out of range
///     infinite           extrapolated closed forms in scenes of another kind (unless `counted_scene`, model::is_counted_scene),
///                        where tests were off by up to 17 times
///
/// Then sorts them by time, but with the choice first: the one that is fastest even so (the fastest, if all are doubted
/// without limit). A box tree needs `prepared` less than its time, because its discs are sorted already.
void put_choice_first(std::vector<Prediction>& candidates, bool counted_scene, double prepared = 0);

}  // namespace detp::validate
