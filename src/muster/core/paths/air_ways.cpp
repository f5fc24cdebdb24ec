// Samples on edges: [papadimitriou1985].
#include "paths/air_ways.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "heap.hpp"
#include "infinity.hpp"

namespace muster {

namespace {

// Ways as much longer than the shortest on samples are looked at: pulled straight they may be shorter.
constexpr double kWorthTightening = 1.03;

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

// A way and the edge on which each of its points is; -1: an end. None where its points are samples.
struct AirWays::String {
  std::vector<Spot> way;
  std::vector<int> edges;
  double length = 0.0;
};

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
  next_edge_.assign(nodes_.size(), nodes_.size());
  for (std::size_t k = nodes_.size(); k-- > 1;)
    next_edge_[k - 1] = nodes_[k - 1].edge == nodes_[k].edge ? next_edge_[k] : k;
}

void AirWays::build(int threads, const Pause& pause) {
  pieces_.assign(nodes_.size(), {});
  for_each_parallel(static_cast<int>(nodes_.size()), threads, pause, [&] {
    return [&, blocker = std::size_t{0}](int k) mutable { look_around(static_cast<std::size_t>(k), blocker); };
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
  built_ = true;
}

// Finds which nodes after this one it sees. Whether a piece is taut at an upright edge is the same for all samples of
// it.
void AirWays::look_around(std::size_t k, std::size_t& blocker) {
  const Node& node = nodes_[k];
  for (std::size_t o = k + 1; o < nodes_.size();) {
    const int edge = nodes_[o].edge;
    const bool upright = loose_[edge].upright;
    if (upright && !taut(nodes_[o], nodes_[o].at - node.at)) {
      o = next_edge_[o];
      continue;
    }
    for (const std::size_t end = upright ? next_edge_[o] : o + 1; o < end; ++o) {
      const Spot d = nodes_[o].at - node.at;
      if (!taut(node, d) || !(upright || taut(nodes_[o], d))) continue;
      if (air_->sees(node.at, nodes_[o].at, blocker))
        pieces_[k].push_back({static_cast<int>(o), distance(node.at, nodes_[o].at)});
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

// A* in the graph that is not built: a sample looks around when its turn comes, and only at samples by which a way may
// lead that is worth tightening. What the tree has of such ways is what `grow` finds.
void AirWays::grow_towards(const Seat& from, const Seat& to, Tree& tree, const Pause& pause) const {
  tree.length.assign(nodes_.size(), kFar);
  tree.parent.assign(nodes_.size(), -1);
  std::vector<double> last(nodes_.size(), kFar), left(nodes_.size());  // metres to the goal, if it is seen; as it flies
  for (const Piece& piece : to.nodes) last[piece.other] = piece.length;
  for (std::size_t k = 0; k < nodes_.size(); ++k) left[k] = distance(nodes_[k].at, to.at);
  std::vector<bool> looked(nodes_.size());
  double most = kFar;
  Heap<Open> open;
  const auto pays = [&](std::size_t k, double length) { return length < tree.length[k] && length + left[k] <= most; };
  const auto reach = [&](std::size_t k, double length, int parent) {
    tree.length[k] = length;
    tree.parent[k] = parent;
    most = std::min(most, kWorthTightening * (length + last[k]));
    open.push({length + left[k], static_cast<int>(k)});
  };
  for (const Piece& piece : from.nodes) reach(static_cast<std::size_t>(piece.other), piece.length, -1);
  std::size_t blocker = 0;
  Pauses pauses(pause);
  while (!open.empty() && open.top().key <= most) {
    const auto here = static_cast<std::size_t>(open.pop().node);
    if (looked[here]) continue;
    looked[here] = true;
    ++looks_;
    pauses.next();
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const Spot d = nodes_[k].at - nodes_[here].at;
      const double length = tree.length[here] + std::sqrt(dot(d, d));
      if (k == here || !pays(k, length) || !taut(nodes_[here], d) || !taut(nodes_[k], d)) continue;
      if (air_->sees(nodes_[here].at, nodes_[k].at, blocker)) reach(k, length, static_cast<int>(here));
    }
  }
}

std::vector<Spot> AirWays::way(Spot a, Spot b, const Pause& pause) const {
  if (air_->free(a) && air_->free(b) && air_->sees(a, b)) return {a, b};
  const Seat from = seat(a), to = seat(b);
  Tree tree;
  if (built_) {
    grow(from, tree);
  } else {
    grow_towards(from, to, tree, pause);
  }
  return way(from, to, tree);
}

std::vector<Spot> AirWays::way(const Seat& from, const Seat& to, const Tree& tree) const {
  if (!from.free || !to.free) return {};
  if (air_->sees(from.at, to.at)) return {from.at, to.at};
  constexpr double kWorthPulling = 1.03;
  std::map<std::vector<int>, String> strings;  // by their edges
  for (const int last : candidates(to, tree)) {
    String string;
    string.way.push_back(to.at);
    for (int node = last; node >= 0; node = tree.parent[node]) string.way.push_back(nodes_[node].at);
    string.way.push_back(from.at);
    std::reverse(string.way.begin(), string.way.end());
    String tight = string;
    tighten(tight.way, tight.edges);
    // But for rounding it is seen; else the way stays on the samples.
    if (all_seen(tight.way)) string = std::move(tight);
    string.length = length_of(string.way);
    strings.try_emplace(std::vector<int>(string.edges), std::move(string));
  }
  std::vector<String> order;
  for (auto& [_, string] : strings) order.push_back(std::move(string));
  std::sort(order.begin(), order.end(), [](const String& l, const String& r) { return l.length < r.length; });
  std::vector<Spot> shortest;
  double least = kFar;
  for (String& string : order) {
    if (string.length > kWorthPulling * least) break;
    if (!string.edges.empty()) pull(string.way, string.edges);
    if (const double length = length_of(string.way); length < least) least = length, shortest = std::move(string.way);
  }
  return shortest;
}

// The best last node of each edge, for what is second between samples may be first when it is pulled straight.
std::vector<int> AirWays::candidates(const Seat& to, const Tree& tree) const {
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
    if (open.key <= kWorthTightening * least) order.push_back(open);
  }
  std::sort(order.begin(), order.end(), [](const Open& a, const Open& b) { return a.key < b.key; });
  std::vector<int> nodes;
  for (std::size_t k = 0; k < std::min(kMost, order.size()); ++k) nodes.push_back(order[k].node);
  return nodes;
}

// Lays a way around the true edges, turn by turn.
void AirWays::tighten(std::vector<Spot>& way, std::vector<int>& edges) const {
  std::vector<Spot> tight{way.front()};
  std::vector<int> on{-1};
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    for (const auto& [at, edge] : air_->tight_turns(tight.back(), way[k], way[k + 1])) {
      tight.push_back(at);
      on.push_back(edge);
    }
  }
  tight.push_back(way.back());
  on.push_back(-1);
  way = std::move(tight);
  edges = std::move(on);
}

// Tightens and slides as long as that helps. Where all turns at once would slide out of sight, one at a time does.
void AirWays::pull(std::vector<Spot>& way, std::vector<int>& edges) const {
  constexpr int kRounds = 40, kPasses = 30;
  for (int round = 0; round < kRounds; ++round) {
    const double before = length_of(way);
    std::vector<Spot> moved = way;
    std::vector<int> on = edges;
    for (int pass = 0; pass < kPasses && slide(moved, on); ++pass) {
    }
    if (!all_seen(moved)) {
      moved = way;
      slide_around(moved, on);
    }
    tighten(moved, on);
    if (!all_seen(moved) || length_of(moved) >= before) return;  // but for rounding it is seen
    way = std::move(moved);
    edges = std::move(on);
    if (before - length_of(way) <= 1e-8 * before) return;
  }
}

// A turn that slides takes the string along: what that meets on its way, it is laid around.
void AirWays::slide_around(std::vector<Spot>& way, std::vector<int>& edges) const {
  constexpr double kLeastShare = 0.05;
  std::vector<Spot> laid{way.front()};
  std::vector<int> on{-1};
  const auto turn = [&](Spot at, int edge) {
    laid.push_back(at);
    on.push_back(edge);
  };
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    const Spot before = laid.back(), at = way[k], after = way[k + 1];
    const int edge = best_edge_at(at, edges[k], before, after);
    const Spot wanted = turning_point(air_->edges()[edge], before, after);
    double share = distance(at, wanted) > Air::kTouch ? 1.0 : 0.0;
    for (; share > kLeastShare; share /= 2) {
      const Spot there = at + share * (wanted - at);
      if (!air_->sees(at, there)) continue;  // edges run through other obstacles
      const auto first = air_->tight_turns(before, at, there), then = air_->tight_turns(there, at, after);
      std::vector<Spot> string{before};
      for (const auto& [point, _] : first) string.push_back(point);
      string.push_back(there);
      for (const auto& [point, _] : then) string.push_back(point);
      string.push_back(after);
      if (length_of(string) >= distance(before, at) + distance(at, after)) continue;
      for (const auto& [point, other] : first) turn(point, other);
      turn(there, edge);
      for (const auto& [point, other] : then) turn(point, other);
      break;
    }
    if (share <= kLeastShare) turn(at, edge);
  }
  turn(way.back(), -1);
  way = std::move(laid);
  edges = std::move(on);
}

// Where edges meet, the one along which the turn gains most.
int AirWays::best_edge_at(Spot turn, int edge, Spot before, Spot after) const {
  double least = distance(before, turn) + distance(turn, after);
  int best = edge;
  for (const int other : air_->edges_at(turn, edge)) {
    const Spot there = turning_point(air_->edges()[other], before, after);
    const double length = distance(before, there) + distance(there, after);
    if (length < least) least = length, best = other;
  }
  return best;
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
  return before - length_of(way) > 1e-9 * before;
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
