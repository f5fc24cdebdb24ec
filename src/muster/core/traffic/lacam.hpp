// Lazy constraints addition search [okumura2023], anytime by rewiring as LaCAM* [okumura-star2023].
//
// High level: a depth-first search over configurations, which say where all robots are. Low level: each configuration
// has a tree of constraints, searched in breadth, of which one node is taken each time the configuration is on top; it
// says where the first few robots of an order go. A generator makes the next configuration from that. At the bottom of
// the tree everything is said, so that each neighbour comes in the end: the search is complete.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "random.hpp"

namespace muster {

using Configuration = std::vector<int>;

enum class SearchState { kSearching, kSolved, kOptimal, kUnsolvable };

// A Generator has
//   Memo        what is remembered of a configuration beside itself: priorities, and what the next step needs
//   Configuration start() const; Memo memo() const;
//   void again(Memo& known, const Memo& newer) const; where a configuration is come to again
//   bool finished(const Configuration&, const Memo&) const;
//   double cost(const Configuration& from, const Configuration& to) const; at least 0, a sum over the robots
//   double least_cost(const Configuration&) const; a lower bound of the cost to the end
//   void order(const Memo&, std::vector<int>& robots) const; the most important first
//   void moves(const Configuration&, int robot, std::vector<int>& found) const; where a robot may go, or stay
//   bool next(const Configuration& from, const Memo&, std::span<const Constraint>, Configuration& to, Memo&);
struct Constraint {
  int robot;
  int where;
};

template <class Generator>
class Lacam {
 public:
  using Memo = typename Generator::Memo;
  struct Node {
    Configuration configuration;
    Memo memo;
    int parent;
    double cost;        // from the start
    double least_cost;  // to the end, at least
    std::vector<int> order;
    struct Said {
      int parent;  // the index of what is said beside
      int depth;
      int where;
    };
    std::vector<Said> constraints;
    std::size_t taken = 0;
    std::vector<int> neighbours;
  };

  Lacam(Generator generator, std::uint64_t seed, bool anytime)
      : generator_(std::move(generator)), random_(seed), anytime_(anytime) {
    open_.push_back(add(generator_.start(), generator_.memo(), -1));
  }

  // Takes so many constraints at most.
  void advance(int expansions) {
    while (!open_.empty() && expansions-- > 0 && (goal_ < 0 || anytime_)) expand();
  }

  SearchState state() const {
    if (goal_ < 0) return open_.empty() ? SearchState::kUnsolvable : SearchState::kSearching;
    return open_.empty() ? SearchState::kOptimal : SearchState::kSolved;
  }
  // Of the best solution so far.
  double cost() const { return nodes_[goal_].cost; }
  int goal() const { return goal_; }
  std::size_t size() const { return nodes_.size(); }
  const Node& node(int index) const { return nodes_[index]; }
  const Generator& generator() const { return generator_; }

  // The nodes from the start to this one.
  std::vector<int> way_to(int index) const {
    std::vector<int> way;
    for (; index >= 0; index = nodes_[index].parent) way.push_back(index);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  static constexpr double kRestart = 0.01;    // back to the start instead of to a known configuration
  static constexpr double kElsewhere = 0.01;  // another node than the top one, once there is a solution

  void expand() {
    if (goal_ >= 0 && random_.uniform() < kElsewhere) {
      std::swap(open_[random_.below(static_cast<int>(open_.size()))], open_.back());
    }
    const int at = open_.back();
    Node& node = nodes_[at];
    if (goal_ >= 0 && node.cost + node.least_cost >= nodes_[goal_].cost) {
      open_.pop_back();
    } else if (goal_ < 0 && generator_.finished(node.configuration, node.memo)) {
      goal_ = at;
    } else if (node.taken == node.constraints.size()) {
      open_.pop_back();
    } else {
      step(at);
    }
  }

  void step(int at) {
    take_constraint(nodes_[at]);
    Configuration to;
    Memo memo;
    if (!generator_.next(nodes_[at].configuration, nodes_[at].memo, said_, to, memo)) return;
    if (const int known = find(to); known >= 0) {
      rewire(at, known);
      generator_.again(nodes_[known].memo, memo);
      open_.push_back(random_.uniform() < kRestart ? 0 : known);
    } else {
      open_.push_back(add(std::move(to), std::move(memo), at));
    }
  }

  // Into said_; what may be said beside it goes to the end of the queue.
  void take_constraint(Node& node) {
    const int index = static_cast<int>(node.taken++);
    const int depth = node.constraints[index].depth;
    said_.clear();
    for (int k = index; node.constraints[k].depth > 0; k = node.constraints[k].parent) {
      said_.push_back({node.order[node.constraints[k].depth - 1], node.constraints[k].where});
    }
    if (depth == static_cast<int>(node.order.size())) return;
    generator_.moves(node.configuration, node.order[depth], moves_);
    for (std::size_t k = moves_.size(); k > 1; --k)
      std::swap(moves_[k - 1], moves_[random_.below(static_cast<int>(k))]);
    for (const int where : moves_) node.constraints.push_back({index, depth + 1, where});
  }

  int add(Configuration configuration, Memo memo, int parent) {
    const int index = static_cast<int>(nodes_.size());
    explored_.emplace(hash(configuration), index);
    const double cost =
        parent < 0 ? 0 : nodes_[parent].cost + generator_.cost(nodes_[parent].configuration, configuration);
    const double least = generator_.least_cost(configuration);
    nodes_.push_back({std::move(configuration), std::move(memo), parent, cost, least, {}, {{0, 0, 0}}, 0, {}});
    generator_.order(nodes_.back().memo, nodes_.back().order);
    if (parent >= 0) nodes_[parent].neighbours.push_back(index);
    return index;
  }

  // A shorter way to what is known, and to all behind it.
  void rewire(int from, int to) {
    nodes_[from].neighbours.push_back(to);
    std::vector<int> queue{from};
    for (std::size_t k = 0; k < queue.size(); ++k) {
      const Node& node = nodes_[queue[k]];
      for (const int index : node.neighbours) {
        Node& other = nodes_[index];
        const double cost = node.cost + generator_.cost(node.configuration, other.configuration);
        if (cost >= other.cost) continue;
        other.cost = cost;
        other.parent = queue[k];
        queue.push_back(index);
        if (goal_ >= 0 && other.cost + other.least_cost < nodes_[goal_].cost) open_.push_back(index);
      }
    }
  }

  int find(const Configuration& configuration) const {
    const auto [begin, end] = explored_.equal_range(hash(configuration));
    for (auto k = begin; k != end; ++k) {
      if (nodes_[k->second].configuration == configuration) return k->second;
    }
    return -1;
  }

  static std::uint64_t hash(const Configuration& configuration) {
    std::uint64_t value = 14695981039346656037ULL;  // FNV-1a
    for (const int where : configuration) value = (value ^ static_cast<std::uint64_t>(where)) * 1099511628211ULL;
    return value ^ (value >> 32);
  }

  Generator generator_;
  Random random_;
  bool anytime_;
  std::deque<Node> nodes_;
  std::unordered_multimap<std::uint64_t, int> explored_;
  std::vector<int> open_;
  int goal_ = -1;
  std::vector<Constraint> said_;
  std::vector<int> moves_;
};

}  // namespace muster
