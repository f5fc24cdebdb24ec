// Points between NumPy and the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include "paths/air.hpp"
#include "paths/lattice.hpp"

namespace muster {

using PointArray = nanobind::ndarray<const double, nanobind::c_contig, nanobind::device::cpu>;
using Table = nanobind::ndarray<nanobind::numpy, double>;

inline Point point(const std::pair<double, double>& p) { return {p.first, p.second}; }
inline Spot spot(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

inline std::vector<Point> points_of(const PointArray& array) {
  if (array.ndim() != 2 || array.shape(1) != 2) throw std::invalid_argument("an array of points must be (n, 2)");
  std::vector<Point> points(array.shape(0));
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = {array.data()[2 * k], array.data()[2 * k + 1]};
  return points;
}

inline std::vector<Spot> spots_of(const PointArray& array) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw std::invalid_argument("an array of places must be (n, 3)");
  std::vector<Spot> spots(array.shape(0));
  for (std::size_t k = 0; k < spots.size(); ++k)
    spots[k] = {array.data()[3 * k], array.data()[3 * k + 1], array.data()[3 * k + 2]};
  return spots;
}

inline Table table_of(std::vector<double> values, std::size_t rows, std::size_t columns) {
  auto* kept = new std::vector<double>(std::move(values));
  const nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return Table(kept->data(), {rows, columns}, owner);
}

inline Table table_of(const std::vector<Point>& points) {
  std::vector<double> values;
  for (const Point p : points) values.insert(values.end(), {p.x, p.y});
  return table_of(std::move(values), points.size(), 2);
}

inline Table table_of(const std::vector<Spot>& spots) {
  std::vector<double> values;
  for (const Spot p : spots) values.insert(values.end(), {p.x, p.y, p.z});
  return table_of(std::move(values), spots.size(), 3);
}

}  // namespace muster
