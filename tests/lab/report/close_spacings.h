// Readings at spacings close by, taken together. How a vessel's width fits the layers of particles moves one
// reading by 1 to 3 %: what a method does is the mean, and the scatter says by how much a single one is luck.
#pragma once

#include <vector>

#include "tests/lab/report/sweep.h"

namespace slosh::report {

/// `count` spacings, m, `spacing` in their middle, each 1.4 % of that from the next. `count` is odd.
std::vector<double> close_spacings(double spacing, int count);

/// The rows, where of a case's reading at one setting those whose spacings lie within 2 % from one to the
/// next are one: at the spacing in the middle of all of the case's there, with the mean of the errors, of the
/// wall time a simulated second and of the share that was lost, how many they are, and by how much they
/// scatter. What is there twice at one spacing counts once, as it is there first. Refusals, and what has
/// nothing close by, stay as they are, twice where they are there twice.
std::vector<ErrorRow> means_of_close(const std::vector<ErrorRow>& rows);

}  // namespace slosh::report
