#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "safe_intervals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Numbers = nb::ndarray<const std::int32_t, nb::c_contig, nb::device::cpu>;
using Metres = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

template <class Array>
auto items_of(const Array& array) {
  return std::vector(array.data(), array.data() + array.size());
}

SharedLanes lanes_of(const PointArray& places, const Numbers& ends, const Metres& lengths, const Metres& clearances,
                     const Numbers& reach_first, const Numbers& reach_points, const Metres& reach_gaps) {
  const std::size_t count = lengths.size();
  if (ends.ndim() != 2 || ends.shape(0) != count || ends.shape(1) != 2 || clearances.size() != count)
    throw std::invalid_argument("lanes: expected two ends, a length and a clearance for each");
  if (reach_points.size() != reach_gaps.size()) throw std::invalid_argument("reach: expected a gap for each point");
  std::vector<SharedLanes::Lane> lanes;
  for (std::size_t k = 0; k < count; ++k)
    lanes.push_back({ends.data()[2 * k], ends.data()[2 * k + 1], lengths.data()[k], clearances.data()[k]});
  std::vector<Near> near;
  for (std::size_t k = 0; k < reach_points.size(); ++k) near.push_back({reach_points.data()[k], reach_gaps.data()[k]});
  return SharedLanes(points_of(places), std::move(lanes), items_of(reach_first), std::move(near));
}

using Stops = std::vector<std::pair<int, double>>;

Traveller traveller_of(const SharedLanes& lanes, int start, const Stops& stops, double radius, double speed,
                       double heading, double yaw_rate, double acceleration, double ready, bool fixed, bool stays) {
  const auto known = [&](int point) { return point >= 0 && point < lanes.points(); };
  if (!known(start)) throw std::invalid_argument("start: no point of the lanes");
  if (!(radius >= 0.0 && speed > 0.0 && yaw_rate > 0.0 && acceleration > 0.0 && ready >= 0.0))
    throw std::invalid_argument("traveller: expected positive numbers");
  Traveller who{start, heading, {}, radius, speed, yaw_rate, acceleration, ready, fixed, stays};
  for (const auto& [point, hold] : stops) {
    if (!known(point)) throw std::invalid_argument("stop: no point of the lanes");
    who.stops.push_back({point, hold});
  }
  return who;
}

std::tuple<std::vector<std::tuple<double, int, int>>, std::vector<double>, std::vector<int>> told(const Paths& paths) {
  std::vector<std::tuple<double, int, int>> moves;
  for (const TimedMove& move : paths.moves) moves.emplace_back(move.start, move.traveller, move.lane);
  return {std::move(moves), paths.ends, paths.order};
}

}  // namespace

void bind_safe_intervals(nb::module_& m) {
  nb::class_<SharedLanes>(m, "SharedLanes", "Straight lanes between points, with the points that each comes near.")
      .def("__init__",
           [](SharedLanes* self, const PointArray& places, const Numbers& ends, const Metres& lengths,
              const Metres& clearances, const Numbers& reach_first, const Numbers& reach_points, const Metres& reach_gaps) {
             new (self) SharedLanes(lanes_of(places, ends, lengths, clearances, reach_first, reach_points, reach_gaps));
           },
           nb::kw_only(), "places"_a, "ends"_a, "lengths"_a, "clearances"_a, "reach_first"_a, "reach_points"_a,
           "reach_gaps"_a)
      .def("metres_to", &SharedLanes::metres_to, "goal"_a, "radius"_a,
           "Metres to a point from each, for robots of a radius; inf where there is no way.");

  nb::class_<Traveller>(m, "Traveller", "A robot for which a path over lanes is sought.")
      .def("__init__",
           [](Traveller* self, const SharedLanes& lanes, int start, const Stops& stops, double radius, double speed,
              double heading, double yaw_rate, double acceleration, double ready, bool fixed, bool stays) {
             new (self) Traveller(traveller_of(lanes, start, stops, radius, speed, heading, yaw_rate, acceleration, ready,
                                               fixed, stays));
           },
           nb::kw_only(), "lanes"_a, "start"_a, "stops"_a, "radius"_a, "speed"_a, "heading"_a, "yaw_rate"_a,
           "acceleration"_a, "ready"_a, "fixed"_a, "stays"_a);

  m.def(
      "paths_by_safe_intervals",
      [](const SharedLanes& lanes, const std::vector<bool>& rests, const std::vector<Traveller>& travellers,
         std::vector<int> order, double margin, int tries, std::uint64_t seed) {
        if (static_cast<int>(rests.size()) != lanes.points()) throw std::invalid_argument("rests: one for each point");
        std::vector<int> sorted = order;
        std::ranges::sort(sorted);
        for (std::size_t k = 0; k < travellers.size(); ++k)
          if (sorted.size() != travellers.size() || sorted[k] != static_cast<int>(k))
            throw std::invalid_argument("order: expected each traveller once");
        if (tries < 1) throw std::invalid_argument("tries: expected at least 1");
        nb::gil_scoped_release free;
        return told(SafeIntervals(lanes, rests, margin).best_of(travellers, std::move(order), tries, seed));
      },
      nb::kw_only(), "lanes"_a, "rests"_a, "travellers"_a, "order"_a, "margin"_a, "tries"_a, "seed"_a,
      "Moves (seconds, traveller, lane) in order; when each has held at its last stop, inf where it finds no path; and "
      "the order of travellers in which these were found, the best of several from the one given on [phillips2011].");
}

}  // namespace muster
