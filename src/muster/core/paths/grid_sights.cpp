#include "paths/grid_sights.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "paths/grid_search.hpp"

namespace muster {

namespace {

constexpr std::int64_t kUnit = GridMap::kUnit;
constexpr int kNorthEast = GridMap::kNorthEast, kNorthWest = GridMap::kNorthWest;
constexpr int kSouthWest = GridMap::kSouthWest, kSouthEast = GridMap::kSouthEast;

// The four ways along the lines of the grid, each with the two cells that close it where both are blocked.
struct Line {
  int dx, dy, ahead;

  Lattice direction() const { return {dx, dy}; }
};
constexpr std::array<Line, 4> kLines{{{1, 0, kNorthEast | kSouthEast},
                                      {0, 1, kNorthEast | kNorthWest},
                                      {-1, 0, kNorthWest | kSouthWest},
                                      {0, -1, kSouthWest | kSouthEast}}};
constexpr std::size_t kLinesOn = 2;  // the first, which go right and up

bool north(int quarter) { return (quarter & (kNorthEast | kNorthWest)) != 0; }
bool east(int quarter) { return (quarter & (kNorthEast | kSouthEast)) != 0; }
bool rising(int quarter) { return (quarter & (kNorthEast | kSouthWest)) != 0; }

constexpr Lattice kUp{0, 1}, kRight{1, 0};

Point in_cells(Lattice p) { return {static_cast<double>(p.x) / kUnit, static_cast<double>(p.y) / kUnit}; }

}  // namespace

int BitRows::next(int row, int from, int end, std::uint64_t flip) const {
  if (from >= end) return end;
  const std::uint64_t* words = &bits_[static_cast<std::size_t>(row) * words_];
  int at = from / 64;
  std::uint64_t word = (words[at] ^ flip) & (~std::uint64_t{0} << (from % 64));
  while (word == 0) {
    if (++at * 64 >= end) return end;
    word = words[at] ^ flip;
  }
  return std::min(end, at * 64 + std::countr_zero(word));
}

// Directions from the origin: all that lies between `left` and `right` (both in the quadrant, left first as seen from
// the origin) is free up to the lower side of `row`.
struct GridSights::Cone {
  int row;
  Lattice left;
  Lattice right;

  bool empty() const { return cross(right, left) <= 0; }
};

// The rectangle around an ellipse, row by row: no column of it is left out.
class GridSights::Frame {
 public:
  Frame(Point here, Point goal, double length) : everything_(!std::isfinite(length)) {
    const double apart = distance(here, goal);
    middle_ = {(here.x + goal.x) / 2, (here.y + goal.y) / 2};
    if (apart > 0.0) along_ = {(goal.x - here.x) / apart, (goal.y - here.y) / apart};
    half_length_ = length / 2;
    half_width_ = std::sqrt(std::max(0.0, length * length - apart * apart)) / 2;
  }

  // From where to where it reaches in a row of so many columns, in the unit of the lattice.
  std::pair<std::int64_t, std::int64_t> columns(int row, int count) const {
    if (everything_) return {0, count * kUnit};
    double low = -1.0, high = count + 1.0;
    const double below = row - middle_.y;
    narrow(along_.x, along_.y, below, half_length_, low, high);
    narrow(-along_.y, along_.x, below, half_width_, low, high);
    const auto first = static_cast<std::int64_t>(std::floor(low)) - 1, end = static_cast<std::int64_t>(high) + 2;
    return {std::max<std::int64_t>(first, 0) * kUnit, std::min<std::int64_t>(end, count) * kUnit};
  }

 private:
  // To the x for which |u (x - middle) + v y| <= half for some y of the row.
  void narrow(double u, double v, double below, double half, double& low, double& high) const {
    constexpr double kLevel = 1e-6;  // a strip that is as level as that goes on through the whole row
    if (std::abs(u) < kLevel) return;
    const double one = -v * below / u, other = -v * (below + 1.0) / u, wide = half / std::abs(u);
    low = std::max(low, middle_.x + std::min(one, other) - wide);
    high = std::min(high, middle_.x + std::max(one, other) + wide);
  }

  bool everything_;
  Point middle_;
  Point along_{1.0, 0.0};
  double half_length_, half_width_;
};

GridSights::GridSights(const GridMap& map) : map_(map) {
  find_corners();
  for (const bool flips_y : {false, true}) {
    for (const bool flips_x : {false, true}) make_view(views_[2 * flips_y + flips_x], flips_x, flips_y);
  }
}

// A corner is a grid point with one of the four cells around it blocked. Numbers go up tile by tile: corners near each
// other are near in memory.
void GridSights::find_corners() {
  constexpr int kTile = 16;
  numbers_.assign(static_cast<std::size_t>(map_.rows() + 1) * (map_.columns() + 1), -1);
  for (int low = 0; low <= map_.rows(); low += kTile) {
    for (int left = 0; left <= map_.columns(); left += kTile) {
      for (int y = low; y < std::min(low + kTile, map_.rows() + 1); ++y) {
        for (int x = left; x < std::min(left + kTile, map_.columns() + 1); ++x) add_corner(x, y);
      }
    }
  }
}

void GridSights::add_corner(int x, int y) {
  const int mask = map_.around(x, y);
  if (std::popcount(static_cast<unsigned>(mask)) != 1) return;
  numbers_[static_cast<std::size_t>(y) * (map_.columns() + 1) + x] = static_cast<int>(corners_.size());
  corners_.push_back({.at = {x * kUnit, y * kUnit},
                      .place = {static_cast<double>(x), static_cast<double>(y)},
                      .one_wall = {east(mask) ? 1 : -1, 0},
                      .other_wall = {0, north(mask) ? 1 : -1}});
}

void GridSights::make_view(View& view, bool flips_x, bool flips_y) const {
  const int rows = map_.rows(), columns = map_.columns();
  view.flips_x = flips_x;
  view.flips_y = flips_y;
  view.blocked = BitRows(rows, columns);
  view.corners = BitRows(rows + 1, columns + 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (map_.blocked(column, row))
        view.blocked.set(flips_y ? rows - 1 - row : row, flips_x ? columns - 1 - column : column);
    }
  }
  for (const Corner& corner : corners_) {
    const auto x = static_cast<int>(corner.at.x / kUnit), y = static_cast<int>(corner.at.y / kUnit);
    // Seen from the lower left, the block must be at the upper left or at the lower right.
    if (rising(map_.around(x, y)) == (flips_x != flips_y)) {
      view.corners.set(flips_y ? rows - y : y, flips_x ? columns - x : x);
    }
  }
}

Lattice GridSights::placed(const View& view, Lattice p) const {
  return {view.flips_x ? map_.columns() * kUnit - p.x : p.x, view.flips_y ? map_.rows() * kUnit - p.y : p.y};
}

std::vector<int> GridSights::seen_from(Lattice p, const Ellipse& within) const {
  std::vector<int> found;
  for (const View& each : views_) scan(each, p, kUp, kRight, within, found);
  for (std::size_t line = 0; line < kLines.size(); ++line) look_along(line, p, found);
  return found;
}

// Taut directions lie in the two quadrants beside the block, and along the lines. A pair is told from its lower or left
// corner.
std::vector<int> GridSights::neighbours(int corner) const {
  std::vector<int> found;
  const Lattice at = corners_[corner].at;
  const bool block_rises = rising(map_.around(static_cast<int>(at.x / kUnit), static_cast<int>(at.y / kUnit)));
  scan(view(block_rises, false), at, kUp, kRight, {}, found);
  for (std::size_t line = 0; line < kLinesOn; ++line) look_along(line, at, found);
  return found;
}

// One who turns towards the block stays in the quadrant in which he came.
std::vector<int> GridSights::onward(int c, Lattice coming, const Ellipse& within) const {
  std::vector<int> found;
  const Corner& corner = corners_[c];
  const bool block_rises = corner.one_wall.x == corner.other_wall.y;
  const View& ahead = view(block_rises, false).contains(coming) ? view(block_rises, false) : view(!block_rises, true);
  const Lattice straight_on = ahead.turned(coming);
  const bool block_above = ahead.turned(corner.other_wall).y > 0;
  scan(ahead, corner.at, block_above ? kUp : straight_on, block_above ? straight_on : kRight, within, found);
  for (std::size_t line = 0; line < kLines.size(); ++line) {
    if (corner.taut(kLines[line].direction()) && corner.turns(coming, kLines[line].direction()))
      look_along(line, corner.at, found);
  }
  return found;
}

// The shortest way between centres of cells with its string pulled. Among few corners to search those is cheaper.
std::optional<double> GridSights::some_length(Point a, Point b) const {
  constexpr std::size_t kFew = 256;
  if (corners_.size() <= kFew) return std::numeric_limits<double>::infinity();
  const std::vector<int> cells = search_grid(map_, a, b, {});
  if (cells.empty()) return std::nullopt;
  std::vector<Point> way{a};
  double length = 0.0;
  const auto go = [&](Point p) {
    length += distance(way.back(), p);
    way.push_back(p);
  };
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto centre = [&](std::size_t cell) {
      return Point{cells[cell] % map_.columns() + 0.5, cells[cell] / map_.columns() + 0.5};
    };
    const Point next = k + 1 < cells.size() ? centre(k + 1) : b;
    if (!map_.sees(snap(way.back()), snap(next))) go(centre(k));
  }
  go(b);
  return length;
}

// Row after row upwards, cones of free directions are split by the blocked cells that they meet. A cone without width
// is dropped: it touches a corner on each side, and the way goes on from the second.
void GridSights::scan(const View& view, Lattice origin, Lattice left, Lattice right, const Ellipse& within,
                      std::vector<int>& found) const {
  if (cross(right, left) <= 0) return;
  const Lattice from = placed(view, origin);
  const Frame frame(in_cells(from), in_cells(placed(view, snap(within.goal))), within.length);
  std::vector<Cone> open{{static_cast<int>(from.y / kUnit), left, right}};
  while (!open.empty()) {
    const Cone cone = open.back();
    open.pop_back();
    if (cone.row >= map_.rows()) continue;
    const std::size_t before = open.size();
    clip(view, from, cone, frame, open);
    for (std::size_t k = before; k < open.size(); ++k) collect(view, from, open[k], frame, found);
  }
}

// Adds the parts of a cone that get through its row.
void GridSights::clip(const View& view, Lattice origin, const Cone& cone, const Frame& frame,
                      std::vector<Cone>& open) const {
  const std::int64_t low = std::max<std::int64_t>(cone.row * kUnit - origin.y, 0),
                     high = (cone.row + 1) * kUnit - origin.y;
  auto [from, to] = frame.columns(cone.row, map_.columns());
  from = std::max(from, origin.x + floor_of(cone.left.x * low, cone.left.y));
  if (cone.right.y > 0) to = std::min(to, origin.x + ceil_of(cone.right.x * high, cone.right.y));
  if (from >= to) return;
  const auto end = static_cast<int>(ceil_of(to, kUnit));
  Lattice left = cone.left;
  for (int column = static_cast<int>(from / kUnit); column < end;) {
    const int first = view.blocked.next_set(cone.row, column, end);
    if (first == end) break;
    column = view.blocked.next_clear(cone.row, first, end);
    const Lattice near{first * kUnit - origin.x, high}, far{column * kUnit - origin.x, low};
    if (far.x <= 0) continue;
    const Cone part{cone.row + 1, left, cross(cone.right, near) > 0 ? near : cone.right};
    if (near.x > 0 && !part.empty()) open.push_back(part);
    if (cross(far, left) > 0) left = far;
    if (cross(cone.right, left) <= 0) return;
  }
  open.push_back({cone.row + 1, left, cone.right});
}

// The corners on the lower side of a cone's row.
void GridSights::collect(const View& view, Lattice origin, const Cone& cone, const Frame& frame,
                         std::vector<int>& found) const {
  const std::int64_t up = cone.row * kUnit - origin.y;
  auto [from, to] = frame.columns(cone.row - 1, map_.columns());
  // Straight up is the matter of `look_along`.
  from = std::max(from, origin.x + std::max<std::int64_t>(ceil_of(cone.left.x * up, cone.left.y), 1));
  if (cone.right.y > 0) to = std::min(to, origin.x + floor_of(cone.right.x * up, cone.right.y));
  const auto end = static_cast<int>(to / kUnit) + 1;
  const int y = view.flips_y ? map_.rows() - cone.row : cone.row;
  for (int x = static_cast<int>(ceil_of(from, kUnit)); (x = view.corners.next_set(cone.row, x, end)) < end; ++x) {
    found.push_back(number(view.flips_x ? map_.columns() - x : x, y));
  }
}

// Along a line of the grid the way is free where a cell on either side is; the first corner on it is seen.
void GridSights::look_along(std::size_t number_of_line, Lattice origin, std::vector<int>& found) const {
  const Line& line = kLines[number_of_line];
  if ((line.dx != 0 ? origin.y : origin.x) % kUnit != 0) return;
  auto x = static_cast<int>(line.dx < 0 ? ceil_of(origin.x, kUnit) : origin.x / kUnit);
  auto y = static_cast<int>(line.dy < 0 ? ceil_of(origin.y, kUnit) : origin.y / kUnit);
  while ((map_.around(x, y) & line.ahead) != line.ahead) {
    x += line.dx;
    y += line.dy;
    if (number(x, y) >= 0) found.push_back(number(x, y));
    if (number(x, y) >= 0 || map_.pinched(x, y)) return;
  }
}

}  // namespace muster
