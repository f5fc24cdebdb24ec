// A robot for which ways over a roadmap are sought, and what these ways are made of.
#pragma once

#include <vector>

#include "traffic/seconds_to_goal.hpp"

namespace muster {

struct Stop {
  int point;
  double hold;  // seconds
};

struct Traveller {
  int start;
  double heading;           // radians
  std::vector<Stop> stops;  // in order; none: it rests anywhere
  double radius, speed, yaw_rate, acceleration;
  double ready;  // seconds for which it stays at its start
  bool fixed;    // it never leaves
  bool stays;    // it stays at its last stop for good; else it leaves when it has held, to rest anywhere

  Manner manner() const { return {speed, yaw_rate, acceleration}; }
};

struct TimedMove {
  double start;  // seconds
  int traveller, edge;
  int stop;  // to which it leads: so many are passed
};

struct Way {
  std::vector<TimedMove> moves;
  double end;    // when it has held at its last stop; infinite where no path was found
  double until;  // to which it stays where its moves end
};

// A robot goes along an edge while all others stand.
struct SingleMove {
  int robot;
  int edge;
};

}  // namespace muster
