// The quickest ways along directed lanes for a robot that slows down for bends.
#pragma once

#include <utility>
#include <vector>

#include "paths/lattice.hpp"

namespace muster {

class LaneWays {
 public:
  // Arc k leads straight from points[ends[k].first] to points[ends[k].second] and takes seconds[k], above 0.
  // `turn`, `stop`: the seconds that a bend by a right angle takes for turning, and for stopping; of a sharper bend the
  // turn takes longer, and of a gentler one both take less. Throws std::invalid_argument where the arrays do not fit.
  LaneWays(std::vector<Point> points, std::vector<std::pair<int, int>> ends, std::vector<double> seconds, double turn,
           double stop);

  // The length of the quickest way from one point to another, and the seconds that it takes at its speeds and in its
  // bends. Infinite where there is no way.
  struct Length {
    double metres, seconds;
  };
  // The lengths from a point to each of some; a point below 0 has no way.
  std::vector<Length> lengths(int start, const std::vector<int>& goals) const;

  // The points of the quickest way; none where there is no way.
  std::vector<int> way(int start, int goal) const;

  int points() const { return static_cast<int>(points_.size()); }

 private:
  struct Label {
    double key, seconds, metres;
    int parent;  // the arc before; -1: the first
  };
  struct Item {
    double key;
    int arc;
  };
  struct Search;

  double bend(int arc, int next) const;
  void settle(Search& search, int start, std::vector<int> goals) const;

  std::vector<Point> points_;
  std::vector<int> tails_, heads_;
  std::vector<double> seconds_, metres_, directions_;
  std::vector<int> first_, leaving_;  // the arcs that leave point u: leaving_[first_[u]] to leaving_[first_[u + 1]]
  double turn_, stop_;
};

}  // namespace muster
