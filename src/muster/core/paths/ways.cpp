#include "paths/ways.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "buckets.hpp"
#include "infinity.hpp"
#include "parallel.hpp"
#include "paths/corner_search.hpp"

namespace muster {

namespace {

constexpr double kBuckets = 1024.0;  // across the extent

bool turns_away(bool on_left, Lattice coming, Lattice leaving) {
  const std::int64_t to_left = cross(coming, leaving);
  return on_left ? to_left < 0 : to_left > 0;
}

}  // namespace

// The places that a search looks for, and the box around them: the distance to it is the estimate of A*.
class Ways::Aims {
 public:
  explicit Aims(std::vector<const Seat*> seats) : seats_(std::move(seats)) {
    for (const Seat* seat : seats_) {
      low_ = {std::min(low_.x, seat->place.x), std::min(low_.y, seat->place.y)};
      high_ = {std::max(high_.x, seat->place.x), std::max(high_.y, seat->place.y)};
    }
  }

  const std::vector<const Seat*>& seats() const { return seats_; }
  double estimate(Point p) const {
    const double x = std::max({low_.x - p.x, p.x - high_.x, 0.0}), y = std::max({low_.y - p.y, p.y - high_.y, 0.0});
    return std::sqrt(x * x + y * y);
  }

 private:
  std::vector<const Seat*> seats_;
  Point low_{kFar, kFar};
  Point high_{-kFar, -kFar};
};

// The shortest ways from one place to corners.
struct Ways::Tree {
  struct Node {
    double length = kFar;
    int parent = -1;       // -1: the place itself
    bool on_left = false;  // the obstacle, as one comes
    bool open = false;     // to be expanded
  };
  std::vector<Node> nodes;
  Buckets open;
  std::vector<int> next;  // of one bucket

  // A piece makes keys rise by twice the extent at most: its length, and as much in the estimate.
  explicit Tree(double extent) : open(extent / kBuckets, 2.0 * extent) {}
  void clear(std::size_t corners) {
    nodes.assign(corners, Node{});
    open.clear();
  }
  template <class Estimate>
  void reach(int corner, Node by, Estimate estimate) {
    Node& node = nodes[corner];
    if (by.length >= node.length) return;
    node = by;
    node.open = true;
    open.push(by.length + estimate(), corner);
  }
};

Ways::Ways(std::shared_ptr<const Sights> sights) : sights_(std::move(sights)) {
  for (const Corner& corner : sights_->corners()) {
    at_.push_back({static_cast<std::int32_t>(corner.at.x), static_cast<std::int32_t>(corner.at.y)});
    place_.push_back(corner.place);
  }
}

void Ways::build(int most, int threads) {
  if (built()) return;
  const std::size_t begin = seen_.size(), end = std::min(corners(), begin + static_cast<std::size_t>(most));
  seen_.resize(end);
  for_each_parallel(static_cast<int>(end - begin), threads, [&] {
    return [&](int k) { seen_[begin + k] = sights_->neighbours(static_cast<int>(begin) + k); };
  });
  if (end < corners()) return;
  join();
  for_each_parallel(static_cast<int>(corners()), threads, [&] { return [&](int c) { sort_by_turn(c); }; });
  find_parts();
}

// Lays the pieces out from both their ends.
void Ways::join() {
  const auto& corners = sights_->corners();
  first_.assign(2 * corners.size() + 1, 0);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    first_[2 * c + 2] += seen_[c].size();
    for (const int o : seen_[c]) ++first_[2 * static_cast<std::size_t>(o) + 2];
  }
  for (std::size_t c = 0; c < corners.size(); ++c) first_[2 * c + 2] += first_[2 * c];
  pieces_.resize(first_.back());
  std::vector<std::size_t> next(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c) next[c] = first_[2 * c];
  const auto add = [&](int from, int to) {
    const bool on_left = corners[to].on_left(corners[to].at - corners[from].at);
    pieces_[next[from]++] = {static_cast<std::uint32_t>(to), on_left};
  };
  for (std::size_t c = 0; c < corners.size(); ++c) {
    for (const int o : seen_[c]) {
      add(static_cast<int>(c), o);
      add(o, static_cast<int>(c));
    }
  }
  seen_ = {};
}

void Ways::sort_by_turn(int c) {
  const Corner& corner = sights_->corners()[c];
  const auto direction = [&](Piece piece) { return at_[piece.other].wide() - corner.at; };
  const auto piece = [&](std::size_t k) { return pieces_.begin() + static_cast<std::ptrdiff_t>(k); };
  const auto begin = piece(first_[2 * c]), end = piece(first_[2 * c + 2]);
  const auto middle = std::partition(begin, end, [&](Piece p) { return !corner.on_left(direction(p)); });
  std::sort(begin, middle, [&](Piece a, Piece b) { return cross(direction(a), direction(b)) > 0; });
  std::sort(middle, end, [&](Piece a, Piece b) { return cross(direction(a), direction(b)) < 0; });
  first_[2 * c + 1] = static_cast<std::size_t>(middle - pieces_.begin());
}

void Ways::find_parts() {
  part_.assign(corners(), -1);
  std::vector<int> open;
  const auto visit = [&](int corner, int part) {
    if (part_[corner] >= 0) return;
    part_[corner] = part;
    open.push_back(corner);
  };
  for (int c = 0; c < static_cast<int>(corners()); ++c) {
    visit(c, c);
    while (!open.empty()) {
      const std::size_t here = 2 * static_cast<std::size_t>(open.back());
      open.pop_back();
      for (std::size_t k = first_[here]; k < first_[here + 2]; ++k) visit(static_cast<int>(pieces_[k].other), c);
    }
  }
}

Ways::Seat Ways::seat(Point p) const {
  const Lattice at = sights_->snap(p);
  Seat seat{at, p, sights_->free(at), {}, {}};
  if (!seat.free) return seat;
  seat.corners = sights_->seen_from(at, {});
  for (const int corner : seat.corners) seat.parts.push_back(part_[corner]);
  std::sort(seat.parts.begin(), seat.parts.end());
  seat.parts.erase(std::unique(seat.parts.begin(), seat.parts.end()), seat.parts.end());
  return seat;
}

std::vector<Ways::Seat> Ways::seats(const std::vector<Point>& places, int first, int threads) const {
  std::vector<Seat> all(places.size());
  for_each_parallel(static_cast<int>(places.size()) - first, threads,
                    [&] { return [&](int k) { all[first + k] = seat(places[first + k]); }; });
  return all;
}

// Whether there may be a way that turns.
bool Ways::may_reach(const Seat& from, const Seat& to) const {
  return std::find_first_of(from.parts.begin(), from.parts.end(), to.parts.begin(), to.parts.end()) != from.parts.end();
}

// A*, as far as some way may still become shorter.
void Ways::grow(const Seat& from, const Aims& aims, Tree& tree) const {
  constexpr double kPatience = 1.05;
  if (aims.seats().empty()) return;
  const auto& corners = sights_->corners();
  tree.clear(corners.size());
  for (const int c : from.corners) {
    const bool on_left = corners[c].on_left(corners[c].at - from.at);
    tree.reach(c, {distance(from.place, corners[c].place), -1, on_left},
               [&] { return aims.estimate(corners[c].place); });
  }
  double check = 0.0;
  while (!tree.open.empty()) {
    if (const double least = tree.open.least(); least >= check) {
      double longest = 0.0;
      for (const Seat* to : aims.seats()) longest = std::max(longest, last_piece(*to, tree).length);
      if (least >= longest) return;
      check = std::min(longest, kPatience * least);
    }
    tree.open.take(tree.next);
    std::erase_if(tree.next, [&](int corner) { return !std::exchange(tree.nodes[corner].open, false); });
    for (const int corner : tree.next) fetch(corner, tree);
    for (const int corner : tree.next) expand(corner, from, aims, tree);
  }
}

// Has the memory bring in time what a corner sees: the search waits for little else.
void Ways::fetch(int corner, const Tree& tree) const {
  __builtin_prefetch(pieces_.data() + first_[2 * static_cast<std::size_t>(corner) + tree.nodes[corner].on_left]);
}

// One who comes to a corner leaves it on the same side of the obstacle, and turns towards it.
void Ways::expand(int c, const Seat& from, const Aims& aims, Tree& tree) const {
  const Tree::Node node = tree.nodes[c];
  const Point place = place_[c];
  const Lattice here = at_[c].wide();
  const Lattice coming = here - (node.parent < 0 ? from.at : at_[node.parent].wide());
  const std::size_t side = 2 * static_cast<std::size_t>(c) + node.on_left;
  for (std::size_t k = first_[side]; k < first_[side + 1]; ++k) {
    const Piece piece = pieces_[k];
    const auto other = static_cast<int>(piece.other);
    if (turns_away(node.on_left, coming, at_[other].wide() - here)) break;
    const double length = node.length + distance(place, place_[other]);
    tree.reach(other, {length, c, piece.on_left != 0, true}, [&] { return aims.estimate(place_[other]); });
  }
}

Ways::Last Ways::last_piece(const Seat& to, const Tree& tree) const {
  Last best{kFar, -1};
  for (const int corner : to.corners) {
    const double whole = tree.nodes[corner].length + distance(sights_->corners()[corner].place, to.place);
    if (whole < best.length) best = {whole, corner};
  }
  return best;
}

std::vector<Point> Ways::way(Point a, Point b) const {
  if (!free(a) || !free(b)) return {};
  if (sees(a, b)) return {a, b};
  return built() ? way_in_graph(a, b) : way_alone(a, b).points;
}

CornerWay Ways::way_alone(Point a, Point b) const {
  CornerWay way = search_corners(*sights_, a, b);
  looks_ += way.looks;
  return way;
}

std::vector<Point> Ways::way_in_graph(Point a, Point b) const {
  const Seat from = seat(a), to = seat(b);
  if (!may_reach(from, to)) return {};
  Tree tree(sights_->extent());
  grow(from, Aims({&to}), tree);
  const Last last = last_piece(to, tree);
  if (last.length == kFar) return {};
  std::vector<Point> way{b};
  for (int corner = last.corner; corner >= 0; corner = tree.nodes[corner].parent) {
    way.push_back(sights_->corners()[corner].place);
  }
  way.push_back(a);
  std::reverse(way.begin(), way.end());
  return way;
}

std::optional<std::vector<double>> Ways::lengths_alone(const std::vector<Point>& exits,
                                                       const std::vector<Point>& entries, bool mutual,
                                                       const Pause& pause) const {
  std::vector<double> table(exits.size() * entries.size(), kFar);
  Pauses pauses(pause);
  for (std::size_t i = 0; i < exits.size(); ++i) {
    if (!free(exits[i])) continue;
    double* row = &table[i * entries.size()];
    if (mutual) row[i] = 0.0;
    for (std::size_t j = mutual ? i + 1 : 0; j < entries.size(); ++j) {
      pauses.next();
      if (graph_pays()) return std::nullopt;
      if (!free(entries[j])) continue;
      row[j] = sees(exits[i], entries[j]) ? distance(exits[i], entries[j]) : way_alone(exits[i], entries[j]).length;
    }
  }
  return table;
}

std::vector<double> Ways::lengths(const std::vector<Point>& exits, const std::vector<Point>& entries, bool mutual,
                                  int first, int last, int threads) const {
  if (!built()) throw std::logic_error("lengths of a table are found in the graph, which is not built");
  const std::vector<Seat> ends = seats(entries, mutual ? first : 0, threads);
  const std::size_t columns = entries.size();
  std::vector<double> table(static_cast<std::size_t>(last - first) * columns, kFar);
  for_each_parallel(last - first, threads, [&] {
    return [&, tree = Tree(sights_->extent())](int k) mutable {
      const int i = first + k;
      const Seat from = mutual ? ends[i] : seat(exits[i]);
      if (!from.free) return;
      double* row = &table[static_cast<std::size_t>(k) * columns];
      if (mutual) row[i] = 0.0;
      std::vector<const Seat*> hidden;
      for (std::size_t j = mutual ? i + 1 : 0; j < columns; ++j) {
        const Seat& to = ends[j];
        if (to.free && sights_->sees(from.at, to.at)) {
          row[j] = distance(from.place, to.place);
        } else if (may_reach(from, to)) {
          hidden.push_back(&to);
        }
      }
      grow(from, Aims(hidden), tree);
      for (const Seat* to : hidden) row[to - ends.data()] = last_piece(*to, tree).length;
    };
  });
  return table;
}

}  // namespace muster
