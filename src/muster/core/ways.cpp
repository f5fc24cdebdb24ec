#include "ways.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "parallel.hpp"

namespace muster {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Open {
  double f, length;
  int corner;
  friend bool operator<(const Open& a, const Open& b) { return a.f > b.f; }
};

}  // namespace

// The shortest ways from one place to corners.
struct Ways::Tree {
  std::vector<double> length;
  std::vector<int> parent;  // -1: the place itself
  std::priority_queue<Open> open;

  void clear(std::size_t corners) {
    length.assign(corners, kFar);
    parent.assign(corners, -1);
    open = {};
  }
  void reach(int corner, double by, int from, double estimate) {
    if (by >= length[corner]) return;
    length[corner] = by;
    parent[corner] = from;
    open.push({by + estimate, by, corner});
  }
};

void Ways::build(int threads) {
  const auto& corners = sights_->corners();
  const auto count = static_cast<int>(corners.size());
  std::vector<std::vector<int>> seen(corners.size());
  std::vector<std::size_t> on_right(corners.size());
  for_each_parallel(count, threads, [&] {
    return [&](int c) {
      const Corner& corner = corners[c];
      auto others = sights_->neighbours(c);
      const auto direction = [&](int other) { return corners[other].at - corner.at; };
      const auto middle = std::partition(others.begin(), others.end(), [&](int o) { return !corner.on_left(direction(o)); });
      std::sort(others.begin(), middle, [&](int a, int b) { return cross(direction(a), direction(b)) > 0; });
      std::sort(middle, others.end(), [&](int a, int b) { return cross(direction(a), direction(b)) < 0; });
      on_right[c] = static_cast<std::size_t>(middle - others.begin());
      others.shrink_to_fit();
      seen[c] = std::move(others);
    };
  });
  first_.assign(1, 0);
  others_.clear();
  for (std::size_t c = 0; c < seen.size(); ++c) {
    first_.push_back(others_.size() + on_right[c]);
    others_.insert(others_.end(), seen[c].begin(), seen[c].end());
    first_.push_back(others_.size());
    seen[c] = {};
  }
}

Ways::Seat Ways::seat(Point p) const {
  const Lattice at = sights_->snap(p);
  if (!sights_->free(at)) return {at, p, false, {}};
  return {at, p, true, sights_->seen_from(at)};
}

std::vector<Ways::Seat> Ways::seats(const std::vector<Point>& places, int first, int threads) const {
  std::vector<Seat> all(places.size());
  for_each_parallel(static_cast<int>(places.size()) - first, threads, [&] {
    return [&](int k) { all[first + k] = seat(places[first + k]); };
  });
  return all;
}

// Dijkstra over all corners; with a place to go to A*, which ends there.
void Ways::grow(const Seat& from, const Seat* to, Tree& tree) const {
  const auto& corners = sights_->corners();
  const auto estimate = [&](int corner) { return to ? distance(corners[corner].place, to->place) : 0.0; };
  tree.clear(corners.size());
  for (const int corner : from.corners) tree.reach(corner, distance(from.place, corners[corner].place), -1, estimate(corner));
  std::vector<int> ends = to ? to->corners : std::vector<int>{};
  std::sort(ends.begin(), ends.end());
  double best = kFar;
  while (!tree.open.empty() && tree.open.top().f < best) {
    const Open top = tree.open.top();
    tree.open.pop();
    if (top.length > tree.length[top.corner]) continue;
    if (std::binary_search(ends.begin(), ends.end(), top.corner)) best = std::min(best, top.f);
    expand(top.corner, from, to, tree);
  }
}

// One who comes to a corner leaves it on the same side of the obstacle, and turns towards it.
void Ways::expand(int c, const Seat& from, const Seat* to, Tree& tree) const {
  const auto& corners = sights_->corners();
  const Corner& corner = corners[c];
  const int parent = tree.parent[c];
  const Lattice coming = corner.at - (parent < 0 ? from.at : corners[parent].at);
  const bool left = corner.on_left(coming);
  const auto turns_away = [&](Lattice leaving) {
    return left ? cross(coming, leaving) < 0 : cross(coming, leaving) > 0;
  };
  const auto reach = [&](int other) {
    const Point place = corners[other].place;
    tree.reach(other, tree.length[c] + distance(corner.place, place), c, to ? distance(place, to->place) : 0.0);
  };
  if (!built()) {
    for (const int other : sights_->neighbours(c)) {
      const Lattice leaving = corners[other].at - corner.at;
      if (corner.on_left(leaving) == left && !turns_away(leaving)) reach(other);
    }
    return;
  }
  const std::size_t side = 2 * static_cast<std::size_t>(c) + left;
  for (std::size_t k = first_[side]; k < first_[side + 1]; ++k) {
    if (turns_away(corners[others_[k]].at - corner.at)) break;
    reach(others_[k]);
  }
}

Ways::Last Ways::last_piece(const Seat& from, const Seat& to, const Tree& tree) const {
  if (!from.free || !to.free) return {kFar, -1};
  Last best{sights_->sees(from.at, to.at) ? distance(from.place, to.place) : kFar, -1};
  for (const int corner : to.corners) {
    const double whole = tree.length[corner] + distance(sights_->corners()[corner].place, to.place);
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
  for (int corner = last.corner; corner >= 0; corner = tree.parent[corner]) {
    way.push_back(sights_->corners()[corner].place);
  }
  way.push_back(a);
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<double> Ways::lengths(const std::vector<Point>& exits, const std::vector<Point>& entries, bool mutual,
                                  int first, int last, int threads) const {
  const std::vector<Seat> ends = seats(entries, mutual ? first : 0, threads);
  const std::size_t columns = entries.size();
  std::vector<double> table(static_cast<std::size_t>(last - first) * columns, kFar);
  for_each_parallel(last - first, threads, [&] {
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
