#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths/grid.hpp"
#include "paths/grid_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Cells = nb::ndarray<const bool, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Unlocked = nb::call_guard<nb::gil_scoped_release>;
using Pair = std::pair<double, double>;

}  // namespace

void bind_grid(nb::module_& m) {
  nb::class_<GridMap>(m, "GridMap",
                      "Cells that are free or blocked; points are (column, row), cell (0, 0) from 0 to 1.")
      .def(
          "__init__",
          [](GridMap* self, const Cells& blocked) {
            if (blocked.shape(0) > GridMap::kMostCells || blocked.shape(1) > GridMap::kMostCells) {
              throw std::invalid_argument("the grid has too many cells");
            }
            new (self) GridMap(std::vector<char>(blocked.data(), blocked.data() + blocked.size()),
                               static_cast<int>(blocked.shape(0)), static_cast<int>(blocked.shape(1)));
          },
          "blocked"_a, "`blocked` is (rows, columns). Raises ValueError if a side has more than 16384 cells.")
      .def(
          "free", [](const GridMap& g, const Pair& p) { return g.free(GridMap::snap(point(p))); }, "point"_a)
      .def(
          "sees",
          [](const GridMap& g, const Pair& a, const Pair& b) {
            return g.sees(GridMap::snap(point(a)), GridMap::snap(point(b)));
          },
          "a"_a, "b"_a, "Whether the straight piece between two points is free, exactly.")
      .def(
          "cells_at", [](const GridMap& g, const Pair& p) { return g.cells_at(GridMap::snap(point(p))); }, "point"_a,
          "The free cells that have a point inside or on their border, as row * columns + column.")
      .def(
          "search",
          [](const GridMap& g, const Pair& start, const Pair& goal, bool heuristic, bool any_angle) {
            return search_grid(g, point(start), point(goal), {heuristic, any_angle});
          },
          "start"_a, "goal"_a, nb::kw_only(), "heuristic"_a, "any_angle"_a, Unlocked(),
          "The cells of the shortest way between cell centres, as row * columns + column; empty if there is none.");
}

}  // namespace muster
