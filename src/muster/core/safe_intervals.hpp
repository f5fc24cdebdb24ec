// Paths in continuous time for robots that share a roadmap, one robot after the other [phillips2011].
//
// Each robot takes the earliest path through the intervals in which the points are safe from those that were planned
// before it. A robot is at the end of an edge from when it sets out on it, as in a sequence of moves; until
// it is clear of the point that it left that one is its too.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "annotated_roadmap.hpp"

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
};

struct TimedMove {
  double start;  // seconds
  int traveller, edge;
  bool leaves;  // it leaves its last stop
};

struct Paths {
  std::vector<TimedMove> moves;  // by start
  std::vector<double> ends;      // when each has held at its last stop; infinite where no path was found
  std::vector<int> order;        // in which they were planned
};

class SafeIntervals {
 public:
  // `rests`: whether a robot may rest at a point without standing in the way of others.
  SafeIntervals(std::shared_ptr<const AnnotatedRoadmap> roadmap, std::vector<bool> rests, double margin);

  int points() const { return roadmap_->size(); }
  // What it costs to come to a point from each, kept from one plan to the next.
  const std::vector<double>& metres_to(int goal);

  // Paths of all travellers, the first of the order first.
  Paths in_order(std::span<const Traveller> travellers, std::span<const int> order);

  // The best paths of several orders, the first of which is given: those without a path come first in the next, then
  // orders are drawn.
  Paths best_of(std::span<const Traveller> travellers, std::vector<int> order, int tries, std::uint64_t seed);

 private:
  struct Span {
    double from, until;
  };
  struct Stay {
    double from, until, radius;
  };
  struct Pass {
    double start, gap, radius;
  };
  struct Label {
    double key, ready;
    int leg, edge, interval, parent;
    double start;
  };

  void clear();
  double apart(const Traveller& who, double radius) const;
  double tail(const Traveller& who) const;
  struct Way {
    std::vector<TimedMove> moves;
    double end;    // when it has held at its last stop
    double until;  // to which it stays where its moves end
  };
  std::optional<Way> path(const Traveller& who);
  void reserve(const Traveller& who, const Way& way);
  // The intervals in which a robot may be at a point.
  const std::vector<Span>& safe(const Traveller& who, int point);
  // When a robot must have left where it starts: it is there, whoever stands near.
  double leaves_by(const Traveller& who);
  // The earliest time from `from` at which a robot may set out on an edge; infinite from `until` on.
  double earliest(const Traveller& who, int edge, double from, double until) const;
  void find_around();

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  std::vector<bool> rests_;
  double margin_;
  std::vector<std::vector<Stay>> stays_;
  std::vector<std::vector<Pass>> passes_;
  std::vector<std::vector<Span>> safe_;
  std::vector<char> known_;  // whether `safe_` of a point is that of the present traveller
  std::vector<std::vector<AnnotatedRoadmap::Near>>
      around_;  // of each point those as near as any edge's, itself included
  GoalTables<std::vector<double>> to_goals_;
};

}  // namespace muster
