// How long a robot that is alone takes to a point of a roadmap, its turns included.
#pragma once

#include <algorithm>
#include <compare>
#include <numbers>
#include <vector>

#include "heap.hpp"
#include "traffic/annotated_roadmap.hpp"

namespace muster {

// What decides how long a robot takes.
struct Manner {
  double speed, yaw_rate, acceleration;

  auto operator<=>(const Manner&) const = default;

  double stopping() const { return speed / acceleration; }  // seconds that a stop in between costs
  double along(const AnnotatedRoadmap& roadmap, int edge) const {
    return roadmap.length(edge) / std::min(speed, roadmap.speed(edge));
  }
  // Seconds to turn by an angle: before it sets out, or between two edges, where it slows down as it must.
  double setting_out(double angle) const { return angle / yaw_rate + 0.5 * stopping(); }
  double turning(double angle) const {
    return angle / yaw_rate + std::min(1.0, angle / (0.5 * std::numbers::pi)) * stopping();
  }
};

// Dijkstra's algorithm backwards over edges, as far as it was asked for.
class SecondsToGoal {
 public:
  SecondsToGoal(const AnnotatedRoadmap& roadmap, const Manner& manner, int goal);

  // From the end of an edge along which it has come; infinite where there is no way.
  double from_edge(int edge);
  // At least, from a point where it stands.
  double from_point(int point);

 private:
  struct Item {
    double key;
    int edge;
  };

  void settle_next();

  const AnnotatedRoadmap& roadmap_;
  Manner manner_;
  int goal_;
  std::vector<double> least_;
  std::vector<char> settled_;
  Heap<Item> queue_;
};

}  // namespace muster
