#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths/grid_sights.hpp"
#include "paths/polygon_sights.hpp"
#include "paths/ways.hpp"
#include "signals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Pair = std::pair<double, double>;

Table way_lengths(const Ways& ways, const PointArray& exits, const PointArray& entries, bool mutual, int first,
                  int last, int threads) {
  const auto from = points_of(exits), to = points_of(entries);
  if (first < 0 || last < first || last > static_cast<int>(from.size()) || (mutual && from.size() != to.size())) {
    throw std::invalid_argument("the rows do not fit the places");
  }
  std::vector<double> values;
  {
    const nb::gil_scoped_release unlocked;
    values = ways.lengths(from, to, mutual, first, last, threads);
  }
  return table_of(std::move(values), static_cast<std::size_t>(last - first), to.size());
}

std::optional<Table> lengths_alone(const Ways& ways, const PointArray& exits, const PointArray& entries, bool mutual) {
  const auto from = points_of(exits), to = points_of(entries);
  if (mutual && from.size() != to.size()) throw std::invalid_argument("the exits are not the entries");
  std::optional<std::vector<double>> values;
  {
    const nb::gil_scoped_release unlocked;
    values = ways.lengths_alone(from, to, mutual, hear_signals);
  }
  if (!values) return std::nullopt;
  return table_of(std::move(*values), from.size(), to.size());
}

}  // namespace

void bind_ways(nb::module_& m) {
  nb::class_<Ways>(m, "Ways", "Shortest ways in a plane with obstacles: taut pieces between corners.")
      .def_static(
          "on_grid", [](const GridMap& map) { return new Ways(std::make_shared<GridSights>(map)); }, "map"_a,
          "In the unit of cells.")
      .def_static(
          "on_region",
          [](const std::vector<PointArray>& rings) {
            std::vector<std::vector<Point>> points;
            for (const PointArray& ring : rings) points.push_back(points_of(ring));
            return new Ways(std::make_shared<PolygonSights>(points));
          },
          "rings"_a, "Rings (k, 2) with the inside on their left. Raises ValueError if the region is empty.")
      .def("build", &Ways::build, "most"_a, "threads"_a, nb::call_guard<nb::gil_scoped_release>(),
           "Find what the next `most` corners see. Until all are `built` there are no `lengths`, and each `way` looks "
           "for "
           "itself, where it comes by.")
      .def_prop_ro("graph_pays", &Ways::graph_pays,
                   "Whether ways have looked around as many corners as there are, so that to build pays.")
      .def_prop_ro("built", &Ways::built)
      .def_prop_ro("looks", &Ways::looks)
      .def_prop_ro("corners", &Ways::corners)
      .def_prop_ro("pieces", &Ways::pieces, "Straight pieces between corners, each counted from both ends.")
      .def(
          "free", [](const Ways& w, const Pair& p) { return w.free(point(p)); }, "point"_a)
      .def(
          "sees", [](const Ways& w, const Pair& a, const Pair& b) { return w.sees(point(a), point(b)); }, "a"_a, "b"_a)
      .def(
          "way",
          [](const Ways& w, const Pair& a, const Pair& b) {
            std::vector<Point> found;
            {
              const nb::gil_scoped_release unlocked;
              found = w.way(point(a), point(b));
            }
            return table_of(found);
          },
          "start"_a, "goal"_a, "The shortest way with its ends, (k, 2); empty if there is none.")
      .def("lengths_alone", &lengths_alone, "exits"_a, "entries"_a, nb::kw_only(), "mutual"_a,
           "All `lengths`, way by way without the graph; None if it comes to pay before the end.")
      .def(
          "lengths", &way_lengths, "exits"_a, "entries"_a, nb::kw_only(), "mutual"_a, "first"_a, "last"_a, "threads"_a,
          "Rows `first` to before `last` of the lengths from exits to entries; inf where there is no way. If `mutual`, "
          "the entries are the exits, and row i holds what comes after column i alone, and 0 there.");
}

}  // namespace muster
