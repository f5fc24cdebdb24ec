#include "paths/tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace muster {

namespace {

double coordinate(Spot p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

}  // namespace

Tree::Tree(Room room, Spot start, Spot goal, std::uint64_t seed, TreeSettings settings)
    : room_(std::move(room)), goal_(goal), random_(seed), settings_(settings) {
  nodes_.push_back({.at = start, .parent = -1, .length = 0.0, .children = {}});
  if (distance(start, goal) <= settings.step && room_.sees(start, goal)) at_goal_.push_back(0);
}

void Tree::grow(int samples) {
  for (int k = 0; k < samples; ++k) extend(sample());
}

Spot Tree::sample() {
  if (random_.uniform() < settings_.goal_share) return goal_;
  const auto between = [&](double low, double high) { return low + random_.uniform() * (high - low); };
  Spot p{between(room_.low.x, room_.high.x), between(room_.low.y, room_.high.y), 0.0};
  if (room_.dimensions == 3) p.z = between(room_.low.z, room_.high.z);
  return p;
}

Spot Tree::steer(Spot from, Spot towards) const {
  const double far = distance(from, towards);
  return far <= settings_.step ? towards : from + (settings_.step / far) * (towards - from);
}

void Tree::extend(Spot towards) {
  const int close = nearest(towards);
  const Spot at = steer(nodes_[close].at, towards);
  if (at.x == nodes_[close].at.x && at.y == nodes_[close].at.y && at.z == nodes_[close].at.z) return;
  if (!room_.free(at) || !room_.sees(nodes_[close].at, at)) return;
  const std::vector<int> near = within(at, radius());
  int parent = close;
  double length = nodes_[close].length + distance(nodes_[close].at, at);
  for (const int node : near) {
    const double by = nodes_[node].length + distance(nodes_[node].at, at);
    if (by < length && room_.sees(nodes_[node].at, at)) parent = node, length = by;
  }
  const int added = add(at, parent, length);
  rewire(added, near);
  if (distance(at, goal_) <= settings_.step && room_.sees(at, goal_)) at_goal_.push_back(added);
}

int Tree::add(Spot at, int parent, double length) {
  const auto added = static_cast<int>(nodes_.size());
  nodes_.push_back({.at = at, .parent = parent, .length = length, .children = {}});
  nodes_[parent].children.push_back(added);
  for (int node = 0, axis = 0;; axis = (axis + 1) % room_.dimensions) {
    int& branch = coordinate(at, axis) < coordinate(nodes_[node].at, axis) ? nodes_[node].less : nodes_[node].more;
    if (branch < 0) {
      branch = added;
      return added;
    }
    node = branch;
  }
}

// Those near to whom the way by the new node is shorter get it for a parent.
void Tree::rewire(int node, const std::vector<int>& near) {
  for (const int other : near) {
    const double by = nodes_[node].length + distance(nodes_[node].at, nodes_[other].at);
    if (by >= nodes_[other].length || !room_.sees(nodes_[node].at, nodes_[other].at)) continue;
    std::erase(nodes_[nodes_[other].parent].children, other);
    nodes_[other].parent = node;
    nodes_[node].children.push_back(other);
    pass_on(other, nodes_[other].length - by);
  }
}

void Tree::pass_on(int node, double gain) {
  std::vector<int> open{node};
  while (!open.empty()) {
    Node& each = nodes_[open.back()];
    open.pop_back();
    each.length -= gain;
    open.insert(open.end(), each.children.begin(), each.children.end());
  }
}

// gamma (log n / n)^(1/d), gamma above 2 (1 + 1/d)^(1/d) (volume / volume of the unit ball)^(1/d); at most a step.
double Tree::radius() const {
  const double d = room_.dimensions, n = static_cast<double>(nodes_.size());
  const Spot size = room_.high - room_.low;
  const double volume = room_.dimensions == 2 ? size.x * size.y : size.x * size.y * size.z;
  const double ball = room_.dimensions == 2 ? std::numbers::pi : 4.0 / 3.0 * std::numbers::pi;
  const double gamma = 2.0 * std::pow((1.0 + 1.0 / d) * volume / ball, 1.0 / d);
  return std::min(settings_.step, settings_.reach * gamma * std::pow(std::log(n) / n, 1.0 / d));
}

int Tree::nearest(Spot p) const {
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  struct PendingNode {
    int node, axis;
    double off;  // how far the branch is away at least
  };
  std::vector<PendingNode> open{{0, 0, 0.0}};
  while (!open.empty()) {
    const PendingNode visit = open.back();
    open.pop_back();
    if (visit.node < 0 || visit.off >= least) continue;
    const Node& node = nodes_[visit.node];
    const double far = distance(p, node.at);
    if (far < least) least = far, best = visit.node;
    const double beyond = coordinate(p, visit.axis) - coordinate(node.at, visit.axis);
    const int next = (visit.axis + 1) % room_.dimensions;
    open.push_back({beyond < 0.0 ? node.more : node.less, next, std::abs(beyond)});
    open.push_back({beyond < 0.0 ? node.less : node.more, next, 0.0});
  }
  return best;
}

std::vector<int> Tree::within(Spot p, double radius) const {
  std::vector<int> found;
  std::vector<std::pair<int, int>> open{{0, 0}};
  while (!open.empty()) {
    const auto [at, axis] = open.back();
    open.pop_back();
    if (at < 0) continue;
    const Node& node = nodes_[at];
    if (distance(p, node.at) <= radius) found.push_back(at);
    const double beyond = coordinate(p, axis) - coordinate(node.at, axis);
    const int next = (axis + 1) % room_.dimensions;
    if (beyond >= -radius) open.emplace_back(node.more, next);
    if (beyond <= radius) open.emplace_back(node.less, next);
  }
  return found;
}

std::vector<Spot> Tree::way() const {
  int last = -1;
  double best = std::numeric_limits<double>::infinity();
  for (const int node : at_goal_) {
    const double whole = nodes_[node].length + distance(nodes_[node].at, goal_);
    if (whole < best) best = whole, last = node;
  }
  std::vector<Spot> way;
  if (last < 0) return way;
  if (distance(nodes_[last].at, goal_) > 0.0) way.push_back(goal_);
  for (int node = last; node >= 0; node = nodes_[node].parent) way.push_back(nodes_[node].at);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace muster
