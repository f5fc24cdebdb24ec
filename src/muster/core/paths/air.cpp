#include "paths/air.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace muster {

namespace {

Point minus(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point along(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
Point flat(Spot p) { return {p.x, p.y}; }

double distance_to_side(Point p, Point a, Point b) {
  const Point d = minus(b, a);
  const double square = dot(d, d), t = square > 0.0 ? std::clamp(dot(minus(p, a), d) / square, 0.0, 1.0) : 0.0;
  return distance(p, along(a, b, t));
}

// A ring that does not cut itself is convex then.
bool turns_left_only(const std::vector<Point>& ring) {
  const std::size_t count = ring.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Point at = ring[(k + 1) % count];
    if (cross(minus(at, ring[k]), minus(ring[(k + 2) % count], at)) < 0.0) return false;
  }
  return true;
}

template <class Visit>
void for_sides(const std::vector<std::vector<Point>>& rings, Visit visit) {
  for (const auto& ring : rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) visit(ring[k], ring[(k + 1) % ring.size()]);
  }
}

}  // namespace

Rings::Rings(std::vector<std::vector<Point>> rings) : rings_(std::move(rings)) {
  constexpr double far = std::numeric_limits<double>::infinity();
  low_ = {far, far};
  high_ = {-far, -far};
  for_sides(rings_, [&](Point p, Point) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  });
  convex_ = rings_.size() == 1 && turns_left_only(rings_.front());
  if (!convex_) return;
  for_sides(rings_, [&](Point p, Point q) {
    const double length = muster::distance(p, q);
    if (length == 0.0) return;
    const Point inward{-(q.y - p.y) / length, (q.x - p.x) / length};
    sides_.push_back({inward, dot(inward, p)});
  });
}

bool Rings::inside(Point p) const {
  bool in = false;
  for_sides(rings_, [&](Point a, Point b) {
    if ((a.y > p.y) != (b.y > p.y) && (cross(minus(b, a), minus(p, a)) > 0.0) == (b.y > a.y)) in = !in;
  });
  return in;
}

double Rings::distance_to_border(Point p) const {
  double least = std::numeric_limits<double>::infinity();
  for_sides(rings_, [&](Point a, Point b) { least = std::min(least, distance_to_side(p, a, b)); });
  return least;
}

// Whether the line through a in this direction runs beside the box around all, and no nearer than `off` lengths.
bool Rings::beside(Point a, Point d, double off) const {
  const double middle = cross(d, minus({(low_.x + high_.x) / 2, (low_.y + high_.y) / 2}, a));
  const double half = (std::abs(d.x) * (high_.y - low_.y) + std::abs(d.y) * (high_.x - low_.x)) / 2;
  return std::abs(middle) > half + off;
}

// What of the piece is deeper than kTouch in a convex whole: it is clipped at each side.
bool Rings::enters_convex(Point a, Point b, double from, double to) const {
  const Point d = minus(b, a);
  const double least = Air::kTouch / std::max(std::sqrt(dot(d, d)), Air::kTouch);
  for (const Side& side : sides_) {
    const double depth = dot(side.inward, a) - side.offset - Air::kTouch, rate = dot(side.inward, d);
    if (rate > 0.0) {
      from = std::max(from, -depth / rate);
    } else if (rate < 0.0) {
      to = std::min(to, -depth / rate);
    } else if (depth < 0.0) {
      return false;
    }
    if (to - from <= least) return false;
  }
  return true;
}

// The border cuts the piece; the middle of each part says where the part is.
bool Rings::enters(Point a, Point b, double from, double to, bool inner) const {
  const Point first = along(a, b, from), last = along(a, b, to), d = minus(b, a);
  if (inner && (std::max(first.x, last.x) < low_.x || std::min(first.x, last.x) > high_.x ||
                std::max(first.y, last.y) < low_.y || std::min(first.y, last.y) > high_.y)) {
    return false;
  }
  const double length = std::sqrt(dot(d, d));
  if (inner && beside(a, d, Air::kTouch * length)) return false;
  if (inner && convex_ && length * (to - from) > Air::kTouch) return enters_convex(a, b, from, to);
  // What joins two points of a convex whole is in it.
  const auto in = [&](Point p) { return inside(p) || distance_to_border(p) <= Air::kTouch; };
  if (!inner && convex_ && in(first) && in(last)) return false;
  const auto is_there = [&](Point p) { return inside(p) == inner && distance_to_border(p) > Air::kTouch; };
  if (length * (to - from) <= Air::kTouch) return is_there(along(a, b, (from + to) / 2));
  std::vector<double> cuts{from, to};
  const auto cut = [&](double t) {
    if (t > from && t < to) cuts.push_back(t);
  };
  for_sides(rings_, [&](Point p, Point q) {
    const double at = cross(d, minus(p, a)), next = cross(d, minus(q, a));
    const double near = Air::kTouch * length;
    if ((at > near && next > near) || (at < -near && next < -near)) return;
    if (std::abs(at) <= near) cut(dot(minus(p, a), d) / (length * length));
    if (std::abs(next) <= near) cut(dot(minus(q, a), d) / (length * length));
    if (at * next < 0.0) cut(dot(minus(along(p, q, at / (at - next)), a), d) / (length * length));
  });
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    if ((cuts[k] - cuts[k - 1]) * length > Air::kTouch && is_there(along(a, b, (cuts[k] + cuts[k - 1]) / 2)))
      return true;
  }
  return false;
}

bool AirEdge::taut(Spot direction) const {
  if (upright) {
    const double one = cross(flat(direction), inward), other = cross(flat(direction), other_wall);
    return one * other >= -1e-12;
  }
  const double in = dot(flat(direction), inward), out = top ? direction.z : -direction.z;
  return in * out >= -1e-12;
}

namespace {

// Rings have the inside of their polygon on the left, so an obstacle inside is convex at a turn to the left.
void add_upright(const std::vector<Point>& ring, double from, double to, bool obstacle_inside,
                 std::vector<AirEdge>& edges) {
  const std::size_t count = ring.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Point at = ring[k], back = minus(ring[(k + count - 1) % count], at), on = minus(ring[(k + 1) % count], at);
    const double turn = cross(on, back);
    if (obstacle_inside ? turn <= 0.0 : turn >= 0.0) continue;
    edges.push_back(
        {.from = {at.x, at.y, from}, .to = {at.x, at.y, to}, .upright = true, .inward = back, .other_wall = on});
  }
}

void add_level(const std::vector<Point>& ring, double z, bool top, std::vector<AirEdge>& edges) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point a = ring[k], b = ring[(k + 1) % ring.size()];
    const double length = distance(a, b);
    if (length == 0.0) continue;
    const Point inward{-(b.y - a.y) / length, (b.x - a.x) / length};
    edges.push_back({.from = {a.x, a.y, z}, .to = {b.x, b.y, z}, .top = top, .inward = inward, .other_wall = {}});
  }
}

// The edges of a prism over one ring, above `lowest`.
void add_prism(const std::vector<Point>& ring, const PrismShape& prism, double lowest, double top,
               std::vector<AirEdge>& edges) {
  const double from = std::max(prism.floor, lowest);
  if (prism.ceiling <= from) return;
  add_upright(ring, from, std::isfinite(prism.ceiling) ? prism.ceiling : std::max(top, from), true, edges);
  if (std::isfinite(prism.ceiling)) add_level(ring, prism.ceiling, true, edges);
  if (prism.floor > lowest) add_level(ring, prism.floor, false, edges);
}

Point where_lines_meet(Point a, Point along_a, Point b, Point along_b) {
  return along(a, {a.x + along_a.x, a.y + along_a.y}, cross(minus(b, a), along_b) / cross(along_a, along_b));
}

// Whether a triangle and a box are on different sides of a plane across this axis.
bool lie_apart(const std::array<Spot, 3>& triangle, Spot low, Spot high, Spot axis, double slack) {
  const double middle = dot(axis, 0.5 * (low + high)),
               half = dot({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}, 0.5 * (high - low));
  const double one = dot(axis, triangle[0]), two = dot(axis, triangle[1]), three = dot(axis, triangle[2]);
  const double near = half + slack * std::sqrt(dot(axis, axis)) + Air::kTouch;
  return std::min({one, two, three}) > middle + near || std::max({one, two, three}) < middle - near;
}

}  // namespace

Air::Air(Rings region, std::vector<PrismShape> prisms, double lowest, double top)
    : region_(std::move(region)), prisms_(std::move(prisms)), lowest_(lowest), top_(top), first_edge_{0} {
  for (const auto& ring : region_.rings()) add_upright(ring, lowest, std::max(top, lowest), false, edges_);
  for (PrismShape& prism : prisms_) {
    if (prism.floor <= lowest) prism.floor = -std::numeric_limits<double>::infinity();  // nothing passes below
    boxes_.push_back({prism.base.low(), prism.base.high(), prism.floor, prism.ceiling});
    first_edge_.push_back(edges_.size());
    for (const auto& ring : prism.base.rings()) add_prism(ring, prism, lowest, top, edges_);
  }
  first_edge_.push_back(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const Spot end : {edges_[e].from, edges_[e].to}) ends_.push_back({{end.x, end.y, end.z}, static_cast<int>(e)});
  }
  std::sort(ends_.begin(), ends_.end());
}

std::vector<int> Air::edges_at(Spot p, int edge) const {
  std::vector<int> found{edge};
  for (const Spot end : {edges_[edge].from, edges_[edge].to}) {
    if (distance(end, p) > kTouch) continue;
    const std::array<double, 3> key{end.x, end.y, end.z};
    for (auto at = std::lower_bound(ends_.begin(), ends_.end(), std::pair{key, -1});
         at != ends_.end() && at->first == key; ++at) {
      found.push_back(at->second);
    }
  }
  return found;
}

std::vector<AirEdge> Air::loose_edges(double off) const {
  std::vector<AirEdge> edges(edges_.begin(), edges_.begin() + static_cast<std::ptrdiff_t>(first_edge_[1]));
  for (const PrismShape& prism : prisms_) {
    for (const auto& ring : prism.base.rings()) add_prism(loosened(ring, prism, off), prism, lowest_, top_, edges);
  }
  return edges;
}

// Whether a point is free at all heights of a prism, but for the prism itself.
bool Air::clear(Point p, const PrismShape& but) const {
  if (!region_.inside(p)) return false;
  return std::none_of(prisms_.begin(), prisms_.end(), [&](const PrismShape& prism) {
    return &prism != &but && prism.floor < but.ceiling && prism.ceiling > but.floor &&
           (prism.base.inside(p) || prism.base.distance_to_border(p) <= kTouch);
  });
}

// Of the sides that turn to the left, one after the other, some are left out, and those beside them made longer until
// they meet: outside, for the ring is convex there.
std::vector<Point> Air::loosened(const std::vector<Point>& ring, const PrismShape& prism, double off) const {
  constexpr double kSteepest = 0.8;  // a little over 45 degrees
  const std::size_t count = ring.size();
  const auto at = [&](std::size_t k) { return ring[k % count]; };
  const auto side = [&](std::size_t k) { return minus(at(k + 1), at(k)); };  // from ring[k] to ring[k + 1]
  const auto angle = [](Point a, Point b) { return std::atan2(cross(a, b), dot(a, b)); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < count; ++k) {
    if (dot(side(k), side(k)) > dot(side(longest), side(longest))) longest = k;
  }
  std::vector<Point> loose;
  for (std::size_t here = longest; here < longest + count;) {
    // The side after which ones are left out, up to `next`, and the point where the two meet.
    std::size_t next = here + 1;
    Point corner = at(next);
    double turned = angle(side(here), side(next));
    for (std::size_t k = next + 1; k <= longest + count && turned > 0.0; ++k) {
      const double more = angle(side(k - 1), side(k));
      turned += more;
      if (more <= 0.0 || turned > kSteepest) break;
      const Point meet = where_lines_meet(at(here), side(here), at(k), side(k));
      double away = distance(meet, at(here + 1));
      for (std::size_t j = here + 2; j <= k; ++j) away = std::min(away, distance(meet, at(j)));
      if (away > off) break;
      // Beside something else the true corners stay, if any of them is to be seen.
      bool stays = clear(meet, prism);
      for (std::size_t j = here + 1; j <= k && !stays; ++j) stays = clear(at(j), prism);
      if (!clear(meet, prism) && stays) break;
      next = k;
      corner = meet;
    }
    loose.push_back(corner);
    here = next;
  }
  return loose;
}

// In the plane of the triangle: `s` along a-b, `h` across. What comes from the obstacles has its corners where edges
// pierce the triangle, so the way around them is the hull of these.
std::vector<std::pair<Spot, int>> Air::tight_turns(Spot a, Spot corner, Spot b) const {
  struct Turn {
    double s, h;
    Spot at;
    int edge;
  };
  constexpr double kNear = 1e-9;
  const Spot base = b - a, side = corner - a;
  const double length = std::sqrt(dot(base, base));
  const Spot along_base = (1.0 / length) * base, up = side - dot(side, along_base) * along_base;
  const double height = std::sqrt(dot(up, up));
  if (!(length > 0.0) || height <= kTouch) return {};
  const Spot across = (1.0 / height) * up;
  const Spot normal{along_base.y * across.z - along_base.z * across.y,
                    along_base.z * across.x - along_base.x * across.z,
                    along_base.x * across.y - along_base.y * across.x};
  const double top_at = dot(side, along_base), slack = kNear * (length + height);
  std::vector<Turn> turns;
  const auto pierce = [&](std::size_t e) {
    const AirEdge& edge = edges_[e];
    const double from = dot(edge.from - a, normal), to = dot(edge.to - a, normal);
    if (from * to > 0.0 && std::min(std::abs(from), std::abs(to)) > slack) return;
    if (std::abs(from - to) <= slack) return;
    const double t = std::clamp(from / (from - to), 0.0, 1.0);
    const Spot at = edge.from + t * (edge.to - edge.from);
    const double s = dot(at - a, along_base), h = dot(at - a, across);
    // Under both sides of the triangle.
    if (h <= slack || h * top_at > height * s + slack * length) return;
    if (h * (length - top_at) > height * (length - s) + slack * length) return;
    turns.push_back({s, h, at, static_cast<int>(e)});
  };
  for (std::size_t e = 0; e < first_edge_[1]; ++e) pierce(e);
  const double highest = std::max({a.z, b.z, corner.z, top_});
  const std::array<Spot, 3> triangle{a, corner, b};
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    const Spot low{boxes_[k].low.x, boxes_[k].low.y, std::max(boxes_[k].floor, lowest_)};
    const Spot high{boxes_[k].high.x, boxes_[k].high.y, std::min(boxes_[k].ceiling, highest)};
    const auto apart = [&](Spot axis) { return lie_apart(triangle, low, high, axis, slack); };
    if (apart({1, 0, 0}) || apart({0, 1, 0}) || apart({0, 0, 1}) || apart(normal) || apart({base.y, -base.x, 0}))
      continue;
    for (std::size_t e = first_edge_[k + 1]; e < first_edge_[k + 2]; ++e) pierce(e);
  }
  // From a on, all that is left lies to the right of the way to the next.
  turns.push_back({length, 0.0, b, -1});
  std::vector<std::pair<Spot, int>> found;
  Turn here{0.0, 0.0, a, -1};
  while (found.size() < turns.size()) {
    const Turn* next = &turns.back();
    for (const Turn& turn : turns) {
      const double s = turn.s - here.s, h = turn.h - here.h, next_s = next->s - here.s, next_h = next->h - here.h;
      const double left = next_s * h - next_h * s, further = (s * s + h * h) - (next_s * next_s + next_h * next_h);
      if (std::hypot(s, h) > slack && (left > 0.0 || (left == 0.0 && further > 0.0))) next = &turn;
    }
    if (next->edge < 0) return found;
    found.emplace_back(next->at, next->edge);
    here = *next;
  }
  return found;
}

bool Air::free(Spot p) const {
  if (p.z < lowest_ - kTouch) return false;
  if (!region_.inside(flat(p)) && region_.distance_to_border(flat(p)) > kTouch) return false;
  return std::none_of(prisms_.begin(), prisms_.end(), [&](const PrismShape& prism) {
    return p.z > prism.floor + kTouch && p.z < prism.ceiling - kTouch && prism.base.inside(flat(p)) &&
           prism.base.distance_to_border(flat(p)) > kTouch;
  });
}

// Whether the box around the piece meets this one, and the line does from above.
bool Air::Box::may_block(Spot a, Spot b) const {
  if (std::min(a.x, b.x) > high.x || std::max(a.x, b.x) < low.x || std::min(a.y, b.y) > high.y ||
      std::max(a.y, b.y) < low.y || std::min(a.z, b.z) > ceiling || std::max(a.z, b.z) < floor) {
    return false;
  }
  const double x = b.x - a.x, y = b.y - a.y;
  const double middle = x * ((low.y + high.y) - 2 * a.y) - y * ((low.x + high.x) - 2 * a.x);
  return std::abs(middle) <= std::abs(x) * (high.y - low.y) + std::abs(y) * (high.x - low.x);
}

bool Air::sees(Spot a, Spot b, std::size_t& blocker) const {
  if (std::min(a.z, b.z) < lowest_ - kTouch) return false;
  if (blocker < prisms_.size() && blocks(prisms_[blocker], a, b)) return false;
  if (region_.enters(flat(a), flat(b), 0.0, 1.0, false)) return false;
  for (std::size_t k = 0; k < prisms_.size(); ++k) {
    if (k == blocker || !boxes_[k].may_block(a, b) || !blocks(prisms_[k], a, b)) continue;
    blocker = k;
    return false;
  }
  return true;
}

bool Air::blocks(const PrismShape& prism, Spot a, Spot b) {
  // The part of the piece at the height of the prism.
  double from = 0.0, to = 1.0;
  const double low = prism.floor + kTouch, high = prism.ceiling - kTouch, rise = b.z - a.z;
  if (std::max(a.z, b.z) <= low || std::min(a.z, b.z) >= high) return false;
  if (rise != 0.0) {
    from = std::max(from, ((rise > 0.0 ? low : high) - a.z) / rise);
    to = std::min(to, ((rise > 0.0 ? high : low) - a.z) / rise);
  }
  return from < to && prism.base.enters(flat(a), flat(b), from, to, true);
}

}  // namespace muster
