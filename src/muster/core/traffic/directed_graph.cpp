#include "traffic/directed_graph.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "heap.hpp"

namespace muster {

namespace {

struct Reached {
  double key;
  int vertex;
};

}  // namespace

DirectedGraph::DirectedGraph(std::vector<int> first, std::vector<int> heads, std::vector<double> costs)
    : first_(std::move(first)), heads_(std::move(heads)), tails_(heads_.size()), costs_(std::move(costs)) {
  if (first_.empty() || first_.front() != 0 || !std::is_sorted(first_.begin(), first_.end()) ||
      first_.back() != static_cast<int>(heads_.size()) || costs_.size() != heads_.size()) {
    throw std::invalid_argument("the edges are not in compressed rows");
  }
  for (const int head : heads_) {
    if (head < 0 || head >= size()) throw std::invalid_argument("an edge leads to no vertex");
  }
  for (const double cost : costs_) {
    if (!(cost > 0)) throw std::invalid_argument("the cost of an edge must be above 0");
  }
  for (int v = 0; v < size(); ++v) std::fill(tails_.begin() + begin(v), tails_.begin() + end(v), v);
  backward_first_.assign(first_.size(), 0);
  for (const int head : heads_) ++backward_first_[head + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) backward_first_[v] += backward_first_[v - 1];
  backward_edges_.resize(heads_.size());
  auto next = backward_first_;
  for (int e = 0; e < edges(); ++e) {
    backward_edges_[static_cast<std::size_t>(next[head(e)]++)] = e;
  }
}

int DirectedGraph::edge(int tail, int head) const {
  for (int e = begin(tail); e < end(tail); ++e) {
    if (heads_[e] == head) return e;
  }
  return -1;
}

int DirectedGraph::most_neighbours() const {
  int most = 0;
  for (int v = 0; v < size(); ++v) most = std::max(most, end(v) - begin(v));
  return most;
}

std::vector<double> DirectedGraph::costs_to(int goal) const {
  std::vector<double> found(size(), std::numeric_limits<double>::infinity());
  Heap<Reached> open;
  found[goal] = 0;
  open.push({0, goal});
  while (!open.empty()) {
    const auto [cost, at] = open.pop();
    if (cost > found[at]) continue;
    for (const int e : entering(at)) {
      const int from = tail(e);
      const double here = cost + this->cost(e);
      if (here >= found[from]) continue;
      found[from] = here;
      open.push({here, from});
    }
  }
  return found;
}

}  // namespace muster
