#include "traffic/goal_distances.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace muster {

GoalDistances::GoalDistances(std::shared_ptr<const DirectedGraph> graph, std::vector<int> goals, std::vector<int> costs)
    : graph_(std::move(graph)), goals_(std::move(goals)), costs_(std::move(costs)), tables_(goals_.size()) {
  for (const int goal : goals_) {
    if (goal < 0 || goal >= graph_->size()) throw std::invalid_argument("a goal is no vertex of the graph");
  }
}

void GoalDistances::begin(int robot) {
  Table& table = tables_[robot];
  table.costs.assign(graph_->size(), kUnknown);
  table.costs[goals_[robot]] = costs_.empty() ? 0 : ~0;
  if (costs_.empty()) {
    table.queue = {goals_[robot]};
  } else {
    table.open.push({0, goals_[robot]});
  }
}

int GoalDistances::search(Table& table, int vertex) {
  if (costs_.empty()) return search_steps(table, vertex);
  while (!table.open.empty()) {
    const auto [cost, at] = table.open.pop();
    if (table.costs[at] != ~cost) continue;
    table.costs[at] = cost;
    for (const int e : graph_->entering(at)) {
      const int from = graph_->tail(e), known = table.costs[from], sum = cost + costs_[e];
      if (known != kUnknown && (known >= 0 || ~known <= sum)) continue;
      table.costs[from] = ~sum;
      table.open.push({sum, from});
    }
    if (at == vertex) return cost;
  }
  return table.costs[vertex] = DirectedGraph::kNoWay;
}

// In breadth, each vertex settled as soon as it is reached.
int GoalDistances::search_steps(Table& table, int vertex) {
  while (table.expanded < table.queue.size()) {
    const int at = table.queue[table.expanded++];
    const int steps = table.costs[at] + 1;
    for (const int e : graph_->entering(at)) {
      const int from = graph_->tail(e);
      if (table.costs[from] != kUnknown) continue;
      table.costs[from] = steps;
      table.queue.push_back(from);
    }
    if (table.costs[vertex] != kUnknown) return table.costs[vertex];
  }
  return table.costs[vertex] = DirectedGraph::kNoWay;
}

}  // namespace muster
