#include "ways.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "heap.hpp"

namespace muster {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Open {
  double key;  // length, and in A* the estimate of the rest
  int corner;
};

bool turns_away(bool on_left, Lattice coming, Lattice leaving) {
  const std::int64_t to_left = cross(coming, leaving);
  return on_left ? to_left < 0 : to_left > 0;
}

}  // namespace

// The shortest ways from one place to corners.
struct Ways::Tree {
  struct Node {
    double length = kFar;
    int parent = -1;       // -1: the place itself
    bool on_left = false;  // the obstacle, as one comes
    bool closed = false;   // expanded
  };
  std::vector<Node> nodes;
  Heap<Open> open;

  void clear(std::size_t corners) {
    nodes.assign(corners, Node{});
    open.clear();
  }
  template <class Estimate>
  void reach(int corner, Node by, Estimate estimate) {
    Node& node = nodes[corner];
    if (by.length >= node.length || node.closed) return;
    node = by;
    open.push({by.length + estimate(corner), corner});
  }
};

Ways::Ways(std::shared_ptr<const Sights> sights) : sights_(std::move(sights)) {
  for (const Corner& corner : sights_->corners()) {
    at_.push_back({static_cast<std::int32_t>(corner.at.x), static_cast<std::int32_t>(corner.at.y)});
  }
}

void Ways::build(int threads, const Pause& pause) {
  const auto& corners = sights_->corners();
  const auto count = static_cast<int>(corners.size());
  std::vector<std::vector<int>> seen(corners.size());
  std::vector<std::size_t> on_right(corners.size());
  for_each_parallel(count, threads, pause, [&] {
    return [&](int c) {
      const Corner& corner = corners[c];
      auto others = sights_->neighbours(c);
      const auto direction = [&](int other) { return corners[other].at - corner.at; };
      const auto middle =
          std::partition(others.begin(), others.end(), [&](int o) { return !corner.on_left(direction(o)); });
      std::sort(others.begin(), middle, [&](int a, int b) { return cross(direction(a), direction(b)) > 0; });
      std::sort(middle, others.end(), [&](int a, int b) { return cross(direction(a), direction(b)) < 0; });
      on_right[c] = static_cast<std::size_t>(middle - others.begin());
      others.shrink_to_fit();
      seen[c] = std::move(others);
    };
  });
  first_.assign(1, 0);
  pieces_.clear();
  for (std::size_t c = 0; c < seen.size(); ++c) {
    first_.push_back(pieces_.size() + on_right[c]);
    for (const int o : seen[c]) {
      const bool on_left = corners[o].on_left(corners[o].at - corners[c].at);
      pieces_.push_back({distance(corners[c].place, corners[o].place), static_cast<std::uint32_t>(o), on_left});
    }
    first_.push_back(pieces_.size());
    seen[c] = {};
  }
}

Ways::Seat Ways::seat(Point p) const {
  const Lattice at = sights_->snap(p);
  if (!sights_->free(at)) return {at, p, false, {}};
  return {at, p, true, sights_->seen_from(at)};
}

std::vector<Ways::Seat> Ways::seats(const std::vector<Point>& places, int first, int threads,
                                    const Pause& pause) const {
  std::vector<Seat> all(places.size());
  for_each_parallel(static_cast<int>(places.size()) - first, threads, pause,
                    [&] { return [&](int k) { all[first + k] = seat(places[first + k]); }; });
  return all;
}

// Dijkstra over all corners; with a place to go to A*, which ends there.
void Ways::grow(const Seat& from, const Seat* to, Tree& tree) const {
  const auto& corners = sights_->corners();
  tree.clear(corners.size());
  for (const int c : from.corners) {
    const bool on_left = corners[c].on_left(corners[c].at - from.at);
    tree.reach(c, {distance(from.place, corners[c].place), -1, on_left}, [&](int) { return estimate(c, to); });
  }
  std::vector<int> ends = to ? to->corners : std::vector<int>{};
  std::sort(ends.begin(), ends.end());
  double best = kFar;
  while (!tree.open.empty() && tree.open.top().key < best) {
    const Open top = tree.open.pop();
    if (tree.nodes[top.corner].closed) continue;
    tree.nodes[top.corner].closed = true;
    if (std::binary_search(ends.begin(), ends.end(), top.corner)) best = top.key;
    if (built()) {
      expand(top.corner, from, to, tree);
    } else {
      look_around(top.corner, from, to, tree);
    }
  }
}

double Ways::estimate(int corner, const Seat* to) const {
  return to ? distance(sights_->corners()[corner].place, to->place) : 0.0;
}

// One who comes to a corner leaves it on the same side of the obstacle, and turns towards it.
void Ways::expand(int c, const Seat& from, const Seat* to, Tree& tree) const {
  const Tree::Node node = tree.nodes[c];
  const Lattice here = at_[c].wide();
  const Lattice coming = here - (node.parent < 0 ? from.at : at_[node.parent].wide());
  const std::size_t side = 2 * static_cast<std::size_t>(c) + node.on_left;
  for (std::size_t k = first_[side]; k < first_[side + 1]; ++k) {
    const Piece piece = pieces_[k];
    const auto other = static_cast<int>(piece.other);
    if (turns_away(node.on_left, coming, at_[other].wide() - here)) break;
    tree.reach(other, {node.length + piece.length, c, piece.on_left != 0}, [&](int) { return estimate(other, to); });
  }
}

// The same where the graph is not built.
void Ways::look_around(int c, const Seat& from, const Seat* to, Tree& tree) const {
  const Tree::Node node = tree.nodes[c];
  const auto& corners = sights_->corners();
  const Lattice coming = corners[c].at - (node.parent < 0 ? from.at : corners[node.parent].at);
  for (const int o : sights_->neighbours(c)) {
    const Lattice leaving = corners[o].at - corners[c].at;
    if (corners[c].on_left(leaving) != node.on_left || turns_away(node.on_left, coming, leaving)) continue;
    const double length = node.length + distance(corners[c].place, corners[o].place);
    tree.reach(o, {length, c, corners[o].on_left(leaving)}, [&](int) { return estimate(o, to); });
  }
}

Ways::Last Ways::last_piece(const Seat& from, const Seat& to, const Tree& tree) const {
  if (!from.free || !to.free) return {kFar, -1};
  Last best{sights_->sees(from.at, to.at) ? distance(from.place, to.place) : kFar, -1};
  for (const int corner : to.corners) {
    const double whole = tree.nodes[corner].length + distance(sights_->corners()[corner].place, to.place);
    if (whole < best.length) best = {whole, corner};
  }
  return best;
}

std::vector<Point> Ways::way(Point a, Point b) const {
  const Seat from = seat(a), to = seat(b);
  Tree tree;
  if (from.free && to.free) {
    if (sights_->sees(from.at, to.at)) return {a, b};
    grow(from, &to, tree);
  }
  const Last last = last_piece(from, to, tree);
  if (last.length == kFar) return {};
  std::vector<Point> way{b};
  for (int corner = last.corner; corner >= 0; corner = tree.nodes[corner].parent) {
    way.push_back(sights_->corners()[corner].place);
  }
  way.push_back(a);
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<double> Ways::lengths(const std::vector<Point>& exits, const std::vector<Point>& entries, bool mutual,
                                  int first, int last, int threads, const Pause& pause) const {
  const std::vector<Seat> ends = seats(entries, mutual ? first : 0, threads, pause);
  const std::size_t columns = entries.size();
  std::vector<double> table(static_cast<std::size_t>(last - first) * columns, kFar);
  for_each_parallel(last - first, threads, pause, [&] {
    return [&, tree = Tree{}](int k) mutable {
      const int i = first + k;
      const Seat from = mutual ? ends[i] : seat(exits[i]);
      if (!from.free) return;
      grow(from, nullptr, tree);
      double* row = &table[static_cast<std::size_t>(k) * columns];
      if (mutual) row[i] = 0.0;
      for (std::size_t j = mutual ? i + 1 : 0; j < columns; ++j) row[j] = last_piece(from, ends[j], tree).length;
    };
  });
  return table;
}

}  // namespace muster
