// The agents near a place: a k-d tree [bentley1975], so that a search costs the logarithm of the team's size.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "crowd/agents.hpp"

namespace muster {

template <int D>
class AgentTree {
 public:
  explicit AgentTree(const std::vector<Vec<D>>& positions) : positions_(positions), order_(positions.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!order_.empty()) build(0, static_cast<int>(order_.size()));
  }

  // At most `most` other agents within the distance of agent i, into `found`, the nearest first. Agents equally far
  // stand in the order of their coordinates, so that the result does not depend on how agents are numbered.
  void near(int i, const Neighbourhood& hood, std::vector<int>& found) const {
    Search search{i, hood.most, hood.distance * hood.distance, {}};
    search.nearest.reserve(static_cast<std::size_t>(std::min<long>(hood.most, static_cast<long>(order_.size()))) + 1);
    if (hood.most > 0) look(0, search);
    found.clear();
    for (const Near& one : search.nearest) found.push_back(one.agent);
  }

 private:
  static constexpr int kLeaf = 8;

  struct Node {
    Vec<D> low, high;  // the box of its agents
    int begin, end;    // in order_
    int left, right;   // nodes; none in a leaf
  };
  struct Near {
    double squared;
    int agent;
  };
  struct Search {
    int self, most;
    double within;  // squared
    std::vector<Near> nearest;
  };

  int build(int begin, int end) {
    const int node = static_cast<int>(nodes_.size());
    Vec<D> low = positions_[order_[begin]], high = low;
    for (int k = begin + 1; k < end; ++k)
      for (int axis = 0; axis < D; ++axis) {
        low[axis] = std::min(low[axis], positions_[order_[k]][axis]);
        high[axis] = std::max(high[axis], positions_[order_[k]][axis]);
      }
    nodes_.push_back({low, high, begin, end, -1, -1});
    if (end - begin <= kLeaf) return node;
    int widest = 0;
    for (int axis = 1; axis < D; ++axis)
      if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return positions_[a][widest] < positions_[b][widest]; });
    const int left = build(begin, middle), right = build(middle, end);
    nodes_[node].left = left;
    nodes_[node].right = right;
    return node;
  }

  void look(int at, Search& search) const {
    const Node& node = nodes_[at];
    if (node.left < 0) {
      for (int k = node.begin; k < node.end; ++k) consider(order_[k], search);
      return;
    }
    const double left = squared_to(nodes_[node.left], search.self), right = squared_to(nodes_[node.right], search.self);
    const bool left_first = left <= right;
    for (const bool go_left : {left_first, !left_first})
      if ((go_left ? left : right) <= search.within) look(go_left ? node.left : node.right, search);
  }

  void consider(int agent, Search& search) const {
    if (agent == search.self) return;
    const Vec<D> apart = positions_[agent] - positions_[search.self];
    const Near one{dot(apart, apart), agent};
    if (one.squared > search.within) return;
    auto& nearest = search.nearest;
    const auto place = std::upper_bound(nearest.begin(), nearest.end(), one,
                                        [this](const Near& a, const Near& b) { return comes_before(a, b); });
    nearest.insert(place, one);
    if (static_cast<int>(nearest.size()) > search.most) nearest.pop_back();
    if (static_cast<int>(nearest.size()) == search.most) search.within = nearest.back().squared;
  }

  bool comes_before(const Near& a, const Near& b) const {
    if (a.squared != b.squared) return a.squared < b.squared;
    if (positions_[a.agent] != positions_[b.agent]) return positions_[a.agent].at < positions_[b.agent].at;
    return a.agent < b.agent;
  }

  double squared_to(const Node& node, int agent) const {
    double sum = 0.0;
    for (int axis = 0; axis < D; ++axis) {
      const double x = positions_[agent][axis];
      const double outside = std::max({node.low[axis] - x, 0.0, x - node.high[axis]});
      sum += outside * outside;
    }
    return sum;
  }

  const std::vector<Vec<D>>& positions_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace muster
