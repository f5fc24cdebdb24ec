// Which ways to goals avoid those who come the other way: costs of edges by how many robots take them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "heap.hpp"
#include "random.hpp"
#include "traffic/goal_distances.hpp"

namespace muster {

// Robots choose a way one after another, in an order by chance. An edge costs more for each robot that takes it in the
// other direction, and for each that comes to its end, as in [chen2024]. With these costs the robots of a narrow aisle
// mostly go one way.
class TrafficGuidance {
 public:
  // Throws std::invalid_argument where starts or goals are no vertices, or not of the same number.
  TrafficGuidance(std::shared_ptr<const DirectedGraph> graph, std::vector<int> starts, std::vector<int> goals,
                  std::uint64_t seed);

  // Takes so many steps, of which there are two for each robot: its way, and its distances with the costs of all.
  void advance(int steps);
  bool finished() const { return !connected_ || done_ == 2 * order_.size(); }
  // Whether each robot alone comes to its goal, as far as it is known.
  bool connected() const { return connected_; }
  // The sum of the least numbers of steps; once finished.
  std::int64_t least_sum() const { return least_sum_; }
  const std::vector<int>& starts() const { return starts_; }
  const std::shared_ptr<GoalDistances>& distances() const { return distances_; }
  // With the costs; once finished.
  const std::shared_ptr<GoalDistances>& guided() const { return guided_; }

 private:
  static constexpr int kStep = 20, kOpposite = 4, kSameVertex = 1;

  int cost(int edge) const;
  void choose_way(int robot);

  std::shared_ptr<const DirectedGraph> graph_;
  std::vector<int> starts_;
  std::shared_ptr<GoalDistances> distances_, guided_;
  std::vector<int> order_, opposite_;
  std::vector<int> taken_, visited_;  // by edge, by vertex: how many robots
  std::size_t done_ = 0;
  bool connected_ = true;
  std::int64_t least_sum_ = 0;

  // The search of a way.
  struct Reached {
    int key, vertex, cost;
  };
  Heap<Reached> open_;
  std::vector<int> costs_, reached_by_, touched_;
};

}  // namespace muster
