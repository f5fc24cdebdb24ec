// Samples on edges: Papadimitriou 1985, "An algorithm for shortest-path motion in three dimensions".
#include "air_ways.hpp"

#include <algorithm>
#include <limits>

#include "heap.hpp"
#include "parallel.hpp"

namespace muster {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Open {
  double key;
  int node;
};

// Where a way from a to b turns on an edge: where it is straight when both sides are laid out flat.
Spot turning_point(const AirEdge& edge, Spot a, Spot b) {
  const Spot d = edge.to - edge.from;
  const double square = dot(d, d);
  if (square == 0.0) return edge.from;
  const double at_a = dot(a - edge.from, d) / square, at_b = dot(b - edge.from, d) / square;
  const double off_a = distance(a, edge.from + at_a * d), off_b = distance(b, edge.from + at_b * d);
  const double whole = off_a + off_b;
  const double t = whole > 0.0 ? (at_a * off_b + at_b * off_a) / whole : (at_a + at_b) / 2;
  return edge.from + std::clamp(t, 0.0, 1.0) * d;
}

double length_of(const std::vector<Spot>& way) {
  double length = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) length += distance(way[k - 1], way[k]);
  return length;
}

}  // namespace

struct AirWays::Tree {
  std::vector<double> length;
  std::vector<int> parent;
};

void AirWays::sample(double rise, double run) {
  const auto& edges = air_->edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double length = distance(edges[e].from, edges[e].to);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / (edges[e].upright ? rise : run))));
    // The end of a level edge is the beginning of the next.
    for (int k = 0; k <= (edges[e].upright ? steps : steps - 1); ++k) {
      const Spot at = edges[e].from + (static_cast<double>(k) / steps) * (edges[e].to - edges[e].from);
      if (air_->free(at)) nodes_.push_back({at, static_cast<int>(e), !edges[e].upright && k == 0});
    }
  }
}

void AirWays::build(int threads) {
  pieces_.assign(nodes_.size(), {});
  for_each_parallel(static_cast<int>(nodes_.size()), threads, [&] {
    return [&](int k) {
      const Node& node = nodes_[k];
      for (std::size_t o = 0; o < nodes_.size(); ++o) {
        const Node& other = nodes_[o];
        const Spot d = other.at - node.at;
        if (static_cast<int>(o) == k || !taut(node, d) || !taut(other, d)) continue;
        if (air_->sees(node.at, other.at)) pieces_[k].push_back({static_cast<int>(o), distance(node.at, other.at)});
      }
    };
  });
}

AirWays::Seat AirWays::seat(Spot p) const {
  Seat seat{p, air_->free(p), {}};
  if (!seat.free) return seat;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Spot at = nodes_[k].at;
    if (taut(nodes_[k], at - p) && air_->sees(p, at)) seat.nodes.push_back({static_cast<int>(k), distance(p, at)});
  }
  return seat;
}

void AirWays::grow(const Seat& from, Tree& tree) const {
  tree.length.assign(nodes_.size(), kFar);
  tree.parent.assign(nodes_.size(), -1);
  Heap<Open> open;
  const auto reach = [&](const Piece& piece, double before, int parent) {
    const double length = before + piece.length;
    if (length >= tree.length[piece.other]) return;
    tree.length[piece.other] = length;
    tree.parent[piece.other] = parent;
    open.push({length, piece.other});
  };
  for (const Piece& piece : from.nodes) reach(piece, 0.0, -1);
  while (!open.empty()) {
    const Open top = open.pop();
    if (top.key > tree.length[top.node]) continue;
    for (const Piece& piece : pieces_[top.node]) reach(piece, top.key, top.node);
  }
}

std::vector<Spot> AirWays::way(Spot a, Spot b) const {
  const Seat from = seat(a), to = seat(b);
  Tree tree;
  grow(from, tree);
  return way(from, to, tree);
}

std::vector<Spot> AirWays::way(const Seat& from, const Seat& to, const Tree& tree) const {
  if (!from.free || !to.free) return {};
  if (air_->sees(from.at, to.at)) return {from.at, to.at};
  int last = -1;
  double best = kFar;
  for (const Piece& piece : to.nodes) {
    if (tree.length[piece.other] + piece.length < best) best = tree.length[last = piece.other] + piece.length;
  }
  if (last < 0) return {};
  std::vector<Spot> way{to.at};
  std::vector<int> edges{-1};
  for (int node = last; node >= 0; node = tree.parent[node]) {
    way.push_back(nodes_[node].at);
    edges.push_back(nodes_[node].edge);
  }
  way.push_back(from.at);
  edges.push_back(-1);
  std::reverse(way.begin(), way.end());
  std::reverse(edges.begin(), edges.end());
  pull(way, edges);
  return way;
}

// Slides and drops turning points as long as that helps. What slides out of sight goes back halfway.
void AirWays::pull(std::vector<Spot>& way, std::vector<int>& edges) const {
  constexpr int kRounds = 8, kHalvings = 6;
  for (int round = 0; round < kRounds; ++round) {
    shorten(way, edges);
    const double before = length_of(way);
    std::vector<Spot> moved = way;
    while (slide(moved, edges)) {
    }
    for (int k = 0; k < kHalvings && !all_seen(moved); ++k) {
      for (std::size_t p = 0; p < way.size(); ++p) moved[p] = 0.5 * (way[p] + moved[p]);
    }
    if (!all_seen(moved) || length_of(moved) > before) return;
    way = moved;
    if (before - length_of(way) <= 1e-9 * before) return;
  }
}

// One pass over the turning points; whether it has gained enough to go on.
bool AirWays::slide(std::vector<Spot>& way, const std::vector<int>& edges) const {
  const double before = length_of(way);
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    way[k] = turning_point(air_->edges()[edges[k]], way[k - 1], way[k + 1]);
  }
  return before - length_of(way) > 1e-10 * before;
}

bool AirWays::all_seen(const std::vector<Spot>& way) const {
  for (std::size_t k = 1; k < way.size(); ++k) {
    if (!air_->sees(way[k - 1], way[k])) return false;
  }
  return true;
}

void AirWays::shorten(std::vector<Spot>& way, std::vector<int>& edges) const {
  for (std::size_t k = 1; k + 1 < way.size();) {
    if (air_->sees(way[k - 1], way[k + 1])) {
      way.erase(way.begin() + static_cast<std::ptrdiff_t>(k));
      edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      ++k;
    }
  }
}

std::vector<double> AirWays::lengths(const std::vector<Spot>& places, int first, int last, int threads) const {
  std::vector<Seat> seats(places.size());
  for_each_parallel(static_cast<int>(places.size()), threads, [&] { return [&](int k) { seats[k] = seat(places[k]); }; });
  std::vector<double> table(static_cast<std::size_t>(last - first) * places.size(), kFar);
  for_each_parallel(last - first, threads, [&] {
    return [&, tree = Tree{}](int k) mutable {
      const std::size_t i = static_cast<std::size_t>(first) + k;
      if (!seats[i].free) return;
      grow(seats[i], tree);
      double* row = &table[static_cast<std::size_t>(k) * places.size()];
      row[i] = 0.0;
      for (std::size_t j = i + 1; j < places.size(); ++j) {
        const std::vector<Spot> found = way(seats[i], seats[j], tree);
        if (!found.empty()) row[j] = length_of(found);
      }
    };
  });
  return table;
}

}  // namespace muster
