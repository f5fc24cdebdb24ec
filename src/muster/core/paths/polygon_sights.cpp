// The visibility graph of [lozano1979], of which only taut pieces are kept.
#include "paths/polygon_sights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace muster {

namespace {

constexpr std::int64_t kSize = std::int64_t{1} << 29;

// Whether a direction from a point of the border leads along it or inside, which is left of the ring.
bool leads_inside(Lattice before, Lattice at, Lattice next, Lattice direction) {
  const Lattice back = before - at, on = next - at;
  const bool convex = cross(on, back) > 0;
  const bool right_of_on = cross(on, direction) < 0, left_of_back = cross(back, direction) > 0;
  if (convex) return !right_of_on && !left_of_back;
  if (cross(on, back) == 0) return !right_of_on;
  return !(right_of_on && left_of_back);
}

bool strictly_between(Lattice p, Lattice a, Lattice b) { return dot(a - p, b - p) < 0; }

int sign(std::int64_t value) { return (value > 0) - (value < 0); }

}  // namespace

PolygonSights::PolygonSights(const std::vector<std::vector<Point>>& rings) {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-low.x, -low.y};
  for (const auto& ring : rings) {
    for (const Point p : ring) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  if (!(high.x > low.x) || !(high.y > low.y)) throw std::invalid_argument("the region is empty");
  origin_ = {std::floor(low.x), std::floor(low.y)};
  const double size = std::max(high.x - origin_.x, high.y - origin_.y);
  scale_ = std::exp2(std::floor(std::log2(static_cast<double>(kSize) / size)));
  for (const auto& ring : rings) add_ring(ring);
  sort_into_boxes();
}

Lattice PolygonSights::rounded(Point p) const {
  // What is far outside is outside; so no coordinate leaves the range in which all is exact.
  const auto near = [](double value) {
    return std::llround(std::clamp(value, -1.0, static_cast<double>(kSize) + 1.0));
  };
  return {near((p.x - origin_.x) * scale_), near((p.y - origin_.y) * scale_)};
}

double PolygonSights::extent() const { return std::sqrt(2.0) * static_cast<double>(kSize) / scale_; }

// On a slanting side there is seldom a point of the lattice: the nearest beside it on the free side is as good.
Lattice PolygonSights::snap(Point p) const {
  constexpr std::int64_t kRounding = 2;
  const Lattice at = rounded(p);
  if (free(at)) return at;
  Lattice best;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::int64_t dx = -kRounding; dx <= kRounding; ++dx) {
    for (std::int64_t dy = -kRounding; dy <= kRounding; ++dy) {
      const Lattice step{dx, dy};
      if (dot(step, step) >= least || !free(at + step)) continue;
      best = step;
      least = dot(step, step);
    }
  }
  return at + best;
}

void PolygonSights::add_ring(const std::vector<Point>& ring) {
  std::vector<Point> places;
  for (const Point p : ring) {
    if (places.empty() || !(rounded(p) == rounded(places.back()))) places.push_back(p);
  }
  while (places.size() > 1 && rounded(places.front()) == rounded(places.back())) places.pop_back();
  const std::size_t count = places.size();
  if (count < 3) return;
  for (std::size_t k = 0; k < count; ++k) {
    const Lattice before = rounded(places[(k + count - 1) % count]), at = rounded(places[k]),
                  next = rounded(places[(k + 1) % count]);
    sides_.push_back({before, at, next});
    if (turn(before, at, next) < 0) corners_.push_back({at, places[k], before - at, next - at});
  }
}

void PolygonSights::sort_into_boxes() {
  boxes_ = std::clamp(static_cast<int>(std::sqrt(2.0 * static_cast<double>(sides_.size()))), 1, 1024);
  box_size_ = kSize / boxes_ + 1;
  std::vector<std::vector<int>> in(static_cast<std::size_t>(boxes_) * boxes_);
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    for_boxes(sides_[s].at, sides_[s].next, [&](int box) {
      in[box].push_back(static_cast<int>(s));
      return true;
    });
  }
  box_first_.assign(1, 0);
  for (const auto& some : in) {
    box_sides_.insert(box_sides_.end(), some.begin(), some.end());
    box_first_.push_back(static_cast<int>(box_sides_.size()));
  }
}

// Visits, row by row, every box that a straight piece meets, and some beside it; until a visit returns false.
template <class Visit>
bool PolygonSights::for_boxes(Lattice a, Lattice b, Visit visit) const {
  if (a.y > b.y) std::swap(a, b);
  const auto box = [&](std::int64_t value) {
    return static_cast<int>(std::clamp<std::int64_t>(value / box_size_, 0, boxes_ - 1));
  };
  const Lattice d = b - a;
  for (int row = box(a.y - 1); row <= box(b.y + 1); ++row) {
    const std::int64_t low = std::clamp<std::int64_t>(row * box_size_, a.y, b.y);
    const std::int64_t high = std::clamp<std::int64_t>((row + 1) * box_size_, a.y, b.y);
    const std::int64_t enters = d.y == 0 ? a.x : a.x + d.x * (low - a.y) / d.y;
    const std::int64_t leaves = d.y == 0 ? b.x : a.x + d.x * (high - a.y) / d.y;
    const int first = box(std::min(enters, leaves) - 2), last = box(std::max(enters, leaves) + 2);
    for (int column = first; column <= last; ++column) {
      if (!visit(row * boxes_ + column)) return false;
    }
  }
  return true;
}

// Inside by the count of sides to the right; on a side is free.
bool PolygonSights::free(Lattice p) const {
  bool inside = false;
  for (const Side& side : sides_) {
    const std::int64_t where = turn(side.at, side.next, p);
    if (where == 0 && dot(side.at - p, side.next - p) <= 0) return true;
    if ((side.at.y > p.y) != (side.next.y > p.y) && (where > 0) == (side.next.y > side.at.y)) inside = !inside;
  }
  return inside;
}

bool PolygonSights::sees(Lattice a, Lattice b) const {
  if (a == b) return true;
  return for_boxes(a, b, [&](int box) {
    for (int k = box_first_[box]; k < box_first_[box + 1]; ++k) {
      if (!passes(sides_[box_sides_[k]], a, b)) return false;
    }
    return true;
  });
}

// A straight piece from the inside stays there unless it crosses a side, or touches the border and goes on outside.
bool PolygonSights::passes(const Side& side, Lattice a, Lattice b) const {
  const int at = sign(turn(a, b, side.at)), next = sign(turn(a, b, side.next));
  if (at * next > 0) return true;
  const int from = sign(turn(side.at, side.next, a)), to = sign(turn(side.at, side.next, b));
  if (at * next < 0 && from * to < 0) return false;
  if (from == 0 && strictly_between(a, side.at, side.next) && to < 0) return false;
  if (to == 0 && strictly_between(b, side.at, side.next) && from < 0) return false;
  if (at != 0) return true;
  const bool between = strictly_between(side.at, a, b);
  const auto inside = [&](Lattice towards) { return leads_inside(side.before, side.at, side.next, towards - side.at); };
  if ((between || side.at == a) && !inside(b)) return false;
  return !((between || side.at == b) && !inside(a));
}

std::vector<int> PolygonSights::seen_from(Lattice p, const Ellipse& within) const {
  std::vector<int> found;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const Lattice towards = corners_[c].at - p;
    if (towards == Lattice{} || !corners_[c].taut(towards) || !within.holds(corners_[c].place)) continue;
    if (sees(p, corners_[c].at)) found.push_back(static_cast<int>(c));
  }
  return found;
}

std::vector<int> PolygonSights::neighbours(int corner) const {
  const Corner& here = corners_[corner];
  std::vector<int> found;
  for (std::size_t c = static_cast<std::size_t>(corner) + 1; c < corners_.size(); ++c) {
    const Lattice towards = corners_[c].at - here.at;
    if (towards == Lattice{} || !here.taut(towards) || !corners_[c].taut(towards)) continue;
    if (sees(here.at, corners_[c].at)) found.push_back(static_cast<int>(c));
  }
  return found;
}

std::vector<int> PolygonSights::onward(int corner, Lattice coming, const Ellipse& within) const {
  const Corner& here = corners_[corner];
  std::vector<int> found;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const Lattice leaving = corners_[c].at - here.at;
    if (leaving == Lattice{} || !here.taut(leaving) || !corners_[c].taut(leaving)) continue;
    if (here.turns(coming, leaving) && within.holds(corners_[c].place)) found.push_back(static_cast<int>(c));
  }
  return found;
}

}  // namespace muster
