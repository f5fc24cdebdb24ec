#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parallel.hpp"
#include "paths/lane_ways.hpp"
#include "signals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Numbers = std::vector<int>;
using Arcs = nb::ndarray<const std::int64_t, nb::c_contig, nb::device::cpu>;
using Seconds = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

std::vector<std::pair<int, int>> ends_of(const Arcs& arcs, std::size_t count) {
  if (arcs.ndim() != 2 || arcs.shape(1) != 2 || arcs.shape(0) != count)
    throw std::invalid_argument("an array of arcs must be (m, 2), with the seconds of each");
  std::vector<std::pair<int, int>> ends(count);
  for (std::size_t k = 0; k < count; ++k)
    ends[k] = {static_cast<int>(arcs.data()[2 * k]), static_cast<int>(arcs.data()[2 * k + 1])};
  return ends;
}

void check(const LaneWays& ways, const Numbers& numbers) {
  if (std::ranges::any_of(numbers, [&](int k) { return k >= ways.points(); }))
    throw std::invalid_argument("no point of the lanes");
}

std::pair<Table, Table> lengths(const LaneWays& ways, const Numbers& starts, const Numbers& goals, int threads) {
  check(ways, starts);
  check(ways, goals);
  std::vector<double> metres(starts.size() * goals.size()), seconds(metres.size());
  {
    const nb::gil_scoped_release unlocked;
    for_each_parallel(static_cast<int>(starts.size()), threads, hear_signals, [&] {
      return [&](int row) {
        std::size_t at = static_cast<std::size_t>(row) * goals.size();
        for (const auto& [far, late] : ways.lengths(starts[row], goals)) {
          metres[at] = far;
          seconds[at++] = late;
        }
      };
    });
  }
  return {table_of(std::move(metres), starts.size(), goals.size()),
          table_of(std::move(seconds), starts.size(), goals.size())};
}

}  // namespace

void bind_lane_ways(nb::module_& m) {
  nb::class_<LaneWays>(m, "LaneWays", "The quickest ways along directed lanes for a robot that slows down for bends.")
      .def(
          "__init__",
          [](LaneWays* self, const PointArray& points, const Arcs& ends, const Seconds& given, double turn,
             double stop) {
            std::vector<double> seconds(given.data(), given.data() + given.size());
            if (std::ranges::any_of(seconds, [](double s) { return !(s >= 0.0); }))
              throw std::invalid_argument("seconds: expected at least 0");
            auto arcs = ends_of(ends, seconds.size());
            new (self) LaneWays(points_of(points), std::move(arcs), std::move(seconds), turn, stop);
          },
          "points"_a, "ends"_a, "seconds"_a, nb::kw_only(), "turn"_a, "stop"_a,
          "Points (n, 2) and straight arcs (m, 2) between them, by number, with the seconds (m,) that each takes. "
          "`turn` and "
          "`stop` are the seconds that a bend by a right angle takes for turning, and for stopping. Raises ValueError "
          "where these do not fit.")
      .def("lengths", &lengths, "starts"_a, "goals"_a, "threads"_a,
           "Of the quickest ways from each start to each goal, by number, the metres and the seconds, bends included: "
           "two arrays (starts, goals). They are inf where there is no way, and where a number is below 0.")
      .def(
          "way",
          [](const LaneWays& ways, int start, int goal) {
            check(ways, {start, goal});
            return ways.way(start, goal);
          },
          "start"_a, "goal"_a, "The points of the quickest way, by number; none where there is no way.");
}

}  // namespace muster
