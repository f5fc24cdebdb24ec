// Walls of a map as a simulated crowd meets them: upright faces over line segments, and the flat ends of zones.
#pragma once

#include <algorithm>
#include <vector>

#include "crowd/walls.hpp"

namespace muster {

struct Upright {
  Segment base;
  double low, high;  // metres of the map frame

  Vec<3> closest(const Vec<3>& p) const {
    const Vec<2> foot = muster::closest(base, Vec<2>{{p[0], p[1]}});
    return {{foot[0], foot[1], std::clamp(p[2], low, high)}};
  }
};

// The floor and the ceiling of a zone.
struct Slab {
  std::vector<Vec<2>> ring;
  double low, high;

  // Whether p is straight above or below.
  bool covers(const Vec<3>& p) const {
    bool inside = false;
    for (std::size_t k = 0, j = ring.size() - 1; k < ring.size(); j = k++) {
      const Vec<2>&a = ring[k], &b = ring[j];
      if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        inside = !inside;
    }
    return inside;
  }
  Vec<3> closest(const Vec<3>& p) const { return {{p[0], p[1], std::clamp(p[2], low, high)}}; }
};

struct WallSet {
  std::vector<Upright> faces;
  std::vector<Slab> slabs;
  double ground;  // no centre comes below; -infinity: nothing is in the way
};

}  // namespace muster
