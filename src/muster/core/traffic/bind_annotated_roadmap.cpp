#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "traffic/annotated_roadmap.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Reach = std::vector<AnnotatedRoadmap::Near>;

Reach reach(const std::vector<int>& points, const std::vector<double>& metres) {
  if (points.size() != metres.size()) throw std::invalid_argument("points that are near need distances");
  Reach near;
  for (std::size_t k = 0; k < points.size(); ++k) near.push_back({points[k], metres[k]});
  return near;
}

}  // namespace

void bind_annotated_roadmap(nb::module_& m) {
  nb::class_<AnnotatedRoadmap>(m, "AnnotatedRoadmap",
                               "A roadmap that says for each edge which points a robot on it comes near to.")
      .def(
          "__init__",
          [](AnnotatedRoadmap* self, const PointArray& points, std::vector<int> first, std::vector<int> heads,
             std::vector<double> costs, std::vector<double> speeds, std::vector<int> near_first,
             const std::vector<int>& near_points, const std::vector<double>& near_metres) {
            DirectedGraph graph(std::move(first), std::move(heads), std::move(costs));
            new (self) AnnotatedRoadmap(points_of(points), std::move(graph), std::move(speeds), std::move(near_first),
                                        reach(near_points, near_metres));
          },
          "points"_a, "first"_a, "heads"_a, "costs"_a, "speeds"_a, "near_first"_a, "near_points"_a, "near_metres"_a,
          "`points` is (n, 2), `speeds` the greatest on each edge; edges and what is near them are in compressed rows. "
          "Raises ValueError where they do not fit.");
}

}  // namespace muster
