#include "grid_sights.hpp"

#include <algorithm>
#include <bit>
#include <span>

namespace muster {

namespace {

constexpr std::int64_t kUnit = GridMap::kUnit;
constexpr int kNorthEast = GridMap::kNorthEast, kNorthWest = GridMap::kNorthWest;
constexpr int kSouthWest = GridMap::kSouthWest, kSouthEast = GridMap::kSouthEast;

// The four ways along the lines of the grid, each with the two cells that close it where both are blocked.
struct Line {
  int dx, dy, ahead;
};
constexpr std::array<Line, 4> kLines{{{1, 0, kNorthEast | kSouthEast},
                                      {0, 1, kNorthEast | kNorthWest},
                                      {-1, 0, kNorthWest | kSouthWest},
                                      {0, -1, kSouthWest | kSouthEast}}};
constexpr std::size_t kLinesOn = 2;  // the first, which go right and up

bool north(int quarter) { return (quarter & (kNorthEast | kNorthWest)) != 0; }
bool east(int quarter) { return (quarter & (kNorthEast | kSouthEast)) != 0; }
bool rising(int quarter) { return (quarter & (kNorthEast | kSouthWest)) != 0; }

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

std::vector<int> GridSights::seen_from(Lattice p) const {
  std::vector<int> found;
  for (const View& each : views_) scan(each, p, found);
  look_along_lines(p, kLines.size(), found);
  return found;
}

// Taut directions lie in the two quadrants beside the block, and along the lines. A pair is told once from its lower
// or left corner.
std::vector<int> GridSights::neighbours(int corner, Pairs pairs) const {
  std::vector<int> found;
  const Lattice at = corners_[corner].at;
  const bool block_rises = rising(map_.around(static_cast<int>(at.x / kUnit), static_cast<int>(at.y / kUnit)));
  scan(view(block_rises, false), at, found);
  if (pairs == Pairs::kTwice) scan(view(!block_rises, true), at, found);
  look_along_lines(at, pairs == Pairs::kTwice ? kLines.size() : kLinesOn, found);
  return found;
}

// Row after row upwards, cones of free directions are split by the blocked cells that they meet. A cone without width
// is dropped: it touches a corner on each side, and the way goes on from the second.
void GridSights::scan(const View& view, Lattice origin, std::vector<int>& found) const {
  const Lattice from{view.flips_x ? map_.columns() * kUnit - origin.x : origin.x,
                     view.flips_y ? map_.rows() * kUnit - origin.y : origin.y};
  std::vector<Cone> open{{static_cast<int>(from.y / kUnit), {0, 1}, {1, 0}}};
  while (!open.empty()) {
    const Cone cone = open.back();
    open.pop_back();
    if (cone.row >= map_.rows()) continue;
    const std::size_t before = open.size();
    clip(view, from, cone, open);
    for (std::size_t k = before; k < open.size(); ++k) collect(view, from, open[k], found);
  }
}

// Adds the parts of a cone that get through its row.
void GridSights::clip(const View& view, Lattice origin, const Cone& cone, std::vector<Cone>& open) const {
  const std::int64_t low = std::max<std::int64_t>(cone.row * kUnit - origin.y, 0),
                     high = (cone.row + 1) * kUnit - origin.y;
  const std::int64_t from = origin.x + floor_of(cone.left.x * low, cone.left.y);
  std::int64_t to = map_.columns() * kUnit;
  if (from >= to) return;
  if (cone.right.y > 0) to = std::min(to, origin.x + ceil_of(cone.right.x * high, cone.right.y));
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
void GridSights::collect(const View& view, Lattice origin, const Cone& cone, std::vector<int>& found) const {
  const std::int64_t up = cone.row * kUnit - origin.y;
  // Straight up is the matter of `look_along_lines`.
  const std::int64_t from = origin.x + std::max<std::int64_t>(ceil_of(cone.left.x * up, cone.left.y), 1);
  std::int64_t to = map_.columns() * kUnit;
  if (cone.right.y > 0) to = std::min(to, origin.x + floor_of(cone.right.x * up, cone.right.y));
  const auto end = static_cast<int>(to / kUnit) + 1;
  const int y = view.flips_y ? map_.rows() - cone.row : cone.row;
  for (int x = static_cast<int>(ceil_of(from, kUnit)); (x = view.corners.next_set(cone.row, x, end)) < end; ++x) {
    found.push_back(number(view.flips_x ? map_.columns() - x : x, y));
  }
}

// Along a line of the grid the way is free where a cell on either side is; the first corner on it is seen.
void GridSights::look_along_lines(Lattice origin, std::size_t lines, std::vector<int>& found) const {
  for (const Line& line : std::span(kLines).first(lines)) {
    if ((line.dx != 0 ? origin.y : origin.x) % kUnit != 0) continue;
    auto x = static_cast<int>(line.dx < 0 ? ceil_of(origin.x, kUnit) : origin.x / kUnit);
    auto y = static_cast<int>(line.dy < 0 ? ceil_of(origin.y, kUnit) : origin.y / kUnit);
    while ((map_.around(x, y) & line.ahead) != line.ahead) {
      x += line.dx;
      y += line.dy;
      if (number(x, y) >= 0) found.push_back(number(x, y));
      if (number(x, y) >= 0 || map_.pinched(x, y)) break;
    }
  }
}

}  // namespace muster
