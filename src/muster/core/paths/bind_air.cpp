#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths/air_ways.hpp"
#include "signals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Triple = std::array<double, 3>;
using Shape = std::tuple<std::vector<PointArray>, double, double>;

Rings rings_of(const std::vector<PointArray>& arrays) {
  std::vector<std::vector<Point>> rings;
  for (const PointArray& ring : arrays) rings.push_back(points_of(ring));
  return Rings(std::move(rings));
}

Table air_lengths(const AirWays& ways, const PointArray& places, int first, int last, int threads) {
  const std::vector<Spot> spots = spots_of(places);
  if (first < 0 || last < first || last > static_cast<int>(spots.size())) {
    throw std::invalid_argument("the rows do not fit the places");
  }
  std::vector<double> values;
  {
    const nb::gil_scoped_release unlocked;
    values = ways.lengths(spots, first, last, threads, hear_signals);
  }
  return table_of(std::move(values), static_cast<std::size_t>(last - first), spots.size());
}

}  // namespace

void bind_air(nb::module_& m) {
  nb::class_<AirWays>(m, "AirWays", "Short ways through the air over and around upright prisms, in metres.")
      .def(
          "__init__",
          [](AirWays* self, const std::vector<PointArray>& region, const std::vector<Shape>& prisms, double lowest,
             double top, double rise, double run) {
            if (!(rise > 0.0) || !(run > 0.0)) throw std::invalid_argument("samples need a distance");
            std::vector<PrismShape> shapes;
            for (const auto& [rings, floor, ceiling] : prisms) shapes.push_back({rings_of(rings), floor, ceiling});
            auto air = std::make_shared<const Air>(rings_of(region), std::move(shapes), lowest, top);
            new (self) AirWays(std::move(air), rise, run);
          },
          "region"_a, "prisms"_a, nb::kw_only(), "lowest"_a, "top"_a, "rise"_a, "run"_a,
          "`region` is rings (k, 2) with the inside on their left, a prism (rings, floor, ceiling). Upright edges are "
          "sampled every `rise` metres up to `top`, level ones every `run`.")
      .def(
          "build", [](AirWays& w, int threads) { w.build(threads, hear_signals); }, "threads"_a,
          nb::call_guard<nb::gil_scoped_release>(),
          "Find which samples see each other: lengths need it, and ways are faster then.")
      .def_prop_ro("built", &AirWays::built)
      .def_prop_ro("graph_pays", &AirWays::graph_pays,
                   "Whether ways have looked around as many samples as there are, so that to build pays.")
      .def_prop_ro("samples", &AirWays::samples)
      .def(
          "free", [](const AirWays& w, const Triple& p) { return w.air().free(spot(p)); }, "point"_a)
      .def(
          "sees", [](const AirWays& w, const Triple& a, const Triple& b) { return w.air().sees(spot(a), spot(b)); },
          "a"_a, "b"_a)
      .def(
          "way",
          [](const AirWays& w, const Triple& a, const Triple& b) {
            std::vector<Spot> found;
            {
              const nb::gil_scoped_release unlocked;
              found = w.way(spot(a), spot(b), hear_signals);
            }
            return table_of(found);
          },
          "start"_a, "goal"_a, "A way with its ends, (k, 3); empty if there is none.")
      .def("lengths", &air_lengths, "places"_a, nb::kw_only(), "first"_a, "last"_a, "threads"_a,
           "Rows `first` to before `last` of the lengths between places: what comes after column i, and 0 there; inf "
           "where there is no way.");
}

}  // namespace muster
