// Dijkstra, A* and Theta* between the centres of the free cells of a grid.
#pragma once

#include <vector>

#include "paths/grid.hpp"

namespace muster {

struct GridSearch {
  bool heuristic = true;   // A*; without it Dijkstra
  bool any_angle = false;  // Theta*: a parent is any cell that is seen
};

// The cells from start to goal, as column + row * columns. A start or goal on a border belongs to all free cells there,
// and the way from the point to the centre counts. Empty if there is no way.
std::vector<int> search_grid(const GridMap& map, Point start, Point goal, GridSearch how);

}  // namespace muster
