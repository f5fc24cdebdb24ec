// Points of the plane in whole numbers, so that which side of a line a point is on is decided exactly.
#pragma once

#include <cmath>
#include <cstdint>

namespace muster {

// A point or a direction. Coordinates stay below 2^30 in size, so that no cross product leaves 64 bits.
struct Lattice {
  std::int64_t x = 0;
  std::int64_t y = 0;

  friend Lattice operator+(Lattice a, Lattice b) { return {a.x + b.x, a.y + b.y}; }
  friend Lattice operator-(Lattice a, Lattice b) { return {a.x - b.x, a.y - b.y}; }
  friend bool operator==(Lattice a, Lattice b) { return a.x == b.x && a.y == b.y; }
};

inline std::int64_t cross(Lattice a, Lattice b) { return a.x * b.y - a.y * b.x; }
inline std::int64_t dot(Lattice a, Lattice b) { return a.x * b.x + a.y * b.y; }
// Positive where a, b, c turn left.
inline std::int64_t turn(Lattice a, Lattice b, Lattice c) { return cross(b - a, c - a); }

inline std::int64_t floor_of(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
inline std::int64_t ceil_of(std::int64_t a, std::int64_t b) { return a / b + (a % b > 0 ? 1 : 0); }

// A point in its own unit.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

inline double distance(Point a, Point b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

}  // namespace muster
