#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths/voxels.hpp"
#include "signals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Triple = std::array<double, 3>;
using BlockedVoxels = nb::ndarray<const bool, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using VoxelClearances = nb::ndarray<float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using ReachedTable = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using VoxelNumbers = nb::ndarray<nb::numpy, std::int64_t>;

template <class Array>
VoxelShape shape_of(const Array& array) {
  if (array.size() == 0 || array.size() > 2'000'000'000) throw std::invalid_argument("too few or too many voxels");
  return {static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), static_cast<int>(array.shape(2))};
}

VoxelNumbers numbers_of(std::vector<std::int64_t> values) {
  auto* kept = new std::vector<std::int64_t>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<std::int64_t>*>(p); });
  return VoxelNumbers(kept->data(), {kept->size()}, owner);
}

}  // namespace

void bind_voxels(nb::module_& m) {
  nb::class_<VoxelWays>(m, "VoxelWays", "Short ways through free voxels; coordinates x, y, z count in voxels.")
      .def(
          "__init__",
          [](VoxelWays* self, const BlockedVoxels& blocked) {
            const VoxelShape shape = shape_of(blocked);
            new (self) VoxelWays(shape, std::vector<std::uint8_t>(blocked.data(), blocked.data() + blocked.size()));
          },
          "blocked"_a, "`blocked` is (layers, rows, columns).")
      .def(
          "free", [](const VoxelWays& w, const Triple& p) { return w.free(spot(p)); }, "point"_a)
      .def(
          "sees", [](const VoxelWays& w, const Triple& a, const Triple& b) { return w.sees(spot(a), spot(b)); }, "a"_a,
          "b"_a, "Whether all voxels between two points are free.")
      .def(
          "part", [](VoxelWays& w, const Triple& p) { return w.part(spot(p)); }, "point"_a,
          "The number of the connected part that a point is in; 0 if it is not free.")
      .def(
          "way",
          [](VoxelWays& w, const Triple& a, const Triple& b) {
            std::vector<Spot> found;
            {
              const nb::gil_scoped_release unlocked;
              found = w.way(spot(a), spot(b), hear_signals);
            }
            return table_of(found);
          },
          "start"_a, "goal"_a, "A way with its ends, (k, 3); empty if there is none.");
  m.def(
      "voxels_passed",
      [](const std::array<int, 3>& shape, const Triple& eye, double heading, const ReachedTable& reached) {
        if (reached.shape(0) < 2 || reached.shape(1) < 1) throw std::invalid_argument("a scan needs two rings");
        if (std::min({shape[0], shape[1], shape[2]}) < 1) throw std::invalid_argument("there are no voxels");
        const SphereScan scan{spot(eye), heading, static_cast<int>(reached.shape(0)),
                              static_cast<int>(reached.shape(1)), reached.data()};
        return numbers_of(voxels_passed({shape[0], shape[1], shape[2]}, scan));
      },
      "shape"_a, "eye"_a, "heading"_a, "reached"_a,
      "The voxels, as indices of the flat array, whose centres are nearer than the four beams around them reached, by "
      "a "
      "voxel at least. `reached` is (rings, columns), in voxels: rings from straight down to straight up, columns "
      "anticlockwise from `heading`.");
  m.def(
      "lower_clearances",
      [](VoxelClearances clearances, const PointArray& points, double reach) {
        lower_clearances(shape_of(clearances), clearances.data(), spots_of(points), reach);
      },
      "clearances"_a, "points"_a, "reach"_a,
      "Lower the distances from the centres of voxels to the nearest of points (n, 3), where that is within `reach`.");
}

}  // namespace muster
