// What it costs to come to the goals of robots from each vertex, found as far as it is asked for.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "heap.hpp"
#include "traffic/directed_graph.hpp"

namespace muster {

// Dijkstra's algorithm backwards from each goal, which goes on from where it stopped whenever a vertex is asked for
// that it has not settled.
class GoalDistances {
 public:
  // `costs` are those of the edges, 1 each where it is empty: then distances are numbers of steps. Throws
  // std::invalid_argument where a goal is no vertex.
  GoalDistances(std::shared_ptr<const DirectedGraph> graph, std::vector<int> goals, std::vector<int> costs = {});

  int robots() const { return static_cast<int>(goals_.size()); }
  int goal(int robot) const { return goals_[robot]; }
  const std::vector<int>& goals() const { return goals_; }
  const DirectedGraph& graph() const { return *graph_; }
  // DirectedGraph::kNoWay where there is no way.
  int to_goal(int robot, int vertex) {
    Table& table = tables_[robot];
    if (table.costs.empty()) begin(robot);
    return table.costs[vertex] >= 0 ? table.costs[vertex] : search(table, vertex);
  }

 private:
  struct Reached {
    int key, vertex;
  };
  struct Table {
    std::vector<int> costs;  // ~cost where it may still fall, kUnknown where the vertex is not reached
    std::vector<int> queue;  // of edges that cost 1
    std::size_t expanded = 0;
    Heap<Reached> open;  // of all others
  };
  static constexpr int kUnknown = std::numeric_limits<int>::min();

  void begin(int robot);
  int search(Table& table, int vertex);
  int search_steps(Table& table, int vertex);

  std::shared_ptr<const DirectedGraph> graph_;
  std::vector<int> goals_, costs_;
  std::vector<Table> tables_;
};

}  // namespace muster
