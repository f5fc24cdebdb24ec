// One shortest way in a plane with obstacles, without the graph of all corners.
#pragma once

#include <cstddef>
#include <vector>

#include "paths/sights.hpp"

namespace muster {

struct CornerWay {
  std::vector<Point> points;  // with its ends; empty if there is none
  double length;              // infinite if there is none
  std::size_t looks;          // corners looked around
};

// The shortest way between two free places that do not see each other: A* over corners, each looked around when the
// search comes by, and only where a way may lead that is shorter than the best one known.
CornerWay search_corners(const Sights& sights, Point from, Point to);

}  // namespace muster
