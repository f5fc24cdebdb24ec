#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "bindings.hpp"
#include "crowd/approach.hpp"
#include "crowd/avo.hpp"
#include "crowd/hrvo.hpp"
#include "crowd/orca.hpp"
#include "crowd/rvo.hpp"
#include "traffic/agent_tree.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Unlocked = nb::call_guard<nb::gil_scoped_release>;
using Plane = std::array<double, 2>;
using NumberArray = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <int D>
using RowArray = nb::ndarray<const double, nb::shape<-1, D>, nb::c_contig, nb::device::cpu>;
template <int D>
using PairArray = nb::ndarray<const double, nb::shape<-1, 2, D>, nb::c_contig, nb::device::cpu>;
template <int D>
using Trajectories = nb::ndarray<const double, nb::shape<-1, -1, D>, nb::c_contig, nb::device::cpu>;
template <int D>
using Result = nb::ndarray<nb::numpy, double, nb::shape<-1, D>, nb::c_contig>;

template <int D, typename Array>
std::vector<Vec<D>> vectors(const Array& array) {
  std::vector<Vec<D>> result(array.size() / D);
  const double* next = array.data();
  for (Vec<D>& row : result)
    for (double& x : row.at) x = *next++;
  return result;
}

std::vector<double> numbers(const NumberArray& array) { return {array.data(), array.data() + array.size()}; }

template <int D>
Result<D> as_array(std::vector<Vec<D>>&& rows) {
  auto* kept = new std::vector<Vec<D>>(std::move(rows));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Vec<D>>*>(p); });
  static double none[1] = {0.0};
  return Result<D>(kept->empty() ? none : kept->front().at.data(), {kept->size(), static_cast<std::size_t>(D)}, owner);
}

template <int D>
Agents<D> agents_of(const RowArray<D>& positions, const RowArray<D>& velocities, const RowArray<D>& preferred,
                    const NumberArray& radii, const NumberArray& max_speeds, const NumberArray& priorities) {
  Agents<D> agents{vectors<D>(positions), vectors<D>(velocities), vectors<D>(preferred),
                   numbers(radii),        numbers(max_speeds),    numbers(priorities)};
  const std::size_t n = agents.positions.size();
  if (agents.velocities.size() != n || agents.preferred.size() != n || agents.radii.size() != n ||
      agents.max_speeds.size() != n || agents.priorities.size() != n)
    throw std::invalid_argument("the arrays are of different lengths");
  return agents;
}

template <int D>
std::vector<Wall<D>> walls_of(const PairArray<D>& array) {
  const std::vector<Vec<D>> ends = vectors<D>(array);
  std::vector<Wall<D>> walls;
  for (std::size_t k = 0; k + 1 < ends.size(); k += 2) walls.push_back({ends[k], ends[k + 1]});
  return walls;
}

// Without the lock of the interpreter: what is computed sees no Python object.
template <int D, typename Work>
Result<D> unlocked(const Work& work) {
  std::vector<Vec<D>> velocities;
  {
    nb::gil_scoped_release release;
    velocities = work();
  }
  return as_array(std::move(velocities));
}

template <int D>
void bind_agents(nb::module_& m, const char* name, const char* document) {
  nb::class_<Agents<D>>(m, name, document)
      .def(
          "__init__",
          [](Agents<D>* self, const RowArray<D>& positions, const RowArray<D>& velocities, const RowArray<D>& preferred,
             const NumberArray& radii, const NumberArray& max_speeds, const NumberArray& priorities) {
            new (self) Agents<D>(agents_of<D>(positions, velocities, preferred, radii, max_speeds, priorities));
          },
          "positions"_a, "velocities"_a, "preferred"_a, "radii"_a, "max_speeds"_a, "priorities"_a,
          "Raises ValueError if the arrays are of different lengths.")
      .def(
          "near",
          [](const Agents<D>& agents, int most, double distance) {
            const AgentTree<D> tree(agents.positions);
            std::vector<std::vector<int>> all(agents.positions.size());
            for (int i = 0; i < agents.size(); ++i) tree.near(i, {most, distance}, all[i]);
            return all;
          },
          "most"_a, "distance"_a, Unlocked(), "For each agent the nearest others, as indices, the nearest first.")
      .def(
          "orca",
          [](const Agents<D>& agents, const PairArray<D>& walls, double dt, double horizon, double wall_horizon,
             int most, double distance, bool apart, int threads) {
            const OrcaSettings settings{horizon, wall_horizon, {most, distance}, apart};
            const std::vector<Wall<D>> still = walls_of<D>(walls);
            return unlocked<D>([&] { return orca_velocities<D>(agents, still, settings, dt, threads); });
          },
          "walls"_a, "dt"_a, nb::kw_only(), "horizon"_a, "wall_horizon"_a, "most"_a, "distance"_a, "apart"_a,
          "threads"_a,
          "New velocities by optimal reciprocal collision avoidance. Walls: ends of segments, or corners of boxes.");
}

void bind_plane_methods(nb::module_& m) {
  m.def(
      "rvo",
      [](const Agents<2>& agents, const PairArray<2>& walls, double dt, double v_min, int magnitudes, double n,
         double w, bool ideal, double wall_horizon, int most, double distance, int threads) {
        const RvoSettings settings{v_min, magnitudes, n, w, ideal, wall_horizon, {most, distance}};
        const std::vector<Segment> still = walls_of<2>(walls);
        return unlocked<2>([&] { return rvo_velocities(agents, still, settings, dt, threads); });
      },
      "agents"_a, "walls"_a, "dt"_a, nb::kw_only(), "v_min"_a, "magnitudes"_a, "n"_a, "w"_a, "ideal"_a,
      "wall_horizon"_a, "most"_a, "distance"_a, "threads"_a,
      "New velocities by reciprocal velocity obstacles ([tcf-thesis], appendix A3.2).");
  m.def(
      "hrvo",
      [](const Agents<2>& agents, const PairArray<2>& walls, double dt, double wall_horizon, int most, double distance,
         int threads) {
        const HrvoSettings settings{wall_horizon, {most, distance}};
        const std::vector<Segment> still = walls_of<2>(walls);
        return unlocked<2>([&] { return hrvo_velocities(agents, still, settings, dt, threads); });
      },
      "agents"_a, "walls"_a, "dt"_a, nb::kw_only(), "wall_horizon"_a, "most"_a, "distance"_a, "threads"_a,
      "New velocities by hybrid reciprocal velocity obstacles ([snape2011]).");
  m.def(
      "avo",
      [](const Agents<2>& agents, const NumberArray& accelerations, const PairArray<2>& walls, double dt,
         double horizon, double response, double wall_horizon, int most, double distance, int threads) {
        const AvoSettings settings{horizon, wall_horizon, response, {most, distance}};
        const std::vector<Segment> still = walls_of<2>(walls);
        const std::vector<double> limits = numbers(accelerations);
        if (limits.size() != agents.positions.size()) throw std::invalid_argument("one acceleration for each agent");
        return unlocked<2>([&] { return avo_velocities(agents, limits, still, settings, dt, threads); });
      },
      "agents"_a, "accelerations"_a, "walls"_a, "dt"_a, nb::kw_only(), "horizon"_a, "response"_a, "wall_horizon"_a,
      "most"_a, "distance"_a, "threads"_a, "New velocities by acceleration-velocity obstacles ([berg-snape2011]).");
  m.def(
      "avo_disc",
      [](Plane apart, Plane v, double radius, double response, double time) {
        const AvoDisc disc = avo_disc({apart}, {v}, radius, response, time);
        return std::make_tuple(disc.centre[0], disc.centre[1], disc.radius);
      },
      "apart"_a, "v"_a, "radius"_a, "response"_a, "time"_a,
      "The disc of relative velocities that lead into contact at a time: its centre and radius.");
}

void bind_obstacles(nb::module_& m) {
  nb::class_<VelocityObstacle>(m, "VelocityObstacle", "VO_{i,k} of [tcf-thesis] (A.5).")
      .def(
          "__init__",
          [](VelocityObstacle* self, Plane x_i, Plane x_k, Plane v_i, Plane v_k, double radius, double yields) {
            new (self) VelocityObstacle({x_i}, {x_k}, {v_i}, {v_k}, radius, yields);
          },
          "x_i"_a, "x_k"_a, "v_i"_a, "v_k"_a, "radius"_a, "yields"_a = 0.5, "`radius` is R_i + R_k, which is 2 R_i.")
      .def_prop_ro("boundaries", &VelocityObstacle::boundaries, "VO^1 to VO^8.")
      .def_prop_ro("theta_ik", &VelocityObstacle::theta_ik, "(A.6)")
      .def_prop_ro("theta_R", &VelocityObstacle::theta_R, "(A.7)")
      .def(
          "phi_delta", [](const VelocityObstacle& o, Plane v) { return o.phi_delta({v}); }, "v"_a, "(A.12)")
      .def(
          "phi_1", [](const VelocityObstacle& o, Plane v) { return o.phi_1({v}); }, "v"_a, "(A.19)")
      .def(
          "suitable", [](const VelocityObstacle& o, Plane v) { return o.suitable({v}); }, "v"_a, "(A.13)")
      .def(
          "time_to_collision", [](const VelocityObstacle& o, Plane v) { return o.time_to_collision({v}); }, "v"_a,
          "t_c (A.18), seconds; of a velocity that is not suitable.");
  m.def(
      "hybrid_obstacle",
      [](Plane apart, Plane v_a, Plane v_b, double radius, double dt, double yields) {
        const Cone cone = hybrid_obstacle({apart}, {v_a}, {v_b}, radius, dt, yields);
        return std::tuple(cone.apex.at, cone.left.at, cone.right.at);
      },
      "apart"_a, "v_a"_a, "v_b"_a, "radius"_a, "dt"_a, "yields"_a = 0.5,
      "Apex, left and right side of an HRVO, as seen by a robot from which the other is `apart`.");
}

template <int D>
void bind_program(nb::module_& m, const char* name) {
  m.def(
      name,
      [](const RowArray<D>& normals, const NumberArray& offsets, double radius, std::array<double, D> wanted,
         std::size_t hard) {
        const std::vector<Vec<D>> unit = vectors<D>(normals);
        if (offsets.size() != unit.size()) throw std::invalid_argument("the arrays are of different lengths");
        std::vector<HalfSpace<D>> spaces;
        for (std::size_t k = 0; k < unit.size(); ++k) spaces.push_back({unit[k], offsets.data()[k]});
        Program<D> program;
        Vec<D> x;
        const std::size_t held = program.solve(spaces, radius, {{wanted}, false}, x);
        if (held < spaces.size()) least_penetration<D>(spaces, hard, held, radius, program, x);
        return std::pair(x.at, held == spaces.size());
      },
      "normals"_a, "offsets"_a, "radius"_a, "wanted"_a, "hard"_a = 0,
      "The point nearest to the wanted one with normal . x >= offset for all and |x| <= radius, and True; or where "
      "there is none, the point least deep outside all but the first `hard`, and False.");
}

template <int D>
void bind_approach(nb::module_& m, const char* name) {
  m.def(
      name,
      [](const Trajectories<D>& positions, const NumberArray& radii, double tolerance) {
        if (positions.shape(0) == 0 || positions.shape(1) != radii.size())
          throw std::invalid_argument("positions must be (steps + 1, n, d), radii (n,)");
        const std::vector<Vec<D>> places = vectors<D>(positions);
        const std::vector<double> sizes = numbers(radii);
        nb::gil_scoped_release release;
        Approach found = closest_approach<D>(places, sizes, tolerance);
        return std::tuple(found.distances, found.gaps, found.contacts);
      },
      "positions"_a, "radii"_a, "tolerance"_a,
      "Of robots that move straight between points of time: for each step the least distance of two centres, and the "
      "least distance less the radii; and the pairs that ever overlap by more than the tolerance.");
}

}  // namespace

void bind_avoidance(nb::module_& m) {
  bind_agents<2>(m, "PlaneAgents", "Robots that share the plane.");
  bind_agents<3>(m, "SpaceAgents", "Robots that share the space.");
  bind_plane_methods(m);
  bind_obstacles(m);
  bind_program<2>(m, "nearest_in_plane");
  bind_program<3>(m, "nearest_in_space");
  bind_approach<2>(m, "closest_approach_in_plane");
  bind_approach<3>(m, "closest_approach_in_space");
}

}  // namespace muster
