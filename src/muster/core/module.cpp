#include <nanobind/nanobind.h>

#include "bindings.hpp"

NB_MODULE(_core, m) {
  m.doc() = "The hot loops of Muster.";
#ifdef NDEBUG
  // What a thread still holds when Python ends is no concern of who ran a command.
  nanobind::set_leak_warnings(false);
#endif
  muster::bind_annotated_roadmap(m);
  muster::bind_problem(m);
  muster::bind_inspection(m);
  muster::bind_greedy(m);
  muster::bind_population(m);
  muster::bind_decoder(m);
  muster::bind_bidders(m);
  muster::bind_annealing(m);
  muster::bind_search(m);
  muster::bind_roster(m);
  muster::bind_schedule_search(m);
  muster::bind_team(m);
  muster::bind_distances(m);
  muster::bind_grid(m);
  muster::bind_ways(m);
  muster::bind_lane_ways(m);
  muster::bind_air(m);
  muster::bind_tree(m);
  muster::bind_voxels(m);
  muster::bind_spanning_tree(m);
  muster::bind_avoidance(m);
  muster::bind_crowd_world(m);
  muster::bind_passing_order(m);
  muster::bind_safe_intervals(m);
  muster::bind_lacam(m);
  muster::bind_lifelong(m);
}
