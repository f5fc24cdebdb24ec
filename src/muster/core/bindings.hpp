// One function for each bound class; module.cpp calls them.
#pragma once

#include <nanobind/nanobind.h>

namespace muster {

void bind_problem(nanobind::module_& m);
void bind_inspection(nanobind::module_& m);
void bind_greedy(nanobind::module_& m);
void bind_population(nanobind::module_& m);
void bind_decoder(nanobind::module_& m);
void bind_bidders(nanobind::module_& m);
void bind_annealing(nanobind::module_& m);
void bind_search(nanobind::module_& m);
void bind_roster(nanobind::module_& m);
void bind_schedule_search(nanobind::module_& m);
void bind_team(nanobind::module_& m);
void bind_distances(nanobind::module_& m);
void bind_grid(nanobind::module_& m);
void bind_ways(nanobind::module_& m);
void bind_lane_ways(nanobind::module_& m);
void bind_air(nanobind::module_& m);
void bind_tree(nanobind::module_& m);
void bind_voxels(nanobind::module_& m);
void bind_spanning_tree(nanobind::module_& m);
void bind_avoidance(nanobind::module_& m);
void bind_crowd_world(nanobind::module_& m);
void bind_passing_order(nanobind::module_& m);
void bind_annotated_roadmap(nanobind::module_& m);
void bind_safe_intervals(nanobind::module_& m);
void bind_lacam(nanobind::module_& m);
void bind_lifelong(nanobind::module_& m);

}  // namespace muster
