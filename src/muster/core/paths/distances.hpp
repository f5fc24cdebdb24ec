// How far the cells of a grid are from its blocked cells.
#pragma once

#include <cstddef>

namespace muster {

// For each cell, in units of cells squared, the least of max(|dx| - trim, 0)^2 + max(|dy| - trim, 0)^2 over all blocked
// cells, (dx, dy) being the way between the centres; infinite where no cell is blocked. So trim 0 is from centre to
// centre, 1/2 from centre to square, 1 from square to square. Exact; the time is linear in the number of cells.
// `blocked` and `squared` are rows x columns, row after row; trim is from 0 to 1.
void squared_distances(const bool* blocked, std::size_t rows, std::size_t columns, double trim, double* squared);

}  // namespace muster
