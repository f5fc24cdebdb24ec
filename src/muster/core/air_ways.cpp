// Samples on edges: [papadimitriou1985].
#include "air_ways.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "heap.hpp"

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
  constexpr double kOff = 0.25;  // of the distance between samples
  loose_ = air_->loose_edges(kOff * run);
  const auto& edges = loose_;
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

void AirWays::build(int threads, const Pause& pause) {
  pieces_.assign(nodes_.size(), {});
  for_each_parallel(static_cast<int>(nodes_.size()), threads, pause, [&] {
    return [&, blocker = std::size_t{0}](int k) mutable {
      const Node& node = nodes_[k];
      for (std::size_t o = static_cast<std::size_t>(k) + 1; o < nodes_.size(); ++o) {
        const Node& other = nodes_[o];
        const Spot d = other.at - node.at;
        if (!taut(node, d) || !taut(other, d)) continue;
        if (air_->sees(node.at, other.at, blocker))
          pieces_[k].push_back({static_cast<int>(o), distance(node.at, other.at)});
      }
    };
  });
  // So far each piece is known at one end.
  std::vector<std::size_t> found;
  for (const auto& pieces : pieces_) found.push_back(pieces.size());
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    for (std::size_t p = 0; p < found[k]; ++p) {
      const Piece piece = pieces_[k][p];
      pieces_[piece.other].push_back({static_cast<int>(k), piece.length});
    }
  }
}

AirWays::Seat AirWays::seat(Spot p) const {
  Seat seat{p, air_->free(p), {}};
  if (!seat.free) return seat;
  std::size_t blocker = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Spot at = nodes_[k].at;
    if (taut(nodes_[k], at - p) && air_->sees(p, at, blocker))
      seat.nodes.push_back({static_cast<int>(k), distance(p, at)});
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
  std::vector<Spot> shortest;
  std::set<std::vector<int>> pulled;  // by their edges
  for (const int last : candidates(to, tree)) {
    std::vector<Spot> way{to.at};
    for (int node = last; node >= 0; node = tree.parent[node]) way.push_back(nodes_[node].at);
    way.push_back(from.at);
    std::reverse(way.begin(), way.end());
    std::vector<int> edges = tighten(way);
    if (!pulled.insert(edges).second) continue;
    pull(way, edges);
    if (shortest.empty() || length_of(way) < length_of(shortest)) shortest = std::move(way);
  }
  return shortest;
}

// The best last node of each edge, for what is second between samples may be first when it is pulled straight.
std::vector<int> AirWays::candidates(const Seat& to, const Tree& tree) const {
  constexpr double kWorthPulling = 1.03;
  constexpr std::size_t kMost = 8;
  std::map<int, Open> best;  // of each edge
  double least = kFar;
  for (const Piece& piece : to.nodes) {
    const double whole = tree.length[piece.other] + piece.length;
    if (whole == kFar) continue;
    least = std::min(least, whole);
    const auto [at, fresh] = best.try_emplace(nodes_[piece.other].edge, Open{whole, piece.other});
    if (!fresh && whole < at->second.key) at->second = {whole, piece.other};
  }
  std::vector<Open> order;
  for (const auto& [edge, open] : best) {
    if (open.key <= kWorthPulling * least) order.push_back(open);
  }
  std::sort(order.begin(), order.end(), [](const Open& a, const Open& b) { return a.key < b.key; });
  std::vector<int> nodes;
  for (std::size_t k = 0; k < std::min(kMost, order.size()); ++k) nodes.push_back(order[k].node);
  return nodes;
}

// Lays a way around the true edges, turn by turn; on which each turning point is then (the ends: -1).
std::vector<int> AirWays::tighten(std::vector<Spot>& way) const {
  std::vector<Spot> tight{way.front()};
  std::vector<int> edges{-1};
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    for (const auto& [at, edge] : air_->tight_turns(tight.back(), way[k], way[k + 1])) {
      tight.push_back(at);
      edges.push_back(edge);
    }
  }
  tight.push_back(way.back());
  edges.push_back(-1);
  way = std::move(tight);
  return edges;
}

// Slides and drops turning points as long as that helps. Where all at once would slide out of sight, one at a time.
void AirWays::pull(std::vector<Spot>& way, std::vector<int>& edges) const {
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    shorten(way, edges);
    const double before = length_of(way);
    std::vector<Spot> moved = way;
    while (slide(moved, edges)) {
    }
    if (all_seen(moved)) {
      way = moved;
    } else {
      slide_in_sight(way, edges);
      turn_where_stuck(way, edges);
    }
    if (before - length_of(way) <= 1e-9 * before) return;
  }
}

void AirWays::slide_in_sight(std::vector<Spot>& way, const std::vector<int>& edges) const {
  constexpr double kLeastShare = 0.05;
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    const Spot before = way[k - 1], at = way[k], after = way[k + 1];
    const Spot wanted = turning_point(air_->edges()[edges[k]], before, after);
    for (double share = 1.0; share > kLeastShare; share /= 2) {
      const Spot there = at + share * (wanted - at);
      if (!air_->sees(before, there) || !air_->sees(there, after)) continue;
      way[k] = there;
      break;
    }
  }
}

// A turning point that wants to go where it is not seen gets one more beside it, on an edge that lets it go there.
void AirWays::turn_where_stuck(std::vector<Spot>& way, std::vector<int>& edges) const {
  const auto& all = air_->edges();
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    const Spot before = way[k - 1], after = way[k + 1], wanted = turning_point(all[edges[k]], before, after);
    const bool hidden_before = !air_->sees(before, wanted), hidden_after = !air_->sees(wanted, after);
    if (hidden_before == hidden_after) continue;
    const Spot from = hidden_before ? before : wanted, to = hidden_before ? wanted : after;
    const double rest = hidden_before ? distance(wanted, after) : distance(before, wanted);
    double best = distance(before, way[k]) + distance(way[k], after) - rest;
    int edge = -1;
    for (std::size_t e = 0; e < all.size(); ++e) {
      const Spot turn = turning_point(all[e], from, to);
      const double length = distance(from, turn) + distance(turn, to);
      if (length < best * (1.0 - 1e-9) && air_->sees(from, turn) && air_->sees(turn, to))
        best = length, edge = static_cast<int>(e);
    }
    if (edge < 0) continue;
    way[k] = wanted;
    const auto at = static_cast<std::ptrdiff_t>(hidden_before ? k : k + 1);
    way.insert(way.begin() + at, turning_point(all[edge], from, to));
    edges.insert(edges.begin() + at, edge);
    ++k;
  }
}

// One pass over the turning points; whether it has gained enough to go on.
bool AirWays::slide(std::vector<Spot>& way, const std::vector<int>& edges) const {
  const auto& all = air_->edges();
  const double before = length_of(way);
  for (std::size_t k = 1; k + 1 < way.size();) {
    std::size_t end = k;  // of the upright edges, one after the other
    while (end + 1 < way.size() && all[edges[end]].upright) ++end;
    if (end > k + 1 && lay_evenly(way, edges, k - 1, end)) {
      k = end;
      continue;
    }
    for (const std::size_t last = std::max(end, k + 1); k < last; ++k) {
      way[k] = turning_point(all[edges[k]], way[k - 1], way[k + 1]);
    }
  }
  return before - length_of(way) > 1e-10 * before;
}

// Between two points the turns around upright edges alone are the shortest where the way rises evenly; if the edges are
// as high and as low as that.
bool AirWays::lay_evenly(std::vector<Spot>& way, const std::vector<int>& edges, std::size_t first,
                         std::size_t last) const {
  const auto level = [&](std::size_t k) { return std::hypot(way[k + 1].x - way[k].x, way[k + 1].y - way[k].y); };
  double whole = 0.0, gone = 0.0;
  for (std::size_t k = first; k < last; ++k) whole += level(k);
  if (whole == 0.0) return false;
  std::vector<double> heights;
  for (std::size_t k = first + 1; k < last; ++k) {
    gone += level(k - 1);
    const AirEdge& edge = air_->edges()[edges[k]];
    heights.push_back(way[first].z + gone / whole * (way[last].z - way[first].z));
    if (heights.back() < edge.from.z || heights.back() > edge.to.z) return false;
  }
  for (std::size_t k = first + 1; k < last; ++k) way[k].z = heights[k - first - 1];
  return true;
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

std::vector<double> AirWays::lengths(const std::vector<Spot>& places, int first, int last, int threads,
                                     const Pause& pause) const {
  std::vector<Seat> seats(places.size());
  for_each_parallel(static_cast<int>(places.size()), threads, pause,
                    [&] { return [&](int k) { seats[k] = seat(places[k]); }; });
  std::vector<double> table(static_cast<std::size_t>(last - first) * places.size(), kFar);
  for_each_parallel(last - first, threads, pause, [&] {
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
