// A lane on which only so many robots may be at once.
#pragma once

#include "paths/lattice.hpp"

namespace muster {

class LimitedLane {
 public:
  // `most`: how many robots may be between its ends at once. Throws std::invalid_argument where the ends are one place.
  LimitedLane(Point from, Point to, int most, bool both_ways);

  int most() const { return most_; }
  // Whether a robot at this place is between its ends.
  bool holds(Point place) const;
  // Whether a robot on this straight way is between its ends for some of it.
  bool carries(Point from, Point to) const;
  // Whether a robot gets between its ends so, in a direction of the lane or from beside it.
  bool entered(Point from, Point to) const;

 private:
  struct On {
    double along, aside;  // metres
  };

  On on(Point place) const;

  Point from_;
  double dx_, dy_, length_;  // its direction, and metres
  int most_;
  bool both_ways_;
};

}  // namespace muster
