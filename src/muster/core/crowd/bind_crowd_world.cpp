#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <limits>

#include <stdexcept>
#include <string>
#include <tuple>

#include "bindings.hpp"
#include "crowd/crowd_world.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using PlaceArray = std::array<double, 3>;
using Faces = nb::ndarray<const double, nb::shape<-1, 6>, nb::c_contig, nb::device::cpu>;
using StopArray = nb::ndarray<const double, nb::shape<-1, 6>, nb::c_contig, nb::device::cpu>;
using Table = nb::ndarray<nb::numpy, double>;
using Event = std::tuple<double, int, int, int, bool>;
using Poses = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using Counts = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Slabs = std::vector<std::tuple<std::vector<std::array<double, 2>>, double, double>>;

Avoidance avoidance_named(const std::string& name) {
  if (name == "none") return Avoidance::none;
  if (name == "orca") return Avoidance::orca;
  if (name == "rvo") return Avoidance::rvo;
  if (name == "hrvo") return Avoidance::hrvo;
  if (name == "avo") return Avoidance::avo;
  throw std::invalid_argument("avoidance must be none, orca, rvo, hrvo or avo");
}

Law law_named(const std::string& name) {
  if (name == "profile") return Law::profile;
  if (name == "thesis") return Law::thesis;
  if (name == "trajectory") return Law::trajectory;
  throw std::invalid_argument("law must be profile, thesis or trajectory");
}

WallSet walls_of(const Faces& faces, const Slabs& slabs, double ground) {
  WallSet walls{{}, {}, ground};
  for (std::size_t k = 0; k < faces.shape(0); ++k) {
    const double* f = faces.data() + 6 * k;
    walls.faces.push_back({{Vec<2>{{f[0], f[1]}}, Vec<2>{{f[2], f[3]}}}, f[4], f[5]});
  }
  for (const auto& [ring, low, high] : slabs) {
    walls.slabs.push_back({{}, low, high});
    for (const auto& corner : ring) walls.slabs.back().ring.push_back({corner});
  }
  return walls;
}

std::vector<Waypoint> way_of(const StopArray& stops, const std::vector<bool>& labelled) {
  if (stops.shape(0) != labelled.size()) throw std::invalid_argument("the arrays are of different lengths");
  std::vector<Waypoint> way;
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    const double* s = stops.data() + 6 * k;
    way.push_back({Vec<3>{{s[0], s[1], s[2]}}, s[3], s[4], labelled[k], s[5]});
  }
  return way;
}

std::vector<Event> told(const std::vector<CrowdEvent>& found) {
  std::vector<Event> events;
  for (const CrowdEvent& e : found) events.emplace_back(e.time, e.robot, e.order, e.passed, e.idle);
  return events;
}

std::vector<Event> carried_out(CrowdWorld& world, const Poses& poses, const Poses& short_of, const Counts& counted,
                               double still) {
  const std::size_t n = world.robots().size();
  if (poses.shape(0) != n || short_of.shape(0) != n || counted.shape(0) != n)
    throw std::invalid_argument("the arrays must have a row for each robot");
  std::vector<Carried> after;
  for (std::size_t i = 0; i < poses.shape(0); ++i) {
    const double *p = poses.data() + 4 * i, *l = short_of.data() + 4 * i;
    after.push_back({Vec<3>{{p[0], p[1], p[2]}}, Vec<3>{{l[0], l[1], l[2]}}, p[3], l[3], counted.data()[2 * i],
                     counted.data()[2 * i + 1]});
  }
  return told(world.carried_out(after, still));
}

std::vector<std::array<double, 5>> command(CrowdWorld& world) {
  std::vector<std::array<double, 5>> rows;
  for (const Command& c : world.command())
    rows.push_back({c.velocity[0], c.velocity[1], c.velocity[2], c.ahead, c.yaw_rate});
  return rows;
}

// One row a robot.
template <typename Row>
Table table(const CrowdWorld& world, std::size_t columns, const Row& row) {
  auto* values = new std::vector<double>;
  values->reserve(world.robots().size() * columns + 1);
  for (const CrowdRobot& robot : world.robots()) row(robot, *values);
  const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  if (columns == 1) return Table(values->data(), {world.robots().size()}, owner);
  return Table(values->data(), {world.robots().size(), columns}, owner);
}

void bind_orders(nb::class_<CrowdWorld>& crowd) {
  crowd
      .def(
          "add_walls",
          [](CrowdWorld& w, const Faces& faces, const Slabs& slabs, double ground) {
            return w.add_walls(walls_of(faces, slabs, ground));
          },
          "faces"_a, "slabs"_a, "ground"_a,
          "Upright faces (k, 6): x, y and x, y of the ends, lowest and highest z; and the flat ends of zones: corners, "
          "floor, ceiling; and the least height of a centre, or -inf. Returns the number of this set.")
      .def(
          "add",
          [](CrowdWorld& w, PlaceArray position, double heading, double radius, double speed, double yaw_rate,
             double acceleration, double priority, bool faces_its_way, bool flies, int walls, const std::string& law,
             double climb, double climb_rate) {
            return w.add({radius, speed, yaw_rate, acceleration, priority, faces_its_way, flies, walls, law_named(law),
                          climb, climb_rate},
                         {position}, heading);
          },
          "position"_a, "heading"_a, nb::kw_only(), "radius"_a, "speed"_a, "yaw_rate"_a, "acceleration"_a, "priority"_a,
          "faces_its_way"_a, "flies"_a, "walls"_a, "law"_a = "profile", "climb"_a = 0.0,
          "climb_rate"_a = std::numeric_limits<double>::infinity(),
          "Returns the number of the robot, from 0. `law`: profile, thesis or trajectory; `climb`: above 0 of one that "
          "climbs by "
          "(4.12); `climb_rate`: up and down of one that keeps to straight ways.")
      .def(
          "set_walls", [](CrowdWorld& w, int robot, int walls) { w.set_walls(robot, walls); }, "robot"_a, "walls"_a,
          "From now on another set of walls stops a robot.")
      .def(
          "send",
          [](CrowdWorld& w, int robot, const StopArray& stops, const std::vector<bool>& labelled, int order) {
            w.send(robot, way_of(stops, labelled), order);
          },
          "robot"_a, "stops"_a, "labelled"_a, "order"_a,
          "Way points (k, 6): x, y, z, heading or NaN, hold, greatest speed on the way there; none to stop. One out of "
          "order does not take them.")
      .def(
          "follow",
          [](CrowdWorld& w, int robot, const Poses& poses, double step, std::vector<double> times) {
            if (poses.shape(0) == 0 || !(step > 0.0)) throw std::invalid_argument("a trajectory must have poses");
            Reference reference;
            for (std::size_t k = 0; k < poses.shape(0); ++k) {
              const double* p = poses.data() + 4 * k;
              reference.places.push_back(Vec<3>{{p[0], p[1], p[2]}});
              reference.headings.push_back(p[3]);
            }
            reference.times = std::move(times);
            reference.step = step;
            w.follow(robot, std::move(reference));
          },
          "robot"_a, "poses"_a, "step"_a, "times"_a,
          "The trajectory of the order sent last: (k, 4) of x, y, z, heading each `step` seconds, and when it passes "
          "each way point.")
      .def(
          "resume",
          [](CrowdWorld& w, long steps, const std::vector<std::array<double, 5>>& motions) {
            if (motions.size() != w.robots().size()) throw std::invalid_argument("expected a row for each robot");
            std::vector<Motion> rows;
            for (const auto& m : motions) rows.push_back({Vec<3>{{m[0], m[1], m[2]}}, m[3], m[4]});
            w.resume(steps, rows);
          },
          "steps"_a, "motions"_a, "Continue another world from a step, with a row of `motions` for each robot.")
      .def("fail", &CrowdWorld::fail, "robot"_a)
      .def("recover", &CrowdWorld::recover, "robot"_a)
      .def(
          "place", [](CrowdWorld& w, int robot, PlaceArray position) { w.place(robot, {position}); }, "robot"_a,
          "position"_a, "Puts a robot elsewhere: it stands there, without an order.")
      .def("slow", &CrowdWorld::slow, "robot"_a, "factor"_a)
      .def("leave_to_traffic", &CrowdWorld::leave_to_traffic, "robot"_a)
      .def(
          "believe",
          [](CrowdWorld& w, int robot, PlaceArray place, double heading, double spread) {
            w.believe(robot, {place}, heading, spread);
          },
          "robot"_a, "place"_a, "heading"_a, "spread"_a,
          "Where a robot takes itself to be now, within a standard deviation in metres: it goes by that.");
}

}  // namespace

void bind_crowd_world(nb::module_& m) {
  nb::class_<CrowdWorld> crowd(m, "CrowdWorld", "A world of moving robots in fixed steps of virtual time.");
  crowd.def(
      "__init__",
      [](CrowdWorld* self, double dt, const std::string& avoidance, bool space, double horizon, double wall_horizon,
         int neighbours, double clearance, double margin, double arrival, double corner, double heading,
         double velocity_noise, double slip, double odometry_noise, std::uint64_t seed) {
        new (self)
            CrowdWorld({dt, avoidance_named(avoidance), space, horizon, wall_horizon, neighbours, clearance, margin,
                        Tolerances{arrival, corner, heading}, CrowdNoise{velocity_noise, slip, odometry_noise}, seed});
      },
      nb::kw_only(), "dt"_a, "avoidance"_a, "space"_a, "horizon"_a, "wall_horizon"_a, "neighbours"_a, "clearance"_a,
      "margin"_a, "arrival"_a, "corner"_a, "heading"_a, "velocity_noise"_a, "slip"_a, "odometry_noise"_a, "seed"_a);
  bind_orders(crowd);
  crowd
      .def(
          "advance",
          [](CrowdWorld& w, double until) {
            std::vector<CrowdEvent> found;
            {
              nb::gil_scoped_release release;
              found = w.advance(until);
            }
            return told(found);
          },
          "until"_a,
          "Steps until a time, or until something happened: time, robot, order, way points passed, whether all.")
      .def("command", &command,
           "What robots that something else moves are to do in the next step: for each its velocity x, y, z, speed "
           "ahead of one that faces its way, yaw rate.")
      .def("carried_out", &carried_out, "poses"_a, "short_of"_a, "counted"_a, "still"_a,
           "Where it brought them, (n, 4) of x, y, z, heading; by how much they would still go and turn on, were they "
           "told to stand; (n, 2) metres and radians that their wheels counted, NaN without wheels; slower than "
           "`still` is standing. "
           "Returns events as `advance`.")
      .def_prop_ro("time", &CrowdWorld::time)
      .def_prop_ro("dt", &CrowdWorld::dt)
      .def_prop_ro("steps", &CrowdWorld::steps)
      .def_prop_ro("least_distance", &CrowdWorld::least_distance)
      .def(
          "contacts",
          [](const CrowdWorld& w) {
            std::vector<std::tuple<int, int, double, double>> found;
            for (const auto& [pair, contact] : w.contacts())
              found.emplace_back(pair.first, pair.second, contact.time, contact.distance);
            return found;
          },
          "Two robots, when they first touched, and the least distance of their centres.")
      .def(
          "report",
          [](const CrowdWorld& w, int robot) {
            const CrowdRobot& r = w.robots()[robot];
            const Vec<3> at = r.place();
            const Vec<3> counted = r.counts * r.velocity;
            return std::tuple(w.time(), std::tuple(at[0], at[1], at[2]), r.facing(),
                              std::tuple(counted[0], counted[1], counted[2]), r.odometry, r.order, r.next);
          },
          "robot"_a, "Time, position, heading, velocity as odometry has it, odometry, order, way points passed.")
      .def(
          "felt",
          [](const CrowdWorld& w, int robot) {
            const Felt felt = w.felt(robot);
            const Vec<3>& a = felt.acceleration;
            return std::tuple(std::tuple(a[0], a[1], a[2]), felt.yaw_rate);
          },
          "robot"_a,
          "Acceleration ahead, to the left and up, between the middles of the last two steps; yaw rate of the last.")
      .def(
          "counted",
          [](const CrowdWorld& w, int robot) {
            const Counted counted = w.counted(robot);
            return std::tuple(counted.way[0], counted.way[1], counted.way[2], counted.turn);
          },
          "robot"_a, "Metres ahead, to the left and up, and radians, that odometry counted in the last step.")
      .def(
          "told_pose",
          [](const CrowdWorld& w, int robot) {
            const CrowdRobot& r = w.robots()[robot];
            const Vec<3> at = r.belief.told_of(r.position);
            return std::tuple(at[0], at[1], at[2], r.heading - r.belief.turn);
          },
          "robot"_a, "Where orders take a robot to be: x, y, z, heading.")
      .def(
          "tracking_errors",
          [](const CrowdWorld& w, int robot) {
            const TrackingErrors& e = w.robots()[robot].errors;
            return std::tuple(e.sum, e.most, e.steps);
          },
          "robot"_a, "Metres off its trajectory: the sum over steps in which it followed it, the most, the steps.")
      .def("held_up_by", &CrowdWorld::held_up_by, "robot"_a,
           "The robot that holds one up on the way of its order; -1 where none does.")
      .def(
          "busy", [](const CrowdWorld& w, int robot) { return w.robots()[robot].phase != Phase::idle; }, "robot"_a)
      .def("positions",
           [](const CrowdWorld& w) {
             return table(w, 3, [](const CrowdRobot& r, auto& to) {
               const Vec<3> at = r.place();
               to.insert(to.end(), at.at.begin(), at.at.end());
             });
           })
      .def("velocities",
           [](const CrowdWorld& w) {
             return table(w, 3, [](const CrowdRobot& r, auto& to) {
               to.insert(to.end(), r.velocity.at.begin(), r.velocity.at.end());
             });
           })
      .def("headings",
           [](const CrowdWorld& w) {
             return table(w, 1, [](const CrowdRobot& r, auto& to) { to.push_back(r.facing()); });
           })
      .def(
          "motions",
          [](const CrowdWorld& w) {
            return table(w, 5, [](const CrowdRobot& r, auto& to) {
              to.insert(to.end(), r.velocity.at.begin(), r.velocity.at.end());
              to.insert(to.end(), {r.ahead, r.yaw_rate});
            });
          },
          "Of each robot its velocity, its speed ahead and its yaw rate.")
      .def("travelled", [](const CrowdWorld& w) {
        return table(w, 1, [](const CrowdRobot& r, auto& to) { to.push_back(r.travelled); });
      });
}

}  // namespace muster
