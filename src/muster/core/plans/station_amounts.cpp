// Which calls the best label of a route comes by, and how much energy each adds.
#include "plans/station_calls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace muster {

namespace {

constexpr double kAmountRounding = 1e-12;

}  // namespace

// Goes back from the last label: how much energy the robot needs where it leaves a station, and by when.
void StationCalls::trace(int robot, Route& route, int best, std::span<const double> works) {
  const Labels& labels = route.labels;
  const bool drains = problem_.energy(robot) < kNever;
  int position = static_cast<int>(labels.at_stop.size()) - 1;  // of the stop that the label is at, or goes to
  const int size = static_cast<int>(route.tasks.size());
  const auto place_of_stop = [&](int k) {
    return k == 0 ? problem_.start(robot) : k <= size ? route.tasks[k - 1] : problem_.end(robot);
  };
  struct Left {
    Call call;
    double level;
  };
  std::vector<Left> left;
  Frontier::Point target = labels.all[best].frontier.first();
  for (int k = best; labels.all[k].parent >= 0; k = labels.all[k].parent) {
    const Label &label = labels.all[k], &parent = labels.all[label.parent];
    const int to = label.station >= 0 ? problem_.place_of_station(label.station) : place_of_stop(position);
    const int from = parent.station >= 0 ? problem_.place_of_station(parent.station)
                                         : place_of_stop(label.station >= 0 ? position : position - 1);
    const double way = drains ? problem_.travel_usage(robot, from, to) : 0.0;
    const double seconds = problem_.travel_time(robot, from, to);
    Frontier arrival = parent.frontier;
    arrival.advance(seconds, way);
    if (drains) arrival.keep_from(-kAmountRounding * problem_.energy(robot));
    if (label.station >= 0) {
      const Station& station = problem_.station(label.station);
      left.push_back({{position, label.station, 0.0, 0.0, 0.0}, target.energy});
      if (drains && station.refill > 0.0 && station.partial) {
        const Frontier::Point corner = arrival.corner(station.refill);
        if (target.time >= corner.time) target = corner;
      } else if (drains && station.refill > 0.0) {
        left.back().level = problem_.energy(robot);
        target = arrival.corner(station.refill);
      } else if (drains && station.swap_s >= 0.0) {
        left.back().level = problem_.energy(robot);
        target = arrival.first();
      }
    } else {
      if (to < problem_.tasks()) {
        target.time -= std::max(works[to], problem_.work_time(robot, to));
        target.energy += drains ? work_usage(robot, to, works) : 0.0;
      }
      const double time = arrival.time_of(target.energy);
      target = {std::min(time, target.time), std::max(target.energy, arrival.energy_at(std::min(time, target.time)))};
      --position;
    }
    target.time -= seconds;
    target.energy += way;
    if (parent.station < 0 && position == size && ends_before_return(robot)) {
      // What is refilled on the way to the end makes nothing later.
      const double needed = drains ? needed_after_work(robot, labels, labels.all[best].parent) : 0.0;
      target.time = parent.frontier.time_of(needed);
      target.energy = std::max(needed, parent.frontier.energy_at(target.time));
    }
  }
  std::ranges::reverse(left);
  // Forward again, as a level may be above what is needed.
  double level = drains ? problem_.energy_at_start(robot) : 0.0;
  std::size_t next = 0;
  int place = problem_.start(robot);
  for (int k = 0; k <= size; ++k) {
    for (; next < left.size() && left[next].call.at == k; ++next) {
      Call call = left[next].call;
      const Station& station = problem_.station(call.station);
      const int there = problem_.place_of_station(call.station);
      if (drains) level -= problem_.travel_usage(robot, place, there);
      if (drains && station.gives_energy()) {
        const double full = problem_.energy(robot);
        double to_level = std::min(full, left[next].level);
        if (full - to_level < 1e-9 * full) to_level = full;
        call.refilled = std::max(0.0, to_level - level);
        call.takes_s = station.swap_s >= 0.0 ? station.swap_s : call.refilled / station.refill;
        level += call.refilled;
      }
      route.calls.push_back(call);
      place = there;
    }
    if (k == size || !drains) {
      if (k < size) place = route.tasks[k];
      continue;
    }
    level -= problem_.travel_usage(robot, place, route.tasks[k]) + work_usage(robot, route.tasks[k], works);
    place = route.tasks[k];
  }
}

}  // namespace muster
