// A roadmap that says for each edge which points a robot on it comes near to.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "paths/lattice.hpp"
#include "traffic/directed_graph.hpp"

namespace muster {

// The points near edge e are those from near_first[e] to near_first[e + 1], each with how near the edge comes to it.
class AnnotatedRoadmap {
 public:
  struct Near {
    int point;
    double metres;
  };

  // Throws std::invalid_argument where the arrays do not fit.
  AnnotatedRoadmap(std::vector<Point> points, DirectedGraph graph, std::vector<double> speeds,
                   std::vector<int> near_first, std::vector<Near> near)
      : points_(std::move(points)),
        graph_(std::move(graph)),
        speeds_(std::move(speeds)),
        near_first_(std::move(near_first)),
        near_(std::move(near)) {
    if (static_cast<int>(points_.size()) != graph_.size() || static_cast<int>(speeds_.size()) != graph_.edges() ||
        near_first_.size() != static_cast<std::size_t>(graph_.edges()) + 1 || near_first_.front() != 0 ||
        !std::is_sorted(near_first_.begin(), near_first_.end()) ||
        near_first_.back() != static_cast<int>(near_.size())) {
      throw std::invalid_argument("points, edges and what is near do not fit");
    }
    for (const Near& near_one : near_) {
      if (near_one.point < 0 || near_one.point >= graph_.size()) throw std::invalid_argument("near is no point");
    }
    for (int edge = 0; edge < graph_.edges(); ++edge) {
      const Point way = along(edge);
      lengths_.push_back(std::hypot(way.x, way.y));
      directions_.push_back(std::atan2(way.y, way.x));
    }
  }

  const DirectedGraph& graph() const { return graph_; }
  int size() const { return graph_.size(); }
  std::span<const Near> near(int edge) const {
    return {near_.data() + near_first_[edge], near_.data() + near_first_[edge + 1]};
  }
  // Whether a robot on the edge comes nearer than `apart` to a point.
  bool meets(int edge, int point, double apart) const {
    for (const Near& one : near(edge)) {
      if (one.point == point && one.metres < apart) return true;
    }
    return false;
  }
  Point place(int point) const { return points_[point]; }
  double length(int edge) const { return lengths_[edge]; }
  // The greatest on it.
  double speed(int edge) const { return speeds_[edge]; }
  // Radians from one edge to the next, without sign.
  double turn(int edge, int next) const {
    const double by = std::abs(directions_[next] - directions_[edge]);
    return std::min(by, 2.0 * std::numbers::pi - by);
  }
  // Radians from a heading, from east and anticlockwise, to that of an edge, without sign; 0 from NaN.
  double turn_from(double heading, int edge) const {
    const double by = std::abs(std::remainder(directions_[edge] - heading, 2.0 * std::numbers::pi));
    return std::isnan(by) ? 0.0 : by;
  }

 private:
  Point along(int edge) const {
    const Point from = points_[graph_.tail(edge)], to = points_[graph_.head(edge)];
    return {to.x - from.x, to.y - from.y};
  }

  std::vector<Point> points_;
  DirectedGraph graph_;
  std::vector<double> speeds_;  // of edges
  std::vector<int> near_first_;
  std::vector<Near> near_;
  std::vector<double> lengths_, directions_;  // of edges
};

}  // namespace muster
