// [nash2010] (Lazy Theta*); [amanatides1987] (voxels along a line).
#include "paths/voxels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <numbers>

#include "heap.hpp"
#include "infinity.hpp"

namespace muster {

namespace {

constexpr int kBetweenLooks = 1000;
constexpr double kHaste = 1.1;  // of the estimate: the search goes ahead, and turns are pulled straight afterwards
constexpr int kPulls = 6;       // of pulling turns straight

int voxel_of(double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); }

}  // namespace

bool VoxelWays::free(Spot p) const {
  return is_free(voxel_of(p.x, shape_.columns), voxel_of(p.y, shape_.rows), voxel_of(p.z, shape_.layers));
}

bool VoxelWays::sees(Spot a, Spot b) const {
  int at[3] = {voxel_of(a.x, shape_.columns), voxel_of(a.y, shape_.rows), voxel_of(a.z, shape_.layers)};
  const int end[3] = {voxel_of(b.x, shape_.columns), voxel_of(b.y, shape_.rows), voxel_of(b.z, shape_.layers)};
  const double from[3] = {a.x, a.y, a.z}, way[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
  int step[3];
  double next[3], each[3];
  for (int k = 0; k < 3; ++k) {
    step[k] = end[k] > at[k] ? 1 : end[k] < at[k] ? -1 : 0;
    each[k] = step[k] == 0 ? kFar : std::abs(1.0 / way[k]);
    next[k] = step[k] == 0 ? kFar : std::abs((at[k] + (step[k] > 0 ? 1 : 0) - from[k]) / way[k]);
  }
  if (!is_free(at[0], at[1], at[2])) return false;
  while (at[0] != end[0] || at[1] != end[1] || at[2] != end[2]) {
    int axis = -1;
    for (int k = 0; k < 3; ++k) {
      if (at[k] != end[k] && (axis < 0 || next[k] < next[axis])) axis = k;
    }
    at[axis] += step[axis];
    next[axis] += each[axis];
    if (!is_free(at[0], at[1], at[2])) return false;
  }
  return true;
}

bool VoxelWays::steps(int x, int y, int z, int dx, int dy, int dz) const {
  for (int k = dz == 0 ? 1 : 0; k < 2; ++k) {
    for (int j = dy == 0 ? 1 : 0; j < 2; ++j) {
      for (int i = dx == 0 ? 1 : 0; i < 2; ++i) {
        if (!is_free(x + i * dx, y + j * dy, z + k * dz)) return false;
      }
    }
  }
  return true;
}

void VoxelWays::number_parts() {
  parts_.assign(shape_.count(), 0);
  std::vector<std::size_t> open;
  std::int32_t part = 0;
  const std::size_t plane = static_cast<std::size_t>(shape_.rows) * shape_.columns;
  for (std::size_t first = 0; first < parts_.size(); ++first) {
    if (blocked_[first] || parts_[first] != 0) continue;
    parts_[first] = ++part;
    open.push_back(first);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      const int x = static_cast<int>(at % shape_.columns), z = static_cast<int>(at / plane);
      const int y = static_cast<int>(at % plane / shape_.columns);
      const auto visit = [&](int i, int j, int k) {
        if (!is_free(i, j, k)) return;
        std::int32_t& of = parts_[shape_.at(i, j, k)];
        if (of != 0) return;
        of = part;
        open.push_back(shape_.at(i, j, k));
      };
      visit(x - 1, y, z);
      visit(x + 1, y, z);
      visit(x, y - 1, z);
      visit(x, y + 1, z);
      visit(x, y, z - 1);
      visit(x, y, z + 1);
    }
  }
}

// One search. A voxel's place is its centre; those of the ends are where the way begins and ends.
struct VoxelWays::Search {
  struct Found {
    float length;         // from the start, plus 1: 0 is not found yet
    std::int32_t parent;  // plus 1
    bool closed;
  };
  struct Open {
    double key;
    std::int32_t voxel;
  };

  const VoxelWays& ways;
  Spot from, to;
  std::int32_t first, last;
  std::unique_ptr<Found, void (*)(void*)> found;
  Heap<Open> open;
  bool arrived = false;

  Search(const VoxelWays& of, Spot a, Spot b) : ways(of), from(a), to(b), found(nullptr, std::free) {
    const VoxelShape& s = ways.shape_;
    first = number(voxel_of(a.x, s.columns), voxel_of(a.y, s.rows), voxel_of(a.z, s.layers));
    last = number(voxel_of(b.x, s.columns), voxel_of(b.y, s.rows), voxel_of(b.z, s.layers));
    // Zeros that cost nothing where the search does not come by.
    found.reset(static_cast<Found*>(std::calloc(s.count(), sizeof(Found))));
    if (!found) throw std::bad_alloc();
    reach(first, first, 0.0);
  }

  std::int32_t number(int x, int y, int z) const { return static_cast<std::int32_t>(ways.shape_.at(x, y, z)); }
  Found& of(std::int32_t voxel) const { return found.get()[voxel]; }
  void coordinates(std::int32_t voxel, int& x, int& y, int& z) const {
    x = voxel % ways.shape_.columns;
    y = voxel / ways.shape_.columns % ways.shape_.rows;
    z = voxel / ways.shape_.columns / ways.shape_.rows;
  }
  Spot place(std::int32_t voxel) const {
    if (voxel == first) return from;
    if (voxel == last) return to;
    int x, y, z;
    coordinates(voxel, x, y, z);
    return {x + 0.5, y + 0.5, z + 0.5};
  }
  void reach(std::int32_t voxel, std::int32_t parent, double length) {
    Found& one = of(voxel);
    if (one.length != 0.0F && one.length - 1.0F <= static_cast<float>(length)) return;
    one.length = static_cast<float>(length) + 1.0F;
    one.parent = parent + 1;
    open.push({length + kHaste * distance(place(voxel), to), voxel});
  }
  template <class Visit>
  void neighbours(std::int32_t voxel, const Visit& visit) const {
    int x, y, z;
    coordinates(voxel, x, y, z);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if ((dx != 0 || dy != 0 || dz != 0) && ways.steps(x, y, z, dx, dy, dz)) visit(number(x + dx, y + dy, z + dz));
        }
      }
    }
  }
  // The parent was taken on trust; where it does not see the voxel, the best closed neighbour takes its place.
  void settle(std::int32_t voxel) {
    Found& one = of(voxel);
    if (voxel == first || ways.sees(place(one.parent - 1), place(voxel))) return;
    double least = kFar;
    neighbours(voxel, [&](std::int32_t other) {
      if (!of(other).closed) return;
      const double length = of(other).length - 1.0 + distance(place(other), place(voxel));
      if (length >= least) return;
      least = length;
      one.parent = other + 1;
    });
    one.length = static_cast<float>(least) + 1.0F;
  }
  // Take some steps; return whether the search has come to its end, where `arrived` says how.
  bool run(int steps) {
    for (; steps > 0 && !open.empty(); --steps) {
      const std::int32_t voxel = open.pop().voxel;
      if (of(voxel).closed) continue;
      settle(voxel);
      of(voxel).closed = true;
      if (voxel == last) return arrived = true;
      const std::int32_t parent = of(voxel).parent - 1;
      const double before = of(parent).length - 1.0;
      neighbours(voxel, [&](std::int32_t other) {
        if (!of(other).closed) reach(other, parent, before + distance(place(parent), place(other)));
      });
    }
    return open.empty();
  }
  std::vector<Spot> way() const {
    std::vector<Spot> points{to};
    for (std::int32_t voxel = last; voxel != first;) {
      voxel = of(voxel).parent - 1;
      points.push_back(place(voxel));
    }
    std::reverse(points.begin(), points.end());
    return points;
  }
};

std::int32_t VoxelWays::part(Spot p) {
  if (!free(p)) return 0;
  if (parts_.empty()) number_parts();
  return parts_[shape_.at(voxel_of(p.x, shape_.columns), voxel_of(p.y, shape_.rows), voxel_of(p.z, shape_.layers))];
}

std::vector<Spot> VoxelWays::way(Spot from, Spot to, const Pause& pause) {
  if (!free(from) || !free(to)) return {};
  if (sees(from, to)) return {from, to};
  if (part(from) != part(to)) return {};
  // From both ends by turns: one of them may be nearly enclosed, and is easier to leave than to find.
  Search forth(*this, from, to), back(*this, to, from);
  while (!forth.run(kBetweenLooks) && !back.run(kBetweenLooks)) pause();
  if (!forth.arrived && !back.arrived) return {};
  std::vector<Spot> way = forth.arrived ? forth.way() : back.way();
  if (!forth.arrived) std::reverse(way.begin(), way.end());
  pull(way);
  return way;
}

// Leave out turns that are none, and move the others towards the line between their neighbours, as far as is free.
void VoxelWays::pull(std::vector<Spot>& way) const {
  for (int round = 0; round < kPulls; ++round) {
    for (std::size_t k = 1; k + 1 < way.size();) {
      if (sees(way[k - 1], way[k + 1])) {
        way.erase(way.begin() + static_cast<std::ptrdiff_t>(k));
        continue;
      }
      const Spot a = way[k - 1], b = way[k + 1];
      const double span = dot(b - a, b - a);
      const double share = span > 0.0 ? std::clamp(dot(way[k] - a, b - a) / span, 0.0, 1.0) : 0.0;
      const Spot towards = a + share * (b - a) - way[k];
      for (double part = 0.5; part > 0.03; part /= 2) {
        const Spot moved = way[k] + part * towards;
        if (sees(a, moved) && sees(moved, b)) {
          way[k] = moved;
          break;
        }
      }
      ++k;
    }
  }
}

std::vector<std::int64_t> voxels_passed(VoxelShape shape, const SphereScan& scan) {
  const double most =
      *std::max_element(scan.reached, scan.reached + static_cast<std::ptrdiff_t>(scan.rings) * scan.columns);
  const double around = 2 * std::numbers::pi / scan.columns, up = std::numbers::pi / (scan.rings - 1);
  const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x - most))); };
  const auto end = [&](double x, int count) { return std::min(count, static_cast<int>(std::ceil(x + most))); };
  const Spot eye = scan.eye;
  std::vector<double> slopes;  // of the rings: rising
  for (int k = 0; k < scan.rings; ++k) slopes.push_back(std::tan(k * up - std::numbers::pi / 2));
  slopes.front() = -kFar;
  slopes.back() = kFar;
  const int low = first(eye.z), high = end(eye.z, shape.layers);
  std::vector<std::int64_t> passed;
  for (int y = first(eye.y); y < end(eye.y, shape.rows); ++y) {
    for (int x = first(eye.x); x < end(eye.x, shape.columns); ++x) {
      const double east = x + 0.5 - eye.x, north = y + 0.5 - eye.y, flat = std::hypot(east, north);
      if (flat > most) continue;
      const double bearing = (std::atan2(north, east) - scan.heading) / around;
      const auto turn = static_cast<int>(std::floor(bearing));
      const int left = ((turn % scan.columns) + scan.columns) % scan.columns, right = (left + 1) % scan.columns;
      int ring = 0;
      for (int z = low; z < high; ++z) {
        const double above = z + 0.5 - eye.z;
        while (ring + 2 < scan.rings && slopes[ring + 1] * flat <= above) ++ring;
        const double* beams = scan.reached + static_cast<std::ptrdiff_t>(ring) * scan.columns;
        const double* next = beams + scan.columns;
        const double least = std::min(std::min(beams[left], beams[right]), std::min(next[left], next[right])) - 1.0;
        const bool stands_in = std::max({std::abs(east), std::abs(north), std::abs(above)}) <= 0.5;
        if ((least > 0.0 && flat * flat + above * above <= least * least) || stands_in) {
          passed.push_back(static_cast<std::int64_t>(shape.at(x, y, z)));
        }
      }
    }
  }
  return passed;
}

void lower_clearances(VoxelShape shape, float* clearances, const std::vector<Spot>& points, double reach) {
  const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x - reach))); };
  const auto end = [&](double x, int count) { return std::min(count, static_cast<int>(std::ceil(x + reach)) + 1); };
  for (const Spot p : points) {
    for (int z = first(p.z); z < end(p.z, shape.layers); ++z) {
      for (int y = first(p.y); y < end(p.y, shape.rows); ++y) {
        for (int x = first(p.x); x < end(p.x, shape.columns); ++x) {
          const double away = distance(p, {x + 0.5, y + 0.5, z + 0.5});
          float& kept = clearances[shape.at(x, y, z)];
          if (away <= reach && away < kept) kept = static_cast<float>(away);
        }
      }
    }
  }
}

}  // namespace muster
