// A directed graph in compressed rows, and the ways to goals in it.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

namespace muster {

// The edges of vertex u are those from first[u] to first[u + 1]; edge e leads to heads[e] and costs costs[e].
class DirectedGraph {
 public:
  // Throws std::invalid_argument if the arrays are no compressed rows, or a cost is not above 0.
  DirectedGraph(std::vector<int> first, std::vector<int> heads, std::vector<double> costs);

  int size() const { return static_cast<int>(first_.size()) - 1; }
  int edges() const { return static_cast<int>(heads_.size()); }
  int begin(int vertex) const { return first_[vertex]; }
  int end(int vertex) const { return first_[vertex + 1]; }
  int head(int edge) const { return heads_[edge]; }
  int tail(int edge) const { return tails_[edge]; }
  double cost(int edge) const { return costs_[edge]; }
  std::span<const int> neighbours(int vertex) const {
    return {heads_.data() + begin(vertex), static_cast<std::size_t>(end(vertex) - begin(vertex))};
  }
  // The edges that lead to a vertex.
  std::span<const int> entering(int vertex) const {
    return {backward_edges_.data() + backward_first_[vertex], backward_edges_.data() + backward_first_[vertex + 1]};
  }
  // -1 if there is none.
  int edge(int tail, int head) const;
  int most_neighbours() const;

  // What it costs to come to `goal` from each vertex; infinite where there is no way. Dijkstra's algorithm backwards.
  std::vector<double> costs_to(int goal) const;
  static constexpr int kNoWay = 1 << 29;  // a number of steps, or a cost, where there is no way

 private:
  std::vector<int> first_, heads_, tails_;
  std::vector<double> costs_;
  std::vector<int> backward_first_, backward_edges_;  // the edges that lead to each vertex
};

// Tables of the ways to goals, each made when it is first asked for, and kept.
template <class Table>
class GoalTables {
 public:
  template <class Make>
  const Table& to(int goal, Make make) {
    const auto found = tables_.find(goal);
    return found != tables_.end() ? found->second : tables_.emplace(goal, make(goal)).first->second;
  }
  std::size_t size() const { return tables_.size(); }
  void clear() { tables_.clear(); }

 private:
  std::unordered_map<int, Table> tables_;
};

}  // namespace muster
