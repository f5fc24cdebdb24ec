// Which robot takes which task.
#pragma once

#include <vector>

namespace muster {

// The cheapest assignment of rows to columns, each at most once, as many as there are of the fewer: by shortest
// augmenting paths [crouse2016]. `costs` is rows * columns. Returns the column of each row, -1 without one. O(n^2 m)
// for n of the fewer.
std::vector<int> cheapest_assignment(const std::vector<int>& costs, int rows, int columns);

}  // namespace muster
